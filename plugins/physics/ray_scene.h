#pragma once
/// \file
/// The geoms of a world at one moment, prepared for many rays and overlaps: sensors cast thousands of rays in a cycle.

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "box_tree.h"
#include "cone.h"
#include "queries.h"

namespace spark::physics {

/// Answers the same as castRay() and findOverlaps() of queries.h, to the last bit, faster where there are many geoms
/// and queries. update() runs in one thread at a time, while others may call isCurrent(); where that is true, several
/// threads may make queries, until the model or the state changes. Nothing is allocated while the number of geoms
/// stays.
class RayScene {
 public:
  /// Takes the geoms of `model` at their places in `state`. Both must outlive the queries. `poses`: a number that is
  /// another one whenever a body was moved. Returns at once if nothing has changed.
  void update(const engine::Model& model, const engine::State& state, std::uint64_t poses);
  /// True if nothing has changed since update().
  bool isCurrent(const engine::Model& model, std::uint64_t poses) const {
    const Stamp* at = at_.load(std::memory_order_acquire);
    return at && *at == stamp(model, poses);
  }
  /// Forgets everything but the trees of meshes, as before the first update().
  void clear();

  /// As physics::castRay(). Of geoms at the same distance the last in the order of the model counts.
  std::optional<GeomHit> castRay(const Vec3& from, const Vec3& direction, double length, const Accepts& accepts) const;
  /// True if the ray meets a geom that `accepts` takes.
  bool meets(const Vec3& from, const Vec3& direction, double length, const Accepts& accepts) const;

  /// As physics::findOverlaps().
  void findOverlaps(const Vec3& center, double radius, std::vector<engine::Index>& out) const;
  /// A geom, and the distance to its nearest point that is in a cone and not hidden [m].
  struct GeomEcho {
    engine::Index geom;
    double distance;
  };
  /// Appends the geoms that are heard in a cone of the world frame, in order; see IHearing::listen().
  void listen(const Cone& cone, int rings, const Accepts& accepts, std::vector<GeomEcho>& out) const;

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
    const BoxTree* triangles;  ///< of a mesh or a hull; else nullptr
    Vec3 position;
    Mat3 toShape;  ///< from the world frame
  };
  /// The triangles of a mesh; those of ended geoms end with the next collect().
  struct MeshTree {
    std::shared_ptr<const engine::Mesh> mesh;
    BoxTree triangles;
  };
  void collect(const engine::Model& model);
  void place(const engine::Model& model, const engine::State& state);
  std::optional<Vec3> nearestIn(const Cone& cone, const Placed& placed) const;
  std::optional<double> visibleFrom(const Cone& cone, const Placed& placed, const Vec3& nearest,
                                    const Accepts& accepts) const;
  bool cast(const Placed& placed, const Vec3& from, const Vec3& direction, double length, GeomHit& hit) const;
  /// Calls `visit(placed)` for the geoms that the ray may meet; see BoxTree::meet().
  template <class Visit>
  void visitAlong(const Vec3& from, const Vec3& direction, double length, Visit&& visit) const;

  /// The last update and the one before: while one thread updates, others may still compare with the older one.
  std::array<Stamp, 2> stamps_;
  std::atomic<const Stamp*> at_ = nullptr;  ///< of stamps_
  std::vector<Placed> placed_;              ///< those with bounds, then planes
  std::size_t bounded_ = 0;                 ///< number of those with bounds
  std::vector<Box> boxes_;                  ///< of those
  BoxTree tree_;
  engine::MadeOf<engine::Mesh, MeshTree> trees_;
  std::vector<std::shared_ptr<const MeshTree>> meshes_;  ///< those of placed_
};

}  // namespace spark::physics
