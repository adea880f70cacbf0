#pragma once
/// \file
/// The node that holds the mesh of which MuJoCo makes the hull of a collider.

#include <memory>
#include <vector>

#include "api/extension.h"
#include "api/shape.h"

namespace spark {

namespace mujoco {

/// What MuJoCo makes the hull of a convex geom of, in place of the hull's own corners. Contacts are sought from the
/// centre of the mesh, and those with a plane are at corners that are neighbours in the hull, so that both depend on
/// it.
struct MeshNumbers {
  static constexpr std::string_view kKind = "MujocoMesh";
  const engine::Mesh* mesh = nullptr;  ///< kept by the node; nullptr: the hull
};

}  // namespace mujoco

/// What MuJoCo alone reads of the ConvexCollider above it. Nodes with the same numbers share one mesh.
class MujocoMesh : public engine::Extension<mujoco::MeshNumbers> {
  SPARK_CLASS(MujocoMesh, Leaf)
 public:
  static void describe(Description<MujocoMesh>& d);

 private:
  std::vector<double> vertices() const;
  void setVertices(std::vector<double> vertices);
  std::vector<std::int64_t> triangles() const;
  void setTriangles(const std::vector<std::int64_t>& triangles);
  void take(engine::Mesh mesh);
  std::shared_ptr<const engine::Mesh> mesh_;
};

}  // namespace spark
