#pragma once
/// \file
/// Contacts by Bullet's algorithms for pairs of shapes. Nothing is kept from step to step, so contacts depend on the
/// poses alone.

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "api/engine.h"
#include "shapes.h"

namespace spark::bullet {

using engine::Index;
using engine::kNone;

class BulletDetector : public engine::IDetector {
 public:
  BulletDetector();
  void compile(const engine::Model& model, const engine::State& state, std::span<const Index> edited) override;
  void detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int perPair,
              engine::Contacts& out) override;

 private:
  struct Bounds {
    Vec3 low, high;
  };
  struct Found {
    Vec3 position, normal;
    double depth;
  };
  class Points;
  void place(const engine::Model& model, const engine::State& state, Index geom);
  void findPairs(const engine::Model& model, engine::PairFilter filter);
  bool mayTouch(const engine::Model& model, Index a, Index b) const;
  /// Fills found_: a is the first.
  void touch(const engine::Model& model, Index a, Index b);
  void touchPlane(const engine::ShapeDescription& shape, const Pose& pose, const engine::ShapeDescription& plane);
  /// Appends a point, unless it is where another one is.
  void addPoint(const Vec3& position, const Vec3& normal, double depth);
  /// Keeps the `most` points that matter.
  void thinOut(std::size_t most);

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  MadeShapes made_;
  std::vector<std::unique_ptr<Solid>> solids_;   ///< by geom
  std::vector<Bounds> bounds_;                   ///< by geom
  std::vector<Pose> poses_;                      ///< by geom
  std::vector<std::pair<double, Index>> order_;  ///< lower bound along x, geom
  std::vector<std::pair<Index, Index>> pairs_;   ///< of the present poses; the first geom first
  std::vector<std::pair<Index, Index>> joined_;  ///< pairs of bodies that joints connect, sorted
  std::vector<Found> found_;
  std::vector<PlanePoint> below_;
  std::vector<double> apart_;
};

}  // namespace spark::bullet
