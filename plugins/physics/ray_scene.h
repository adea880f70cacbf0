#pragma once
/// \file
/// The geoms of a world at one moment, prepared for many rays: sensors cast thousands in a cycle.

#include <optional>
#include <vector>

#include "box_tree.h"
#include "queries.h"

namespace spark::physics {

/// Answers the same as castRay() of queries.h, faster for many rays. update() runs in one thread; after it several
/// threads may cast rays, until the model or the state changes. Nothing is allocated while the number of geoms stays.
class RayScene {
 public:
  /// Takes the geoms of `model` at their places in `state`. Both must outlive the queries. `poses`: a number that is
  /// another one whenever a body was moved. Returns at once if nothing has changed.
  void update(const engine::Model& model, const engine::State& state, std::uint64_t poses);
  /// True if nothing has changed since update().
  bool isCurrent(const engine::Model& model, std::uint64_t poses) const { return at_ == stamp(model, poses); }
  /// Forgets everything, as before the first update().
  void clear();

  /// As physics::castRay(). Of geoms at the same distance the last in the order of the model counts.
  std::optional<GeomHit> castRay(const Vec3& from, const Vec3& direction, double length, const Accepts& accepts) const;
  /// True if the ray meets a geom that `accepts` takes.
  bool meets(const Vec3& from, const Vec3& direction, double length, const Accepts& accepts) const;

 private:
  struct Stamp {
    const engine::Model* model = nullptr;
    std::uint64_t structure = 0, collision = 0, poses = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stamp(const engine::Model& model, std::uint64_t poses) {
    return {&model, model.structure, model.collision, poses};
  }
  struct Placed {
    const engine::Geom* geom;
    engine::Index index;
    int mesh;  ///< its tree in meshes_; -1: no mesh
    Vec3 position;
    Mat3 toShape;  ///< from the world frame
  };
  /// The triangles of a mesh.
  struct Mesh {
    std::uint64_t id = 0;        ///< of the geom
    std::uint64_t contents = 0;  ///< hash of vertices and triangles
    BoxTree triangles;
  };
  void collect(const engine::Model& model);
  void place(const engine::Model& model, const engine::State& state);
  bool cast(const Placed& placed, const Vec3& from, const Vec3& direction, double length, GeomHit& hit) const;
  /// Calls `visit(placed)` for the geoms that the ray may meet; see BoxTree::meet().
  template <class Visit>
  void visitAlong(const Vec3& from, const Vec3& direction, double length, Visit&& visit) const;

  Stamp at_;
  std::vector<Placed> placed_;  ///< those with bounds, then planes
  std::size_t bounded_ = 0;     ///< number of those with bounds
  std::vector<Box> boxes_;      ///< of those
  BoxTree tree_;
  std::vector<Mesh> meshes_;
};

}  // namespace spark::physics
