#pragma once
/// \file
/// Reads the shapes of links: what collides and what is seen.

#include <array>
#include <map>
#include <string>

#include "elements.h"
#include "urdf_reader.h"

namespace spark::urdf {

/// Reads the elements `collision` and `visual` of one robot. A mesh is read once.
class GeometryReader {
 public:
  /// `root`: the element `robot`, for its materials. `readMesh` and `unsupported` must outlive the reader. Throws
  /// Error.
  GeometryReader(const Element& root, const ReadMesh& readMesh, Unsupported& unsupported);
  /// Adds the shapes of a link to its body. Throws Error.
  void read(const Element& link, mjcf::Body& body);

 private:
  std::optional<mjcf::Geom> geom(const Element& e, bool collides);
  std::optional<engine::ShapeDescription> shapeOf(const Element& geometry);
  engine::ShapeDescription meshOf(const Element& e);
  std::optional<std::array<double, 4>> colorOf(const Element& e);

  const ReadMesh& readMesh_;
  Unsupported& unsupported_;
  std::map<std::string, std::array<double, 4>, std::less<>> materials_;  ///< colours by name
  std::map<std::string, engine::ShapeDescription> meshes_;               ///< hulls by file and scale
  std::size_t numbers_ = 0;                                              ///< of all meshes
};

}  // namespace spark::urdf
