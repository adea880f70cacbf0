#pragma once
/// \file
/// The functions of OpenGL 3.3 that the renderer calls. No library of OpenGL is linked: GlContext looks them up.

#include <GL/glcorearb.h>

namespace spark::camera {

// Name without "gl", and the type of its pointer without PFN...PROC.
#define SPARK_GL_FUNCTIONS(X)                           \
  X(AttachShader, GLATTACHSHADER)                       \
  X(BindBuffer, GLBINDBUFFER)                           \
  X(BindFramebuffer, GLBINDFRAMEBUFFER)                 \
  X(BindRenderbuffer, GLBINDRENDERBUFFER)               \
  X(BindTexture, GLBINDTEXTURE)                         \
  X(BindVertexArray, GLBINDVERTEXARRAY)                 \
  X(BlendFunc, GLBLENDFUNC)                             \
  X(BufferData, GLBUFFERDATA)                           \
  X(CheckFramebufferStatus, GLCHECKFRAMEBUFFERSTATUS)   \
  X(Clear, GLCLEAR)                                     \
  X(ClearBufferfv, GLCLEARBUFFERFV)                     \
  X(ClearBufferuiv, GLCLEARBUFFERUIV)                   \
  X(CompileShader, GLCOMPILESHADER)                     \
  X(CreateProgram, GLCREATEPROGRAM)                     \
  X(CreateShader, GLCREATESHADER)                       \
  X(CullFace, GLCULLFACE)                               \
  X(DeleteShader, GLDELETESHADER)                       \
  X(DepthFunc, GLDEPTHFUNC)                             \
  X(DepthMask, GLDEPTHMASK)                             \
  X(Disable, GLDISABLE)                                 \
  X(DrawArraysInstanced, GLDRAWARRAYSINSTANCED)         \
  X(DrawElementsInstanced, GLDRAWELEMENTSINSTANCED)     \
  X(Enable, GLENABLE)                                   \
  X(EnableVertexAttribArray, GLENABLEVERTEXATTRIBARRAY) \
  X(FramebufferRenderbuffer, GLFRAMEBUFFERRENDERBUFFER) \
  X(GenBuffers, GLGENBUFFERS)                           \
  X(GenFramebuffers, GLGENFRAMEBUFFERS)                 \
  X(GenRenderbuffers, GLGENRENDERBUFFERS)               \
  X(GenTextures, GLGENTEXTURES)                         \
  X(GenVertexArrays, GLGENVERTEXARRAYS)                 \
  X(GenerateMipmap, GLGENERATEMIPMAP)                   \
  X(GetError, GLGETERROR)                               \
  X(GetProgramInfoLog, GLGETPROGRAMINFOLOG)             \
  X(GetProgramiv, GLGETPROGRAMIV)                       \
  X(GetShaderInfoLog, GLGETSHADERINFOLOG)               \
  X(GetString, GLGETSTRING)                             \
  X(GetUniformLocation, GLGETUNIFORMLOCATION)           \
  X(LinkProgram, GLLINKPROGRAM)                         \
  X(PixelStorei, GLPIXELSTOREI)                         \
  X(ReadPixels, GLREADPIXELS)                           \
  X(RenderbufferStorage, GLRENDERBUFFERSTORAGE)         \
  X(ShaderSource, GLSHADERSOURCE)                       \
  X(TexImage2D, GLTEXIMAGE2D)                           \
  X(TexParameteri, GLTEXPARAMETERI)                     \
  X(Uniform1f, GLUNIFORM1F)                             \
  X(Uniform1i, GLUNIFORM1I)                             \
  X(Uniform2f, GLUNIFORM2F)                             \
  X(Uniform3fv, GLUNIFORM3FV)                           \
  X(UseProgram, GLUSEPROGRAM)                           \
  X(VertexAttribDivisor, GLVERTEXATTRIBDIVISOR)         \
  X(VertexAttribPointer, GLVERTEXATTRIBPOINTER)         \
  X(Viewport, GLVIEWPORT)

/// Pointers to them, valid in any thread in which a context of the same display is current.
struct GlFunctions {
#define SPARK_GL_MEMBER(Name, Type) PFN##Type##PROC Name = nullptr;
  SPARK_GL_FUNCTIONS(SPARK_GL_MEMBER)
#undef SPARK_GL_MEMBER
};

}  // namespace spark::camera
