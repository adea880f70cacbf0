#pragma once
/// \file
/// What ODE needs of meshes, hulls and height fields: made once for each, and shared by all geoms that have it.

#include <memory>
#include <span>
#include <vector>

#include "api/shape.h"
#include "convex_hull.h"
#include "ode_numbers.h"

namespace spark::ode {

/// A triangle mesh, with ODE's tree for search. ODE refers to the numbers of `mesh`.
struct OdeMesh {
  std::shared_ptr<const engine::Mesh> mesh;
  dTriMeshDataID data;
  explicit OdeMesh(std::shared_ptr<const engine::Mesh> mesh);
  ~OdeMesh();
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;
  /// What to collide convex shapes with in place of `geom`: of two triangles that lie on each other and look at
  /// opposite sides, ODE adds the normals up to nothing. So a mesh with such triangles is asked as two, one side at a
  /// time. Valid until the next call.
  std::span<const dGeomID> sidesAt(dGeomID geom);

 private:
  std::unique_ptr<OdeMesh> sides_[2];
  std::vector<dGeomID> asked_;  ///< geoms in no space, of sides_; or the last geom
};

/// A convex hull. ODE refers to its numbers.
///
/// When ODE makes a geom of a hull it compares each edge with all others: half a second for 7,000 corners. So geoms in
/// spaces have corners alone, which give their bounds, and one geom with faces is moved to where a question is asked.
class OdeHull {
 public:
  explicit OdeHull(std::shared_ptr<const engine::Mesh> mesh) : hull_(std::move(mesh)) {}
  ~OdeHull();
  OdeHull(const OdeHull&) = delete;
  OdeHull& operator=(const OdeHull&) = delete;
  const ConvexHull& hull() const { return hull_; }
  /// A geom in a space, without faces.
  dGeomID create(dSpaceID space) const;
  /// A geom with faces in no space, to be placed by the caller. It is made when it is first needed. `which`: 0 or 1, of
  /// two geoms that have the same hull.
  dGeomID probe(int which = 0);
  /// The same, placed like `geom`.
  dGeomID probeAt(dGeomID geom, int which);

 private:
  ConvexHull hull_;
  dGeomID probes_[2] = {nullptr, nullptr};
};

/// A height field. In ODE its heights are along y, and its rows along -z.
struct OdeHeights {
  std::shared_ptr<const engine::HeightField> field;
  dHeightfieldDataID data;
  explicit OdeHeights(std::shared_ptr<const engine::HeightField> field);
  ~OdeHeights() { dGeomHeightfieldDataDestroy(data); }
  OdeHeights(const OdeHeights&) = delete;
  OdeHeights& operator=(const OdeHeights&) = delete;
  /// From ODE's frame to that of the shape.
  static Mat3 toShape();
};

/// Those of a world.
struct MadeShapes {
  engine::MadeOf<engine::Mesh, OdeMesh> meshes;
  engine::MadeOf<engine::Mesh, OdeHull> hulls;
  engine::MadeOf<engine::HeightField, OdeHeights> heights;
};

/// What ODE's geom of a shape refers to.
struct SharedShape {
  std::shared_ptr<OdeMesh> mesh;
  std::shared_ptr<OdeHull> hull;
  std::shared_ptr<OdeHull> prism;  ///< of a cylinder that has met a mesh: see prismAround()
  std::shared_ptr<OdeHeights> heights;
};

inline constexpr std::uint32_t kPrismSides = 32;
/// A prism of kPrismSides sides around a cylinder, with a corner along x. ODE's own contacts of cylinders and meshes
/// throw them about.
std::shared_ptr<OdeHull> prismAround(const engine::ShapeDescription& cylinder);
/// Creates ODE's geom of a shape. What it refers to is written to `shared`.
dGeomID createGeom(const engine::ShapeDescription& shape, dSpaceID space, MadeShapes& made, SharedShape& shared);
void destroyGeom(dGeomID geom);
/// Updates the bounds of a geom in no space, by which ODE selects triangles of a mesh. Nothing else does.
void updateBounds(dGeomID geom);
/// Changes the dimensions of ODE's geom, so that it keeps its position in the space's list. Returns false when the geom
/// must be created again.
bool reshape(dGeomID geom, const engine::ShapeDescription& from, const engine::ShapeDescription& to);
/// The frame of ODE's geom in that of the shape.
Pose frameOf(const engine::ShapeDescription& shape, const SharedShape& shared);

}  // namespace spark::ode
