#include "render/gl/gl_renderer.hpp"

#include "core/error.hpp"
#include "render/gl/frame_data.hpp"
#include "render/gl/objects.hpp"
#include "render/gl/shaders.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace scree::render::gl {

namespace {

using namespace std::string_view_literals;

// The texture units. Each sampler of the shaders keeps its own unit.
enum Unit : GLint {
  bodies_unit,
  lines_unit,
  tags_unit,
  geometry_unit,
  occlusion_unit,
  shadow_unit,
  depths_unit,
  unit_count
};
constexpr std::array<const char*, unit_count> samplers = {
    "bodies", "lines", "tags", "geometry", "occlusion", "shadow_map", "shadow_depths"};

// Makes a program, and binds its uniform block and its samplers. Samplers that the program lacks do no harm.
Program make_pass(const Functions& gl, const char* name, std::vector<std::string_view> vertex,
                  std::vector<std::string_view> fragment, std::string_view variant = ""sv) {
  const std::string head = "#version 330 core\n" + std::string(variant);
  vertex.insert(vertex.begin(), {head, shaders::common});
  fragment.insert(fragment.begin(), {head, shaders::common});
  Program program = make_program(gl, name, vertex, fragment);
  gl.UseProgram(program.name());
  gl.UniformBlockBinding(program.name(), gl.GetUniformBlockIndex(program.name(), "Frame"), 0);
  for (GLint unit = 0; unit < unit_count; ++unit) {
    gl.Uniform1i(gl.GetUniformLocation(program.name(), samplers[static_cast<std::size_t>(unit)]), unit);
  }
  return program;
}

constexpr std::string_view for_shadow = "#define SHADOW\n", for_tube = "#define TUBE\n";

struct Passes {
  explicit Passes(const Functions& gl)
      : sphere_shadow(make_pass(gl, "sphere shadow", {shaders::sphere_vert},
                                {shaders::sphere, shaders::sphere_frag}, for_shadow)),
        box_shadow(make_pass(gl, "box shadow", {shaders::box_vert}, {shaders::flat_frag}, for_shadow)),
        facet_shadow(make_pass(gl, "facet shadow", {shaders::facet_vert}, {shaders::flat_frag}, for_shadow)),
        sphere(make_pass(gl, "sphere", {shaders::sphere_vert}, {shaders::sphere, shaders::sphere_frag})),
        box(make_pass(gl, "box", {shaders::box_vert}, {shaders::flat_frag})),
        facet(make_pass(gl, "facet", {shaders::facet_vert}, {shaders::flat_frag})),
        plane(make_pass(gl, "plane", {shaders::plane_vert}, {shaders::plane, shaders::plane_frag})),
        tube(make_pass(gl, "tube", {shaders::plane_vert}, {shaders::tube, shaders::tube_frag}, for_tube)),
        geometry(make_pass(
            gl, "geometry", {shaders::picture_vert},
            {shaders::sphere, shaders::plane, shaders::tube, shaders::surface, shaders::geometry_frag})),
        occlusion(make_pass(gl, "occlusion", {shaders::picture_vert}, {shaders::occlusion_frag})),
        smooth(make_pass(gl, "smooth", {shaders::picture_vert}, {shaders::smooth_frag})),
        shade(make_pass(
            gl, "shade", {shaders::picture_vert},
            {shaders::sphere, shaders::plane, shaders::tube, shaders::surface, shaders::shade_frag})),
        line(make_pass(gl, "line", {shaders::line_vert}, {shaders::line_frag})) {}

  Program sphere_shadow, box_shadow, facet_shadow, sphere, box, facet, plane, tube, geometry, occlusion,
      smooth, shade, line;
};

struct Images {
  Images(const Functions& gl, int width, int height, int shadow_size)
      : shadow(make_shadow_image(gl, shadow_size)),
        tags(make_image(gl, tag_format, 2 * width, 2 * height)),
        depth(make_image(gl, depth_format, 2 * width, 2 * height)),
        geometry(make_image(gl, vector_format, width, height)),
        raw_occlusion(make_image(gl, pair_format, width, height)),
        occlusion(make_image(gl, scalar_format, width, height)),
        color(make_image(gl, color_format, width, height)),
        to_shadow(make_framebuffer(gl, nullptr, &shadow)),
        to_tags(make_framebuffer(gl, &tags, &depth)),
        to_geometry(make_framebuffer(gl, &geometry, nullptr)),
        to_raw_occlusion(make_framebuffer(gl, &raw_occlusion, nullptr)),
        to_occlusion(make_framebuffer(gl, &occlusion, nullptr)),
        to_color(make_framebuffer(gl, &color, nullptr)) {}

  Texture shadow, tags, depth, geometry, raw_occlusion, occlusion, color;
  Framebuffer to_shadow, to_tags, to_geometry, to_raw_occlusion, to_occlusion, to_color;
};

Context& made_current(Context& context) {
  context.make_current();
  return context;
}

class GlRenderer : public Renderer {
 public:
  GlRenderer(std::unique_ptr<Context> context, int width, int height)
      : context_(std::move(context)),
        gl_(made_current(*context_)),
        width_(width),
        height_(height),
        shadow_size_(shadow_size_for(width, height)),
        passes_(gl_),
        images_(gl_, width, height, shadow_size_),
        depths_(make_depth_sampler(gl_)),
        no_attributes_(make_vertex_array(gl_)),
        uniforms_(make_buffer(gl_)),
        bodies_(make_buffer(gl_)),
        bodies_view_(make_buffer_texture(gl_, bodies_)),
        lines_(make_buffer(gl_)),
        lines_view_(make_buffer_texture(gl_, lines_)) {
    gl_.BindSampler(depths_unit, depths_.name());
    gl_.BindVertexArray(no_attributes_.name());
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most_texels_);
  }
  // The context must be current here, because the OpenGL objects of the members are deleted after this.
  ~GlRenderer() override { context_->make_current(); }

  Image draw(const Frame& frame, const Camera& camera, const Style& style) override {
    context_->make_current();
    set_frame_data(frame, camera, style, width_, height_, shadow_size_, hidden_for(frame), data_);
    upload(data_);
    draw_shadow(data_);
    draw_tags(data_);
    draw_occlusion();
    draw_picture(passes_.shade, images_.to_color);
    draw_lines(static_cast<int>(data_.lines.size() / 3));
    return read_back();
  }

  std::string name() const override {
    return context_->name() + ", " + reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER));
  }

 private:
  /// Returns whether hidden bodies are drawn. A GPU draws all bodies faster than the processor finds the
  /// visible ones, if its buffer texture can hold so many texels.
  Hidden hidden_for(const Frame& frame) const {
    const std::int64_t texels = 8 * (frame.snapshot.bodies.count() + 1);
    return context_->is_hardware() && texels <= most_texels_ ? Hidden::drawn : Hidden::left_out;
  }

  void upload(const FrameData& data) {
    gl_.BindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    gl_.BufferData(GL_UNIFORM_BUFFER, sizeof(data.uniforms), &data.uniforms, GL_STREAM_DRAW);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
    upload(bodies_, data.texels, "bodies, casters of shadows counted again");
    upload(lines_, data.lines, "lines");
    bind(bodies_unit, GL_TEXTURE_BUFFER, bodies_view_);
    bind(lines_unit, GL_TEXTURE_BUFFER, lines_view_);
    bind(tags_unit, GL_TEXTURE_2D, images_.tags);
    bind(geometry_unit, GL_TEXTURE_2D, images_.geometry);
    bind(shadow_unit, GL_TEXTURE_2D, images_.shadow);
    bind(depths_unit, GL_TEXTURE_2D, images_.shadow);
  }

  void upload(const Buffer& buffer, const std::vector<Vec4f>& texels, const char* what) {
    if (texels.size() > static_cast<std::size_t>(most_texels_)) {
      throw RunError("OpenGL reads at most " + std::to_string(most_texels_) +
                     " texels here; this picture's " + what + ", take " + std::to_string(texels.size()));
    }
    gl_.BindBuffer(GL_TEXTURE_BUFFER, buffer.name());
    gl_.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(texels.size() * sizeof(Vec4f)), texels.data(),
                   GL_STREAM_DRAW);
  }

  void draw_shadow(const FrameData& data) {
    const GLfloat far = 1;
    target(images_.to_shadow, shadow_size_, shadow_size_);
    gl_.ClearBufferfv(GL_DEPTH, 0, &far);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    draw_triangles(passes_.sphere_shadow, data.casting_spheres());
    draw_triangles(passes_.box_shadow, 6 * data.casting_boxes());
    draw_triangles(passes_.facet_shadow, data.facets());
  }

  void draw_tags(const FrameData& data) {
    const GLfloat far = 0;
    const std::array<GLuint, 4> nothing{};
    target(images_.to_tags, 2 * width_, 2 * height_);
    gl_.ClearBufferfv(GL_DEPTH, 0, &far);
    gl_.ClearBufferuiv(GL_COLOR, 0, nothing.data());
    gl_.DepthFunc(GL_GREATER);
    draw_triangles(passes_.sphere, data.spheres());
    draw_triangles(passes_.box, 6 * data.boxes());
    draw_triangles(passes_.facet, data.facets());
    draw_triangles(passes_.tube, data.tubes());
    draw_triangles(passes_.plane, data.grounds());
    gl_.Disable(GL_DEPTH_TEST);
  }

  void draw_occlusion() {
    draw_picture(passes_.geometry, images_.to_geometry);
    draw_picture(passes_.occlusion, images_.to_raw_occlusion);
    bind(occlusion_unit, GL_TEXTURE_2D, images_.raw_occlusion);
    draw_picture(passes_.smooth, images_.to_occlusion);
    bind(occlusion_unit, GL_TEXTURE_2D, images_.occlusion);
  }

  void draw_lines(int count) {
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    draw_triangles(passes_.line, 2 * count);
    gl_.Disable(GL_BLEND);
  }

  Image read_back() {
    const std::size_t row = 3 * static_cast<std::size_t>(width_);
    std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(height_));
    gl_.ReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
    if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
      throw RunError("OpenGL failed to draw a picture, error " + std::to_string(error));
    }
    Image image{width_, height_, std::vector<std::uint8_t>(upward.size())};
    for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
      std::copy_n(upward.end() - static_cast<std::ptrdiff_t>((y + 1) * row), row,
                  image.rgb.begin() + static_cast<std::ptrdiff_t>(y * row));
    }
    return image;
  }

  void bind(Unit unit, GLenum kind, const Texture& texture) {
    gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_.BindTexture(kind, texture.name());
  }
  void target(const Framebuffer& framebuffer, int width, int height) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl_.Viewport(0, 0, width, height);
  }
  void draw_triangles(const Program& program, int count) {
    if (count == 0) return;
    gl_.UseProgram(program.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3 * count);
  }
  void draw_picture(const Program& program, const Framebuffer& framebuffer) {
    target(framebuffer, width_, height_);
    draw_triangles(program, 1);
  }

  std::unique_ptr<Context> context_;
  Functions gl_;
  int width_, height_, shadow_size_;
  GLint most_texels_ = 0;  // largest number of texels in a buffer texture
  Passes passes_;
  Images images_;
  Sampler depths_;
  VertexArray no_attributes_;
  FrameData data_;
  Buffer uniforms_, bodies_;
  Texture bodies_view_;
  Buffer lines_;
  Texture lines_view_;
};

}  // namespace

std::unique_ptr<Renderer> make_gl_renderer(std::unique_ptr<Context> context, int width, int height) {
  return std::make_unique<GlRenderer>(std::move(context), width, height);
}

}  // namespace scree::render::gl
