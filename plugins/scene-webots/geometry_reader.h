#pragma once
/// \file
/// Reads shapes: what collides and what is seen.

#include <array>
#include <map>
#include <utility>

#include "reading.h"
#include "robot/geom_mass.h"

namespace spark::webots {

/// A mesh by the name that the file `of` gives it. Throws Error.
using ReadMesh = std::function<engine::Mesh(const std::string& of, const std::string& url)>;

/// Reads Shape nodes and bounding objects of one file. The mesh of a node is read once.
class GeometryReader {
 public:
  /// Both must outlive the reader.
  GeometryReader(Reading& reading, const ReadMesh& readMesh) : r_(reading), readMesh_(readMesh) {}
  /// A Shape, which is only seen. Throws Error.
  void shape(const Node& node, const Frame& frame, mjcf::Body& body);
  /// A bounding object: a geometry, a Shape, or a Group or Pose of them. `density`: of its parts [kg/m^3]; their masses
  /// are those of the geoms; nullopt: those do not matter. Throws Error.
  void bounds(const Node& node, const Frame& frame, std::optional<double> density, mjcf::Body& body);
  /// Of the meshes that were read.
  const mjcf::Surfaces& surfaces() const { return surfaces_; }

 private:
  std::optional<engine::ShapeDescription> geometry(const Node& node, const Frame& frame, bool collides);
  engine::Mass massOf(const engine::ShapeDescription& shape, const mjcf::Weight& weight, const Node& node);
  void count(const Node& node, const engine::Mesh& mesh);
  engine::ShapeDescription hull(const Node& node, const Vec3& scale);
  const engine::Mesh& meshOf(const Node& node);
  engine::Mesh meshFile(Fields& fields);
  engine::Mesh faces(Fields& fields);
  engine::Mesh grid(Fields& fields);
  std::optional<std::array<double, 4>> colorOf(const Node& appearance);
  void addBounds(const Node& node, const Frame& frame, std::optional<double> density, mjcf::Body& body);

  Reading& r_;
  const ReadMesh& readMesh_;
  std::map<const Node*, engine::Mesh> meshes_;                                                ///< without their scales
  std::map<std::pair<const Node*, std::array<double, 3>>, engine::ShapeDescription> shapes_;  ///< with them
  mjcf::Surfaces surfaces_;
  std::size_t numbers_ = 0;  ///< of all meshes
};

}  // namespace spark::webots
