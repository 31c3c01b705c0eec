// The OpenGL functions that the renderer calls, loaded from a context.
#pragma once

#include "render/gl/context.hpp"

#include <GL/glcorearb.h>

// Each entry is X(name without gl, name in the PFNGL...PROC types).
#define SCREE_GL_FUNCTIONS(X)                       \
  X(ActiveTexture, ACTIVETEXTURE)                   \
  X(AttachShader, ATTACHSHADER)                     \
  X(BindBuffer, BINDBUFFER)                         \
  X(BindBufferBase, BINDBUFFERBASE)                 \
  X(BindFramebuffer, BINDFRAMEBUFFER)               \
  X(BindSampler, BINDSAMPLER)                       \
  X(BindTexture, BINDTEXTURE)                       \
  X(BindVertexArray, BINDVERTEXARRAY)               \
  X(BlendFunc, BLENDFUNC)                           \
  X(BufferData, BUFFERDATA)                         \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS) \
  X(ClearBufferfv, CLEARBUFFERFV)                   \
  X(ClearBufferuiv, CLEARBUFFERUIV)                 \
  X(CompileShader, COMPILESHADER)                   \
  X(CreateProgram, CREATEPROGRAM)                   \
  X(CreateShader, CREATESHADER)                     \
  X(DeleteBuffers, DELETEBUFFERS)                   \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)         \
  X(DeleteProgram, DELETEPROGRAM)                   \
  X(DeleteSamplers, DELETESAMPLERS)                 \
  X(DeleteShader, DELETESHADER)                     \
  X(DeleteTextures, DELETETEXTURES)                 \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)         \
  X(DepthFunc, DEPTHFUNC)                           \
  X(Disable, DISABLE)                               \
  X(DrawArrays, DRAWARRAYS)                         \
  X(DrawBuffer, DRAWBUFFER)                         \
  X(Enable, ENABLE)                                 \
  X(FramebufferTexture, FRAMEBUFFERTEXTURE)         \
  X(GenBuffers, GENBUFFERS)                         \
  X(GenFramebuffers, GENFRAMEBUFFERS)               \
  X(GenSamplers, GENSAMPLERS)                       \
  X(GenTextures, GENTEXTURES)                       \
  X(GenVertexArrays, GENVERTEXARRAYS)               \
  X(GetError, GETERROR)                             \
  X(GetIntegerv, GETINTEGERV)                       \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)           \
  X(GetProgramiv, GETPROGRAMIV)                     \
  X(GetShaderInfoLog, GETSHADERINFOLOG)             \
  X(GetShaderiv, GETSHADERIV)                       \
  X(GetString, GETSTRING)                           \
  X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)     \
  X(GetUniformLocation, GETUNIFORMLOCATION)         \
  X(LinkProgram, LINKPROGRAM)                       \
  X(PixelStorei, PIXELSTOREI)                       \
  X(ReadPixels, READPIXELS)                         \
  X(SamplerParameteri, SAMPLERPARAMETERI)           \
  X(ShaderSource, SHADERSOURCE)                     \
  X(TexBuffer, TEXBUFFER)                           \
  X(TexImage2D, TEXIMAGE2D)                         \
  X(TexParameteri, TEXPARAMETERI)                   \
  X(Uniform1i, UNIFORM1I)                           \
  X(UniformBlockBinding, UNIFORMBLOCKBINDING)       \
  X(UseProgram, USEPROGRAM)                         \
  X(Viewport, VIEWPORT)

namespace scree::render::gl {

/// The OpenGL functions as members, called as gl.DrawArrays(...). They are valid while their context is
/// current.
struct Functions {
  /// Loads the functions. Throws RunError with the name of a function that the context lacks. The context
  /// must be current.
  explicit Functions(const Context& context);

#define SCREE_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  SCREE_GL_FUNCTIONS(SCREE_GL_MEMBER)
#undef SCREE_GL_MEMBER
};

}  // namespace scree::render::gl
