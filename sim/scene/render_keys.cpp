// The keys of pictures.
#include "sim/scene/key_sections.hpp"
#include "sim/scene/rules.hpp"

namespace scree {
namespace {

Codec<double> field_of_view() { return number(inside(0, 180), "degrees"); }

Codec<OrbitSettings> orbit_section() {
  using T = OrbitSettings;
  return section<T>(
      "render.camera.orbit",
      "The camera turns about the axis through `to` against gravity, counter-clockwise from above. Exactly "
      "one key.",
      {
          key<T>("degrees", &T::degrees, optional(number()), optionally, "angle over the whole run"),
          key<T>("degrees_per_second", &T::degrees_per_second, optional(number()), optionally,
                 "of simulated time"),
      },
      check_orbit);
}

Codec<CameraKeySettings> keyframe_section() {
  using T = CameraKeySettings;
  return section<T>("render.camera.keyframes[]", "Where the camera is at a time.",
                    {
                        key<T>("at", &T::at, number(any_value, "s"), required, "the time"),
                        key<T>("from", &T::from, vector("m"), required, "place of the camera"),
                        key<T>("to", &T::to, vector("m"), required, "the point in the middle of the picture"),
                        key<T>("fov", &T::fov, field_of_view(), optionally, "vertical field of view"),
                    },
                    check_keyframe);
}

/// Makes the key `fov`. It is left out of the resolved scene if there are keyframes, because it is refused
/// beside them: each keyframe has its own.
Key<CameraSettings> camera_field_of_view() {
  using T = CameraSettings;
  Key<T> fov = key<T>("fov", &T::fov, field_of_view(), optionally, "vertical field of view");
  fov.write = [write = fov.write](const T& camera) {
    return camera.keyframes.empty() ? write(camera) : std::nullopt;
  };
  return fov;
}

Codec<CameraSettings> camera_section() {
  using T = CameraSettings;
  return section<T>(
      "render.camera", "Where pictures are taken from.",
      {
          key<T>("from", &T::from, optional(vector("m")), optionally,
                 "place of the camera; without it and `to`, chosen to see every body"),
          key<T>("to", &T::to, optional(vector("m")), optionally, "the point in the middle of the picture"),
          camera_field_of_view(),
          key<T>("orbit", &T::orbit, optional(orbit_section()), optionally, "the camera goes round"),
          key<T>("keyframes", &T::keyframes, list_of(keyframe_section()), optionally,
                 "instead of the other keys: places at ascending times, with a smooth way between them"),
      },
      check_camera);
}

/// Makes the key of the picture's size, which is stored in two members.
Key<RenderSettings> picture_size() {
  const auto codec = array_of<2>(integer(between(16, 16384)));
  return {{"size", optionally, codec.type, {}, "width and height of the pictures, in pixels"},
          [codec](RenderSettings& render, const Node& node, Reader& reader) {
            std::array<int, 2> size{};
            codec.read(size, node, reader);
            render.width = size[0];
            render.height = size[1];
          },
          [codec](const RenderSettings& render) {
            return codec.write({render.width, render.height});
          }};
}

Codec<ColorBy> color_word() {
  using enum ColorBy;
  return word<ColorBy>({{"material", material},
                        {"speed", speed},
                        {"size", size},
                        {"kinetic_energy", kinetic_energy},
                        {"force", force},
                        {"level", level},
                        {"id", id}});
}

Codec<Overlay> overlay_word() {
  using enum Overlay;
  return word<Overlay>({{"grid", grid}, {"pairs", pairs}, {"forces", forces}});
}

}  // namespace

Codec<RenderSettings> render_section() {
  using T = RenderSettings;
  const Codec<T> nothing{
      word_type({"false", "true"}),
      [](T& render, const Node& node, Reader&) { render.enabled = node.text == "true"; },
      [](const T& render) { return render.enabled ? std::nullopt : std::optional(Node::scalar("false")); }};
  return any_of<T>(
      {nothing,
       section<T>(
           "render", "The pictures; `render: false` makes none.",
           {
               picture_size(),
               key<T>("fps", &T::fps, number(above_zero, "1/s"), optionally, "pictures per simulated second"),
               key<T>("camera", &T::camera, or_auto(camera_section()), optionally,
                      "auto: chosen to see every body"),
               key<T>("color", &T::color, color_word(), optionally,
                      "what the colours show; force: sum of the contact forces on a body; level: of the "
                      "hierarchical grid"),
               key<T>("range", &T::range, or_auto(array_of<2>(number())), optionally,
                      "[low, high] of the colour scale in SI units, the same for all pictures; auto: guessed "
                      "from the scene"),
               key<T>("legend", &T::legend, or_auto(boolean()), optionally,
                      "colour scale and width of the grid's cells; auto: where there is room for it"),
               key<T>("time_stamp", &T::time_stamp, or_auto(boolean()), optionally,
                      "the time; auto: likewise"),
               key<T>("overlay", &T::overlay, list_of(overlay_word()), optionally,
                      "lines over the bodies: occupied cells of the hierarchical grid, the pairs that the "
                      "broad phase found, contact forces as lines as wide as they are strong"),
           },
           check_render)});
}

}  // namespace scree
