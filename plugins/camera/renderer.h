#pragma once
/// \file
/// Draws lists of solids and triangles with OpenGL.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "api/appearance.h"
#include "api/camera.h"
#include "gl_context.h"
#include "image.h"
#include "meshes/visual_mesh.h"

namespace spark::camera {

using meshes::MeshMaterial, meshes::MeshPart;

/// What a batch consists of. Sizes are those of Instance::size: half the box around it, and a radius.
enum class Shape : std::uint8_t {
  box,       ///< of any size
  sphere,    ///< of radius 1, size 1 1 1
  cylinder,  ///< along z, size r r h r
  capsule,   ///< along z, size r r h r, h with its caps
  plane,     ///< z = 0, seen from above, without end
  mesh       ///< triangles
};
inline constexpr std::size_t kShapes = 6;

/// One solid, or one use of a mesh, as the shaders read it.
struct Instance {
  std::array<std::array<float, 4>, 3> toCamera;  ///< rows of the matrix from the local frame to the camera's
  std::array<std::array<float, 4>, 3> toLocal;   ///< rows of its inverse
  std::array<float, 4> size;                     ///< see Shape
  Color ambient, diffuse, specular, emission;
  float shininess;
  float number;  ///< in segmentations; whole
};

/// Instances that are drawn by one call.
struct Batch {
  Shape shape = Shape::box;
  bool transparent = false;          ///< blended with what is behind it
  const MeshPart* mesh = nullptr;    ///< of Shape::mesh
  const Image* texture = nullptr;    ///< nullptr: none
  std::size_t first = 0, count = 0;  ///< in Drawing::instances
};

/// A light at a point.
struct Lamp {
  std::array<float, 3> place, diffuse, specular;  ///< place in the camera's frame [m]
};
/// The most lamps of a picture.
inline constexpr std::size_t kLamps = 8;

/// Everything that one picture shows, in the camera's frame.
struct Drawing {
  std::vector<Instance> instances;
  std::vector<Batch> batches;  ///< opaque ones first
  std::vector<Lamp> lamps;     ///< at most kLamps
  std::array<float, 3> ambient{};
  Color background;
  void clear() { instances.clear(), batches.clear(), lamps.clear(), ambient = {}; }
};

/// Tangents of half the field of view of a shot, horizontal and vertical.
std::array<double, 2> slopeOf(const CameraShot& shot);

/// The renderer. One thread at a time.
class Renderer {
 public:
  /// `library`: file name of EGL. Throws Error that says what is missing.
  explicit Renderer(const std::string& library);
  /// Draws into `out`. Meshes and images of the drawing must live as long as the renderer. Throws Error.
  void draw(const CameraShot& shot, const Drawing& drawing, Picture& out);
  /// What renders, for people.
  const std::string& name() const { return context_.renderer(); }

 private:
  /// A shader program and its uniforms.
  struct Program {
    GLuint id = 0;
    GLint slope, pixel, viewport, range, lights, ambientLight, lightPlace, lightDiffuse, lightSpecular, textured;
  };
  struct Vertices {
    GLuint array = 0;
    GLsizei count = 0;
  };
  void makeCube();
  void makeTargets(int width, int height);
  void forgetTargets();
  const Program& program(Shape shape, PictureKind kind);
  GLuint compile(GLenum stage, const std::string& head, const char* text);
  const Vertices& vertices(const MeshPart& mesh);
  GLuint texture(const Image& image);
  void bindInstances(std::size_t first);
  void setUniforms(const Program& program, const CameraShot& shot, const Drawing& drawing);
  void drawBatches(const CameraShot& shot, const Drawing& drawing);
  void read(const CameraShot& shot, Picture& out);

  GlContext context_;
  const GlFunctions& gl_;
  std::array<std::array<Program, 3>, kShapes> programs_;
  Vertices cube_;
  GLuint instances_ = 0;                           ///< buffer of the instances
  GLuint colourFrame_ = 0, numberFrame_ = 0;       ///< frames of pictures in colour, and of numbers
  GLuint colours_ = 0, numbers_ = 0, depths_ = 0;  ///< their buffers
  int width_ = 0, height_ = 0;                     ///< size of these buffers [px]
  std::map<const MeshPart*, Vertices> meshes_;
  std::map<const Image*, GLuint> textures_;
  std::vector<std::uint8_t> rows_;  ///< what was read, with opacity
};

}  // namespace spark::camera
