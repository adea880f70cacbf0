#pragma once
/// \file
/// Reads the shapes of links: what collides and what is seen.

#include <array>
#include <map>
#include <string>

#include "elements.h"
#include "urdf_reader.h"

namespace spark::urdf {

/// Reads the elements `collision` and `visual` of one robot. One that cannot be read is left out, and named. A mesh is
/// read once.
class GeometryReader {
 public:
  /// `root`: the element `robot`, for its materials. `readMesh` and `unsupported` must outlive the reader.
  GeometryReader(const Element& root, const ReadMesh& readMesh, Unsupported& unsupported);
  /// Adds the shapes of a link to its body.
  void read(const Element& link, mjcf::Body& body);
  /// Of the meshes that were read.
  const mjcf::Surfaces& surfaces() const { return surfaces_; }

 private:
  /// A mesh of a file, with its size; or why there is none.
  struct ReadHull {
    std::optional<engine::ShapeDescription> shape;
    std::string why;
  };
  using Color = std::array<double, 4>;

  std::optional<mjcf::Geom> geom(const Element& e, bool collides);
  std::optional<engine::ShapeDescription> shapeOf(const Element& part, const Element& geometry);
  std::optional<engine::ShapeDescription> meshOf(const Element& part, const Element& e);
  ReadHull hullOf(const Element& e, const std::string& file, const Vec3& scale);
  std::optional<Color> ownColor(const Element& material);
  std::optional<Color> colorOf(const Element& visual);
  void leaveOut(const Element& part, const Element& at, const std::string& why);

  const ReadMesh& readMesh_;
  Unsupported& unsupported_;
  std::map<std::string, Color, std::less<>> materials_;  ///< colours by name
  std::map<std::string, ReadHull, std::less<>> meshes_;  ///< by file and scale
  mjcf::Surfaces surfaces_;
  std::size_t numbers_ = 0;  ///< of all meshes
};

}  // namespace spark::urdf
