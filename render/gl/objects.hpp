// OpenGL objects that delete themselves. Their context must be current wherever they are made, used or
// deleted.
#pragma once

#include "render/gl/functions.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scree::render::gl {

/// Owns one OpenGL name.
template <void (*destroy)(const Functions&, GLuint)>
class Object {
 public:
  Object(const Functions& gl, GLuint name) : gl_(&gl), name_(name) {}
  ~Object() {
    if (name_ != 0) destroy(*gl_, name_);
  }
  Object(Object&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  GLuint name() const { return name_; }

 private:
  const Functions* gl_;
  GLuint name_;
};

namespace detail {
inline void delete_buffer(const Functions& gl, GLuint name) { gl.DeleteBuffers(1, &name); }
inline void delete_texture(const Functions& gl, GLuint name) { gl.DeleteTextures(1, &name); }
inline void delete_framebuffer(const Functions& gl, GLuint name) { gl.DeleteFramebuffers(1, &name); }
inline void delete_vertex_array(const Functions& gl, GLuint name) { gl.DeleteVertexArrays(1, &name); }
inline void delete_sampler(const Functions& gl, GLuint name) { gl.DeleteSamplers(1, &name); }
inline void delete_shader(const Functions& gl, GLuint name) { gl.DeleteShader(name); }
inline void delete_program(const Functions& gl, GLuint name) { gl.DeleteProgram(name); }
}  // namespace detail

using Buffer = Object<detail::delete_buffer>;
using Texture = Object<detail::delete_texture>;
using Framebuffer = Object<detail::delete_framebuffer>;
using VertexArray = Object<detail::delete_vertex_array>;
using Sampler = Object<detail::delete_sampler>;
using Shader = Object<detail::delete_shader>;
using Program = Object<detail::delete_program>;

Buffer make_buffer(const Functions& gl);
VertexArray make_vertex_array(const Functions& gl);

/// The format of an image: the sized internal format, and the format and type that glTexImage2D needs with
/// it.
struct PixelFormat {
  GLenum internal;
  GLenum format;
  GLenum type;
};
inline constexpr PixelFormat tag_format = {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
inline constexpr PixelFormat depth_format = {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
inline constexpr PixelFormat vector_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
inline constexpr PixelFormat pair_format = {GL_RG32F, GL_RG, GL_FLOAT};
inline constexpr PixelFormat scalar_format = {GL_R16F, GL_RED, GL_FLOAT};
inline constexpr PixelFormat color_format = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};

/// Makes an image without mipmaps, which is read texel by texel.
Texture make_image(const Functions& gl, const PixelFormat& format, int width, int height);

/// Makes a depth image whose texels are compared when they are read, with bilinear weights. Everything
/// outside it is lit.
Texture make_shadow_image(const Functions& gl, int size);

/// Makes a sampler that reads a depth image as numbers, even if the image is set to compare.
Sampler make_depth_sampler(const Functions& gl);

/// Makes a view of a buffer as an array of texels of four floats.
Texture make_buffer_texture(const Functions& gl, const Buffer& buffer);

/// Makes a framebuffer that draws into color, depth or both; null stands for none. Throws RunError if OpenGL
/// reports it as incomplete.
Framebuffer make_framebuffer(const Functions& gl, const Texture* color, const Texture* depth);

/// Compiles and links a program. `vertex` and `fragment` are lists of pieces of GLSL that follow one another.
/// Throws RunError with `name` and the compiler's message.
Program make_program(const Functions& gl, const char* name, const std::vector<std::string_view>& vertex,
                     const std::vector<std::string_view>& fragment);

}  // namespace scree::render::gl
