#include "renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shaders.h"
#include "spark/error.h"

namespace spark::camera {

namespace {

/// The eight corners of a cube and its twelve triangles, which turn to the left as seen from outside.
constexpr float kCorners[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
constexpr std::uint8_t kTriangles[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

/// The floats of an Instance: attributes 4 to 14 have four each, the last one two.
constexpr GLuint kFirstAttribute = 4, kLastAttribute = 15;
static_assert(sizeof(Instance) == 46 * sizeof(float));

/// OpenGL's type for places in a buffer.
const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace

std::array<double, 2> slopeOf(const CameraShot& shot) {
  const double vertical = std::tan(degToRad(std::clamp(shot.fovDeg, 1.0, 179.0)) / 2);
  return {vertical * shot.width / shot.height, vertical};
}

Renderer::Renderer(const std::string& library) : context_(library), gl_(context_.gl()) {
  const GlContext::Current current(context_);
  gl_.GenBuffers(1, &instances_);
  makeCube();
  gl_.GenFramebuffers(1, &colourFrame_);
  gl_.GenFramebuffers(1, &numberFrame_);
  for (GLuint* buffer : {&colours_, &numbers_, &depths_}) gl_.GenRenderbuffers(1, buffer);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.CullFace(GL_FRONT);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
}

void Renderer::makeCube() {
  GLuint buffers[2];
  gl_.GenBuffers(2, buffers);
  gl_.GenVertexArrays(1, &cube_.array);
  gl_.BindVertexArray(cube_.array);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, sizeof kCorners, kCorners, GL_STATIC_DRAW);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_.EnableVertexAttribArray(0);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof kTriangles, kTriangles, GL_STATIC_DRAW);
  cube_.count = sizeof kTriangles;
}

void Renderer::makeTargets(int width, int height) {
  if (width <= width_ && height <= height_) return;
  width_ = std::max(width, width_), height_ = std::max(height, height_);
  const auto allocate = [this](GLuint buffer, GLenum format) {
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorage(GL_RENDERBUFFER, format, width_, height_);
  };
  allocate(colours_, GL_RGBA8);
  allocate(numbers_, GL_R16UI);
  allocate(depths_, GL_DEPTH_COMPONENT32F);
  for (const auto& [frame, buffer] : {std::pair(colourFrame_, colours_), std::pair(numberFrame_, numbers_)}) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths_);
    if (const GLenum status = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE) {
      forgetTargets();
      throw Error(fmt::format("OpenGL has no frame of {} x {} px (status {:#x})", width, height, status));
    }
  }
}

/// After a failure: the next picture makes its buffers anew and is not blamed for old errors.
void Renderer::forgetTargets() {
  width_ = height_ = 0;
  constexpr int kMostErrors = 16;  // a context that is lost may never run out of them
  for (int i = 0; i < kMostErrors && gl_.GetError() != GL_NO_ERROR; ++i) {
  }
}

GLuint Renderer::compile(GLenum stage, const std::string& head, const char* text) {
  const GLuint shader = gl_.CreateShader(stage);
  const char* const texts[] = {kVersion, head.c_str(), text};
  gl_.ShaderSource(shader, 3, texts, nullptr);
  gl_.CompileShader(shader);
  return shader;
}

const Renderer::Program& Renderer::program(Shape shape, PictureKind kind) {
  Program& p = programs_[std::size_t(shape)][std::size_t(kind)];
  if (p.id) return p;
  const std::string head = fmt::format("#define SHAPE {}\n#define PICTURE {}\n", int(shape), int(kind));
  const GLuint vertex = compile(GL_VERTEX_SHADER, head, kVertexShader),
               fragment = compile(GL_FRAGMENT_SHADER, head, kFragmentShader), id = gl_.CreateProgram();
  for (const GLuint shader : {vertex, fragment}) gl_.AttachShader(id, shader);
  gl_.LinkProgram(id);
  GLint linked = 0;
  gl_.GetProgramiv(id, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string texts[3];
    for (std::string& text : texts) text.resize(1000);
    gl_.GetShaderInfoLog(vertex, 1000, nullptr, texts[0].data());
    gl_.GetShaderInfoLog(fragment, 1000, nullptr, texts[1].data());
    gl_.GetProgramInfoLog(id, 1000, nullptr, texts[2].data());
    throw Error(fmt::format("OpenGL refuses a shader of shape {}, picture {}: {} {} {}", int(shape), int(kind),
                            texts[0].c_str(), texts[1].c_str(), texts[2].c_str()));
  }
  for (const GLuint shader : {vertex, fragment}) gl_.DeleteShader(shader);
  const auto place = [&](const char* name) { return gl_.GetUniformLocation(id, name); };
  p = {id,
       place("slope"),
       place("pixel"),
       place("viewport"),
       place("range"),
       place("lights"),
       place("ambientLight"),
       place("lightPlace"),
       place("lightDiffuse"),
       place("lightSpecular"),
       place("textured")};
  return p;
}

const Renderer::Vertices& Renderer::vertices(const MeshPart& mesh) {
  Vertices& v = meshes_[&mesh];
  if (v.array) return v;
  GLuint buffer = 0;
  gl_.GenBuffers(1, &buffer);
  gl_.GenVertexArrays(1, &v.array);
  gl_.BindVertexArray(v.array);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(meshes::Vertex)),
                 mesh.vertices.data(), GL_STATIC_DRAW);
  const struct {
    GLint count;
    std::size_t at;
  } fields[] = {{3, offsetof(meshes::Vertex, position)},
                {3, offsetof(meshes::Vertex, normal)},
                {2, offsetof(meshes::Vertex, place)},
                {3, offsetof(meshes::Vertex, faceNormal)}};
  for (GLuint i = 0; i < 4; ++i) {
    gl_.VertexAttribPointer(i, fields[i].count, GL_FLOAT, GL_FALSE, sizeof(meshes::Vertex), offset(fields[i].at));
    gl_.EnableVertexAttribArray(i);
  }
  v.count = static_cast<GLsizei>(mesh.vertices.size());
  return v;
}

GLuint Renderer::texture(const Image& image) {
  GLuint& id = textures_[&image];
  if (id) return id;
  gl_.GenTextures(1, &id);
  gl_.BindTexture(GL_TEXTURE_2D, id);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.pixels.data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return id;
}

void Renderer::bindInstances(std::size_t first) {
  gl_.BindBuffer(GL_ARRAY_BUFFER, instances_);
  for (GLuint i = kFirstAttribute; i <= kLastAttribute; ++i) {
    const std::size_t at = first * sizeof(Instance) + (i - kFirstAttribute) * 4 * sizeof(float);
    gl_.VertexAttribPointer(i, i == kLastAttribute ? 2 : 4, GL_FLOAT, GL_FALSE, sizeof(Instance), offset(at));
    gl_.EnableVertexAttribArray(i);
    gl_.VertexAttribDivisor(i, 1);
  }
}

void Renderer::setUniforms(const Program& p, const CameraShot& shot, const Drawing& drawing) {
  const auto [horizontal, vertical] = slopeOf(shot);
  gl_.Uniform2f(p.slope, float(horizontal), float(vertical));
  gl_.Uniform1f(p.pixel, float(2 * vertical / shot.height));
  gl_.Uniform2f(p.viewport, float(shot.width), float(shot.height));
  gl_.Uniform2f(p.range, float(shot.zNear), float(std::max(shot.zFar, shot.zNear + 1e-3)));
  if (shot.kind != PictureKind::colour) return;
  std::array<std::array<float, 3>, kLamps> places{}, diffuse{}, specular{};
  const std::size_t n = std::min(drawing.lamps.size(), kLamps);
  for (std::size_t i = 0; i < n; ++i)
    places[i] = drawing.lamps[i].place, diffuse[i] = drawing.lamps[i].diffuse, specular[i] = drawing.lamps[i].specular;
  gl_.Uniform1i(p.lights, GLint(n));
  gl_.Uniform3fv(p.ambientLight, 1, drawing.ambient.data());
  gl_.Uniform3fv(p.lightPlace, kLamps, places[0].data());
  gl_.Uniform3fv(p.lightDiffuse, kLamps, diffuse[0].data());
  gl_.Uniform3fv(p.lightSpecular, kLamps, specular[0].data());
}

void Renderer::drawBatches(const CameraShot& shot, const Drawing& drawing) {
  for (const Batch& b : drawing.batches) {
    if (b.transparent && shot.kind != PictureKind::colour) continue;
    const Program& p = program(b.shape, shot.kind);
    const Vertices& v = b.shape == Shape::mesh ? vertices(*b.mesh) : cube_;
    gl_.UseProgram(p.id);
    setUniforms(p, shot, drawing);
    if (shot.kind == PictureKind::colour) {
      gl_.Uniform1i(p.textured, b.texture != nullptr);
      if (b.texture) gl_.BindTexture(GL_TEXTURE_2D, texture(*b.texture));
    }
    (b.shape == Shape::mesh ? gl_.Disable : gl_.Enable)(GL_CULL_FACE);
    (b.transparent ? gl_.Enable : gl_.Disable)(GL_BLEND);
    gl_.DepthMask(!b.transparent);
    gl_.BindVertexArray(v.array);
    bindInstances(b.first);
    if (b.shape == Shape::mesh)
      gl_.DrawArraysInstanced(GL_TRIANGLES, 0, v.count, GLsizei(b.count));
    else
      gl_.DrawElementsInstanced(GL_TRIANGLES, v.count, GL_UNSIGNED_BYTE, nullptr, GLsizei(b.count));
  }
}

void Renderer::read(const CameraShot& shot, Picture& out) {
  const std::size_t pixels = std::size_t(shot.width) * std::size_t(shot.height);
  out.kind = shot.kind, out.width = shot.width, out.height = shot.height;
  out.pixels.resize(pixels * pixelBytes(shot.kind));
  if (shot.kind != PictureKind::colour)
    return gl_.ReadPixels(0, 0, shot.width, shot.height, GL_RED_INTEGER, GL_UNSIGNED_SHORT, out.pixels.data());
  rows_.resize(4 * pixels);
  gl_.ReadPixels(0, 0, shot.width, shot.height, GL_RGBA, GL_UNSIGNED_BYTE, rows_.data());
  for (std::size_t i = 0; i < pixels; ++i) std::copy_n(&rows_[4 * i], 3, &out.pixels[3 * i]);
}

void Renderer::draw(const CameraShot& shot, const Drawing& drawing, Picture& out) {
  const GlContext::Current current(context_);
  makeTargets(shot.width, shot.height);
  const bool inColour = shot.kind == PictureKind::colour;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, inColour ? colourFrame_ : numberFrame_);
  gl_.Viewport(0, 0, shot.width, shot.height);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  const Color& b = drawing.background;
  const float colour[] = {b.r, b.g, b.b, 1};
  const GLuint nothing[] = {0, 0, 0, 0};
  inColour ? gl_.ClearBufferfv(GL_COLOR, 0, colour) : gl_.ClearBufferuiv(GL_COLOR, 0, nothing);

  gl_.BindBuffer(GL_ARRAY_BUFFER, instances_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(drawing.instances.size() * sizeof(Instance)),
                 drawing.instances.data(), GL_STREAM_DRAW);
  drawBatches(shot, drawing);
  read(shot, out);
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    forgetTargets();
    throw Error(fmt::format("OpenGL reports error {:#x}", error));
  }
}

}  // namespace spark::camera
