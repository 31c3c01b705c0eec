#include "render/gl/objects.hpp"

#include "core/error.hpp"

namespace scree::render::gl {

namespace {

Texture make_texture(const Functions& gl) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  return {gl, name};
}

Shader compile(const Functions& gl, GLenum stage, const char* name,
               const std::vector<std::string_view>& pieces) {
  Shader shader(gl, gl.CreateShader(stage));
  std::vector<const GLchar*> texts;
  std::vector<GLint> lengths;
  for (const std::string_view piece : pieces) {
    texts.push_back(piece.data());
    lengths.push_back(static_cast<GLint>(piece.size()));
  }
  gl.ShaderSource(shader.name(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  gl.CompileShader(shader.name());
  GLint compiled = 0;
  gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw RunError(std::string("OpenGL does not compile the shader ") + name + ": " + log);
  }
  return shader;
}

}  // namespace

Buffer make_buffer(const Functions& gl) {
  GLuint name = 0;
  gl.GenBuffers(1, &name);
  return {gl, name};
}

VertexArray make_vertex_array(const Functions& gl) {
  GLuint name = 0;
  gl.GenVertexArrays(1, &name);
  return {gl, name};
}

Texture make_image(const Functions& gl, const PixelFormat& format, int width, int height) {
  Texture texture = make_texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internal), width, height, 0, format.format,
                format.type, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

Texture make_shadow_image(const Functions& gl, int size) {
  Texture texture = make_image(gl, depth_format, size, size);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  return texture;
}

Sampler make_depth_sampler(const Functions& gl) {
  GLuint name = 0;
  gl.GenSamplers(1, &name);
  gl.SamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.SamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.SamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.SamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return {gl, name};
}

Texture make_buffer_texture(const Functions& gl, const Buffer& buffer) {
  // The buffer becomes an object only at its first binding, and only an object can be viewed.
  gl.BindBuffer(GL_TEXTURE_BUFFER, buffer.name());
  Texture texture = make_texture(gl);
  gl.BindTexture(GL_TEXTURE_BUFFER, texture.name());
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer.name());
  return texture;
}

Framebuffer make_framebuffer(const Functions& gl, const Texture* color, const Texture* depth) {
  GLuint name = 0;
  gl.GenFramebuffers(1, &name);
  Framebuffer framebuffer(gl, name);
  gl.BindFramebuffer(GL_FRAMEBUFFER, name);
  if (color != nullptr) gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color->name(), 0);
  if (depth != nullptr) gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth->name(), 0);
  gl.DrawBuffer(color != nullptr ? GL_COLOR_ATTACHMENT0 : GL_NONE);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw RunError("OpenGL cannot draw into an image of this size and format");
  }
  return framebuffer;
}

Program make_program(const Functions& gl, const char* name, const std::vector<std::string_view>& vertex,
                     const std::vector<std::string_view>& fragment) {
  const Shader vertex_shader = compile(gl, GL_VERTEX_SHADER, name, vertex);
  const Shader fragment_shader = compile(gl, GL_FRAGMENT_SHADER, name, fragment);
  Program program(gl, gl.CreateProgram());
  gl.AttachShader(program.name(), vertex_shader.name());
  gl.AttachShader(program.name(), fragment_shader.name());
  gl.LinkProgram(program.name());
  GLint linked = 0;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw RunError(std::string("OpenGL does not link the shader ") + name + ": " + log);
  }
  return program;
}

}  // namespace scree::render::gl
