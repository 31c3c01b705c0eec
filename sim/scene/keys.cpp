// The table of keys. A key of the language is one line here: name, member, type with unit and range,
// presence, and one line of help. The default is the member's initialiser in keys.hpp or scene.hpp.
#include "sim/scene/keys.hpp"

#include "sim/scene/rules.hpp"

namespace scree {
namespace {

constexpr Presence required = Presence::required;
constexpr Presence optionally = Presence::optional;

/// Materials have a law for each pair, regions a sum over all bodies each.
constexpr std::int64_t most_names = 1000;

/// A default that the member cannot show, because its absence is told from its being given.
template <class T>
Key<T> with_default(Key<T> key, std::string fallback) {
  key.type.fallback = std::move(fallback);
  return key;
}

Codec<TimeSettings> time_section() {
  using T = TimeSettings;
  return section<T>(
      "time", "How long the run is, and how fine.",
      {
          key<T>("end", &T::end, number(above_zero, "s"), required, "when the run ends; it starts at 0"),
          key<T>("step", &T::step, number(above_zero, "s"), required,
                 "length of a step; the last one is shorter if `end` is no multiple"),
          key<T>("substeps", &T::substeps, integer(between(1, 1e6)), optionally,
                 "contacts are found and solved this many times per step"),
      },
      check_time);
}

Codec<MaterialEntry> material_section() {
  using T = MaterialEntry;
  return section<T>(
      "materials.<name>", "What bodies are made of. The names are yours; bodies and contacts refer to them.",
      {
          key<T>("density", &T::density, number(above_zero, "kg/m^3"), optionally, "mass per volume"),
          key<T>("restitution", &T::restitution, number(between(0, 1)), optionally,
                 "share of the approach speed that an impact gives back"),
          key<T>("friction", &T::friction, number(not_negative), optionally, "Coulomb's coefficient"),
      });
}

Codec<ContactEntry> contact_section() {
  using T = ContactEntry;
  return section<T>(
      "contacts[]",
      "Laws of pairs of materials. For a pair that is not listed, and for a value that is left out, it is "
      "the "
      "geometric mean of the two materials' values.",
      {
          key<T>("between", &T::between, array_of<2>(identifier()), required,
                 "the two materials, in any order"),
          key<T>("restitution", &T::restitution, optional(number(between(0, 1))), optionally, "of the pair"),
          key<T>("friction", &T::friction, optional(number(not_negative)), optionally, "of the pair"),
      });
}

template <class T>
Codec<Distribution<T>> distribution(std::string name, const Codec<T>& value) {
  using D = Distribution<T>;
  const Codec<D> fixed{
      value.type,
      [value](D& sizes, const Node& node, Reader& reader) {
        value.read(sizes.value.emplace(), node, reader);
      },
      [value](const D& sizes) { return sizes.value ? value.write(*sizes.value) : std::nullopt; }};
  return any_of<D>(
      {fixed,
       section<D>(
           std::move(name), "A size to be drawn for each body. Exactly one key.",
           {
               key<D>("uniform", &D::uniform, optional(array_of<2>(value)), optionally,
                      "[low, high]: any size between the two is as likely; each edge of a box by itself"),
               key<D>("powerlaw", &D::powerlaw, optional(array_of<3>(number())), optionally,
                      "[min, max, exponent]: sizes x from min to max, their number falling as "
                      "x^-exponent; boxes are cubes"),
               key<D>("choose", &D::choose, list_of(value, 1), optionally,
                      "[size, ...]: each as likely as the others"),
           },
           check_distribution<T>)});
}

/// Edge lengths, or one number for a cube.
Codec<Vec3> edges() {
  const Codec<double> edge = number(above_zero, "m");
  const Codec<Vec3> cube{edge.type,
                         [edge](Vec3& size, const Node& node, Reader& reader) {
                           double length = 0;
                           edge.read(length, node, reader);
                           size.setConstant(length);
                         },
                         [](const Vec3&) { return std::optional<Node>(); }};
  return any_of<Vec3>({cube, vector("m", above_zero)});
}

Codec<PlaneEntry> plane_section() {
  using T = PlaneEntry;
  return section<T>("bodies[].plane", "A fixed half space; the free side is where normal . x >= offset.",
                    {
                        key<T>("normal", &T::normal, vector(""), required,
                               "points to the free side; of any length but 0, made a unit vector"),
                        key<T>("offset", &T::offset, number(any_value, "m"), optionally,
                               "distance of the plane from the origin, along the unit normal"),
                    },
                    check_plane);
}

Codec<SphereEntry> sphere_section() {
  using T = SphereEntry;
  return section<T>(
      "bodies[].sphere", "A ball.",
      {
          key<T>("radius", &T::radius, distribution("bodies[].sphere.radius", number(above_zero, "m")),
                 required, "one radius, or a distribution"),
      });
}

Codec<BoxEntry> box_section() {
  using T = BoxEntry;
  return section<T>("bodies[].box", "A cuboid, its edges along the axes of the body.",
                    {
                        key<T>("size", &T::size, distribution("bodies[].box.size", edges()), required,
                               "full edge lengths [x, y, z], one number for a cube, or a distribution"),
                    });
}

Codec<TubeEntry> tube_section() {
  using T = TubeEntry;
  return section<T>(
      "bodies[].tube",
      "The inside of a cylinder along the body's z axis, closed by a cap at each end. It has one side: it "
      "holds what is in it, and bodies whose centre is outside pass it by. It never moves freely.",
      {
          key<T>("radius", &T::radius, number(above_zero, "m"), required, "of the inside"),
          key<T>("length", &T::length, number(above_zero, "m"), required, "from cap to cap"),
      });
}

Codec<RotationEntry> rotate_section() {
  using T = RotationEntry;
  return section<T>(
      "bodies[].rotate", "Orientation by a turn about an axis through the body's centre.",
      {
          key<T>("axis", &T::axis, vector(""), required, "of any length but 0"),
          key<T>("degrees", &T::degrees, optional(number()), optionally, "angle in degrees; or give radians"),
          key<T>("radians", &T::radians, optional(number()), optionally, "angle in radians; or give degrees"),
      },
      check_rotation);
}

Codec<MotionEntry> motion_section() {
  using T = MotionEntry;
  return section<T>("bodies[].motion", "Prescribed motion: the body moves like this whatever hits it.",
                    {
                        key<T>("velocity", &T::velocity, vector("m/s"), optionally, "constant velocity"),
                        key<T>("spin", &T::spin, vector("rad/s"), optionally, "constant angular velocity"),
                        key<T>("about", &T::about, optional(vector("m")), optionally,
                               "the point to turn about, which moves along with `velocity`; the body's own "
                               "centre if not given"),
                    },
                    check_motion);
}

Codec<RepeatEntry> repeat_section() {
  using T = RepeatEntry;
  return section<T>(
      "bodies[].repeat",
      "The body again and again on a lattice, the first at `at`. Bodies are called `name[0]`, "
      "`name[1]`, ..., x fastest.",
      {
          key<T>("count", &T::count, array_of<3>(large_integer(at_least(1))), required,
                 "bodies along x, y and z"),
          key<T>("spacing", &T::spacing, vector("m"), required, "between centres, along x, y and z"),
          key<T>("jitter", &T::jitter, number(not_negative, "m"), optionally,
                 "each centre is moved at random by up to this much along each axis"),
      });
}

Codec<ScatterEntry> scatter_section() {
  using T = ScatterEntry;
  return section<T>(
      "bodies[].scatter",
      "The body again and again at random places, in random orientations unless one is given. "
      "Centres lie between the two corners, and no body overlaps another one that appears at the "
      "same time, or a fixed one. "
      "Bodies are called `name[0]`, `name[1]`, ...",
      {
          key<T>("count", &T::count, large_integer(at_least(1)), required, "how many"),
          key<T>("from", &T::from, vector("m"), required, "lower corner"),
          key<T>("to", &T::to, vector("m"), required, "upper corner"),
      },
      check_scatter);
}

Codec<BodyEntry> body_section() {
  using T = BodyEntry;
  return section<T>(
      "bodies[]", "One body, or many alike. Each has exactly one shape: plane, sphere, box or tube.",
      {
          key<T>("plane", &T::plane, optional(plane_section()), optionally, "the shape: a fixed half space"),
          key<T>("sphere", &T::sphere, optional(sphere_section()), optionally, "the shape: a ball"),
          key<T>("box", &T::box, optional(box_section()), optionally, "the shape: a cuboid"),
          key<T>("tube", &T::tube, optional(tube_section()), optionally,
                 "the shape: the inside of a cylinder, with end caps; needs `fixed: true` or `motion`"),
          key<T>("file", &T::file, text(), optionally,
                 "instead of a shape: bodies from a CSV file, or those that another run left, by its folder; "
                 "see Body files"),
          key<T>("name", &T::name, identifier(), optionally, "to refer to it in measures"),
          key<T>("material", &T::material, identifier(), optionally,
                 "one of `materials`; required but for a file that has a column of them"),
          key<T>("mass", &T::mass, optional(number(above_zero, "kg")), optionally,
                 "instead of the material's density"),
          with_default(key<T>("at", &T::at, optional(vector("m")), optionally,
                              "place of the centre; of the first one if repeated"),
                       "[0, 0, 0]"),
          with_default(key<T>("orientation", &T::orientation, optional(array_of<4>(number())), optionally,
                              "quaternion [w, x, y, z] of any length but 0, made a unit one"),
                       "[1, 0, 0, 0]"),
          key<T>("rotate", &T::rotate, optional(rotate_section()), optionally, "instead of `orientation`"),
          with_default(key<T>("velocity", &T::velocity, optional(vector("m/s")), optionally, "at the start"),
                       "[0, 0, 0]"),
          with_default(key<T>("spin", &T::spin, optional(vector("rad/s")), optionally,
                              "angular velocity at the start"),
                       "[0, 0, 0]"),
          with_default(key<T>("fixed", &T::fixed, optional(boolean()), optionally, "the body never moves"),
                       "false"),
          key<T>("motion", &T::motion, optional(motion_section()), optionally,
                 "the body moves as prescribed"),
          key<T>("repeat", &T::repeat, optional(repeat_section()), optionally, "many on a lattice"),
          key<T>("scatter", &T::scatter, optional(scatter_section()), optionally, "many at random places"),
          with_default(
              key<T>("from", &T::from, optional(number(not_negative, "s")), optionally,
                     "when the body appears, in the state given here; its motion starts then. Taken at "
                     "the nearest step, as is `until`"),
              "0"),
          key<T>("until", &T::until, optional(number(above_zero, "s")), optionally,
                 "when the body is gone; never if not given"),
      },
      check_body);
}

Codec<ForceEntry> force_section() {
  using T = ForceEntry;
  return section<T>(
      "forces[]",
      "A constant force on the centre of a body, a torque, or both, in the world frame. They act for "
      "from <= t < until, both taken at the nearest step.",
      {
          key<T>(
              "on", &T::on, text(), required,
              "name of a free body; of a repeat or scatter, `name[3]` is one of its bodies and `name` each"),
          key<T>("force", &T::force, vector("N"), optionally, "on the centre"),
          key<T>("torque", &T::torque, vector("N m"), optionally, "about the centre"),
          key<T>("from", &T::from, number(not_negative, "s"), optionally, "when it starts to act"),
          key<T>("until", &T::until, optional(number(above_zero, "s")), optionally,
                 "when it ends; at the end of the run if not given"),
      },
      check_force);
}

Codec<Region> region_section() {
  using T = Region;
  return section<T>(
      "regions.<name>",
      "A box to measure in, its faces along the world's axes. The names are yours; see Measures.",
      {
          key<T>("from", &T::from, vector("m"), required, "lower corner"),
          key<T>("to", &T::to, vector("m"), required, "upper corner"),
      },
      check_region);
}

Codec<ResponseSettings> response_section() {
  using T = ResponseSettings;
  return section<T>(
      "response", "How contacts answer.",
      {
          key<T>("mode", &T::mode, word<ResponseMode>({{"default", ResponseMode::standard}}, {"accurate"}),
                 optionally, "how impulses are found"),
          key<T>(
              "iterations", &T::iterations, or_auto(integer(between(1, 1e6))), optionally,
              "most sweeps over the contacts per substep; auto: 20 for heaps, more the fewer contacts there "
              "are, until they converge"),
          key<T>("block_sweeps", &T::block_sweeps, or_auto(integer(between(1, 100))), optionally,
                 "sweeps over the points that two bodies share, at each visit; auto: 4, with which stacks "
                 "stand still, but 1 for heaps"),
          key<T>("tolerance", &T::tolerance, number(inside(0, 1)), optionally,
                 "sweeps stop when they change the impulses by less than this share"),
          key<T>("warm_start", &T::warm_start, boolean(), optionally, "start from the last step's impulses"),
          key<T>("restitution_threshold", &T::restitution_threshold, or_auto(number(not_negative, "m/s")),
                 optionally, "slower approaches do not bounce; auto: from gravity and step"),
      });
}

/// A number of levels, where 0 stands for auto.
Codec<int> levels() {
  const Codec<int> count = integer(between(1, 32));
  return any_of<int>({word<int>({{"auto", 0}}), count});
}

Codec<BroadPhaseSettings> broadphase_section() {
  using T = BroadPhaseSettings;
  using M = BroadPhaseMethod;
  return section<T>(
      "broadphase", "How the potentially colliding pairs are found. Never changes which they are.",
      {
          key<T>("method", &T::method,
                 word<M>({{"hierarchical_grid", M::hierarchical_grid},
                          {"uniform_grid", M::uniform_grid},
                          {"brute_force", M::brute_force}},
                         {"sweep_and_prune", "lbvh"}),
                 optionally, "the method"),
          key<T>("levels", &T::levels, levels(), optionally, "grid levels; auto: from the bodies' sizes"),
      });
}

Codec<NarrowPhaseSettings> narrowphase_section() {
  using T = NarrowPhaseSettings;
  using M = BoxBoxMethod;
  return section<T>("narrowphase", "How contact points are found.",
                    {
                        key<T>("box_box", &T::box_box,
                               word<M>({{"auto", M::automatic},
                                        {"sat", M::sat},
                                        {"ccd_gjk", M::ccd_gjk},
                                        {"ccd_mpr", M::ccd_mpr}}),
                               optionally, "for pairs of boxes; auto: the measured best"),
                        key<T>("crosscheck", &T::crosscheck, number(between(0, 1)), optionally,
                               "share of the pairs of boxes, chosen anew each substep, that libccd is asked "
                               "about too; where it differs is counted in the manifest"),
                    });
}

Codec<ModelSettings> model_section() {
  using T = ModelSettings;
  const auto feature = or_auto(word<bool>({{"on", true}, {"off", false}, {"true", true}, {"false", false}}));
  const Codec<T> automatic{word_type({"auto"}, {}), [](T& model, const Node&, Reader&) { model = {}; },
                           [](const T& model) -> std::optional<Node> {
                             const bool given = model.rotation || model.friction || model.restitution;
                             return given ? std::nullopt : std::optional(Node::scalar("auto"));
                           }};
  return any_of<T>(
      {automatic,
       section<T>("model", "Features to compute; auto: only if the scene needs them.",
                  {
                      key<T>("rotation", &T::rotation, feature, optionally, "bodies turn"),
                      key<T>("friction", &T::friction, feature, optionally, "contacts rub"),
                      key<T>("restitution", &T::restitution, feature, optionally, "impacts bounce"),
                      future<T>("continuous", "impacts inside a step"),
                  })});
}

Codec<double> field_of_view() { return number(inside(0, 180), "degrees"); }

Codec<OrbitSettings> orbit_section() {
  using T = OrbitSettings;
  return section<T>(
      "render.camera.orbit",
      "The camera turns about the axis through `to` against gravity, counter-clockwise from above. Exactly "
      "one "
      "key.",
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

Codec<CameraSettings> camera_section() {
  using T = CameraSettings;
  return section<T>(
      "render.camera", "Where pictures are taken from.",
      {
          key<T>("from", &T::from, optional(vector("m")), optionally,
                 "place of the camera; without it and `to`, chosen to see every body"),
          key<T>("to", &T::to, optional(vector("m")), optionally, "the point in the middle of the picture"),
          key<T>("fov", &T::fov, field_of_view(), optionally, "vertical field of view"),
          key<T>("orbit", &T::orbit, optional(orbit_section()), optionally, "the camera goes round"),
          key<T>("keyframes", &T::keyframes, list_of(keyframe_section()), optionally,
                 "instead of the other keys: places at ascending times, with a smooth way between them"),
      },
      check_camera);
}

/// The picture's size is one key, stored in two members.
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

Codec<RenderSettings> render_section() {
  using T = RenderSettings;
  const Codec<T> nothing{
      word_type({"false", "true"}, {}),
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
               key<T>("color", &T::color,
                      word<ColorBy>({{"material", ColorBy::material},
                                     {"speed", ColorBy::speed},
                                     {"size", ColorBy::size},
                                     {"kinetic_energy", ColorBy::kinetic_energy},
                                     {"force", ColorBy::force},
                                     {"level", ColorBy::level},
                                     {"id", ColorBy::id}}),
                      optionally,
                      "what the colours show; force: sum of the contact forces on a body; level: of the "
                      "hierarchical grid"),
               key<T>("range", &T::range, or_auto(array_of<2>(number())), optionally,
                      "[low, high] of the colour scale in SI units, the same for all pictures; auto: guessed "
                      "from the scene"),
               key<T>("legend", &T::legend, or_auto(boolean()), optionally,
                      "colour scale and width of the grid's cells; auto: where there is room for it"),
               key<T>("time_stamp", &T::time_stamp, or_auto(boolean()), optionally,
                      "the time; auto: likewise"),
               key<T>("overlay", &T::overlay,
                      list_of(word<Overlay>(
                          {{"grid", Overlay::grid}, {"pairs", Overlay::pairs}, {"forces", Overlay::forces}})),
                      optionally,
                      "lines over the bodies: occupied cells of the hierarchical grid, the pairs that the "
                      "broad phase found, "
                      "contact forces as lines as wide as they are strong"),
           },
           check_render)});
}

Codec<RecordEntry> record_section() {
  using T = RecordEntry;
  return section<T>(
      "record", "What a run writes besides pictures.",
      {
          key<T>("metrics_every", &T::metrics_every, number(above_zero, "s"), optionally,
                 "simulated time between rows of metrics.csv"),
          key<T>("trajectory", &T::trajectory, word<Trajectory>({{"false", Trajectory::none}}, {"true"}),
                 optionally, "the motion of every body"),
          future<T>("checkpoint_every", "time between saved states"),
      });
}

/// Left out of the resolved scene where it means nothing, and refused there.
Key<CheckEntry> crossings_level() {
  using T = CheckEntry;
  Key<T> level = with_default(
      key<T>("level", &T::level, number(), optionally, "of crossings, in the unit of the measure"), "0");
  level.write = [write = level.write](const T& check) {
    return check.reduce == Reduce::crossings ? write(check) : std::nullopt;
  };
  return level;
}

Codec<CheckEntry> check_section() {
  using T = CheckEntry;
  return section<T>(
      "checks[]", "The scene's own acceptance test. Each compares a measure with what is expected.",
      {
          key<T>("measure", &T::measure, text(), required, "what is measured; see Measures"),
          key<T>("at", &T::at, optional(number(not_negative, "s")), optionally,
                 "when: at the step nearest to this time; at the end if neither `at` nor `over` is given"),
          key<T>("over", &T::over, optional(array_of<2>(number(not_negative, "s"))), optionally,
                 "[start, end]: over every step between, ends included; needs `reduce`"),
          key<T>("reduce", &T::reduce,
                 word<Reduce>({{"max", Reduce::max},
                               {"min", Reduce::min},
                               {"mean", Reduce::mean},
                               {"drift", Reduce::drift},
                               {"range", Reduce::range},
                               {"crossings", Reduce::crossings}}),
                 optionally,
                 "what is made of the values in `over`; drift: the largest change since its start; "
                 "crossings: how "
                 "often they pass `level`"),
          crossings_level(),
          key<T>("expect", &T::expect, optional(number()), optionally,
                 "the value, within `tolerance` or `relative`"),
          key<T>("tolerance", &T::tolerance, optional(number(not_negative)), optionally,
                 "of `expect`, in the unit of the measure"),
          key<T>("relative", &T::relative, optional(number(not_negative)), optionally,
                 "of `expect`, as a share"),
          key<T>("below", &T::below, optional(number()), optionally, "the measure must be less"),
          key<T>("above", &T::above, optional(number()), optionally, "the measure must be more"),
      },
      check_check);
}

}  // namespace

const Codec<SceneEntry>& scene_codec() {
  using T = SceneEntry;
  static const Codec<T> codec = section<T>(
      "scene", "The top of a scene file.",
      {
          key<T>("format", &T::format, integer(between(1, 1)), required, "version of the scene language"),
          key<T>("name", &T::name, file_name(), optionally,
                 "names the run folder; the file's stem if not given"),
          key<T>("label", &T::label, identifier(), optionally,
                 "`long` scenes are left out of verify unless asked for"),
          key<T>("seed", &T::seed, seed_integer(), optionally, "every random choice follows from it"),
          key<T>("gravity", &T::gravity, vector("m/s^2"), optionally, "acceleration of free bodies"),
          key<T>("time", &T::time, time_section(), required, "length and step of the run"),
          key<T>("materials", &T::materials, named(material_section(), most_names), required,
                 "a map of names to materials"),
          key<T>("contacts", &T::contacts, list_of(contact_section()), optionally,
                 "laws of pairs of materials"),
          key<T>("bodies", &T::bodies, list_of(body_section(), 1), required, "the bodies"),
          key<T>("forces", &T::forces, list_of(force_section()), optionally, "forces besides gravity"),
          key<T>("regions", &T::regions, named(region_section(), most_names), optionally,
                 "a map of names to boxes to measure in"),
          key<T>("response", &T::response, response_section(), optionally, "how contacts answer"),
          key<T>("broadphase", &T::broadphase, broadphase_section(), optionally, "how pairs are found"),
          key<T>("narrowphase", &T::narrowphase, narrowphase_section(), optionally, "how contacts are found"),
          key<T>("precision", &T::precision,
                 word<Precision>({{"double", Precision::double_precision}}, {"mixed"}), optionally,
                 "of the state"),
          key<T>("model", &T::model, model_section(), optionally, "features to compute"),
          key<T>("render", &T::render, render_section(), optionally, "the pictures"),
          key<T>("record", &T::record, record_section(), optionally, "what is written besides"),
          key<T>("checks", &T::checks, list_of(check_section()), optionally, "the scene's own test"),
          future<T>("crosscheck", "the run again by other means, compared"),
      });
  return codec;
}

}  // namespace scree
