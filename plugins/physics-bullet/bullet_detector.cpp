#include "bullet_detector.h"

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>

#include "api/contact_points.h"
#include "api/joined_bodies.h"
#include "convert.h"

namespace spark::bullet {

using engine::Geom;
using engine::Model;
using engine::Shape;
using engine::State;

/// What an algorithm reports for a pair of shapes, instead of a manifold of Bullet's.
class BulletDetector::Points : public btManifoldResult {
 public:
  Points(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, BulletDetector& to)
      : btManifoldResult(a, b), to_(to) {}
  void addContactPoint(const btVector3& normalOnB, const btVector3& pointOnB, btScalar distance) override {
    if (distance > 0) return;
    const Vec3 normal = toVec(normalOnB);
    to_.addPoint(toVec(pointOnB) + 0.5 * distance * normal, normal, -distance);
  }

 private:
  BulletDetector& to_;
};

BulletDetector::BulletDetector() : dispatcher_(&configuration_) {
  // Several points of a pair of smooth shapes: Bullet's manifolds would collect them over the steps.
  configuration_.setConvexConvexMultipointIterations(4, 4);
}

void BulletDetector::compile(const Model& model, const State& state, std::span<const Index>) {
  joined_.clear();
  engine::forEachJoined(model, [&](Index a, Index b) { joined_.emplace_back(std::min(a, b), std::max(a, b)); });
  std::sort(joined_.begin(), joined_.end());

  std::vector<std::unique_ptr<Solid>> old = std::exchange(solids_, {});
  solids_.resize(model.geoms.size());
  for (auto& solid : old)
    if (const Index at = engine::indexOf(model.geoms, solid->id); at != kNone) solids_[at] = std::move(solid);
  bounds_.resize(solids_.size());
  poses_.resize(solids_.size());
  for (Index i = 0; i < solids_.size(); ++i) {
    const Geom& g = model.geoms[i];
    if (!solids_[i] || !isMadeOf(*solids_[i], g)) solids_[i] = makeSolid(g, made_);
    place(model, state, i);
  }
}

void BulletDetector::place(const Model& model, const State& state, Index geom) {
  const Geom& g = model.geoms[geom];
  Pose& pose = poses_[geom];
  pose = g.offset;
  if (g.body != kNone) pose = compose({state.bodies[g.body].position, state.bodies[g.body].rotation}, g.offset);
  Bounds& b = bounds_[geom];
  b = {Vec3::Constant(-HUGE_VAL), Vec3::Constant(HUGE_VAL)};
  Solid& solid = *solids_[geom];
  if (!solid.shape) return;
  solid.object.setWorldTransform(toBullet(Pose{pose.position + pose.rotation * solid.origin, pose.rotation}));
  btVector3 low, high;
  solid.shape->getAabb(solid.object.getWorldTransform(), low, high);
  b = {toVec(low), toVec(high)};
}

bool BulletDetector::mayTouch(const Model& model, Index i, Index k) const {
  const Geom &a = model.geoms[i], &b = model.geoms[k];
  if (a.body == b.body) return false;
  if (a.space == b.space && a.space != kNone && !model.spaces[a.space].inner) return false;
  if (a.body == kNone || b.body == kNone) return true;
  return !std::binary_search(joined_.begin(), joined_.end(),
                             std::pair(std::min(a.body, b.body), std::max(a.body, b.body)));
}

/// Sweeps along x, over all geoms that may touch something.
void BulletDetector::findPairs(const Model& model, engine::PairFilter filter) {
  order_.clear();
  for (Index i = 0; i < solids_.size(); ++i) {
    const Geom& g = model.geoms[i];
    if (g.collides && (solids_[i]->shape || g.shape.shape == Shape::plane)) order_.emplace_back(bounds_[i].low.x(), i);
  }
  std::sort(order_.begin(), order_.end());
  pairs_.clear();
  for (std::size_t n = 0; n < order_.size(); ++n) {
    const Bounds& a = bounds_[order_[n].second];
    for (std::size_t m = n + 1; m < order_.size() && order_[m].first <= a.high.x(); ++m) {
      Index first = order_[n].second, second = order_[m].second;
      const Bounds& b = bounds_[second];
      if (a.low.y() > b.high.y() || b.low.y() > a.high.y() || a.low.z() > b.high.z() || b.low.z() > a.high.z())
        continue;
      if (!mayTouch(model, first, second)) continue;
      if (!engine::comesFirst(model.geoms[first], model.geoms[second])) std::swap(first, second);
      if (filter && !filter(model.geoms[first].owner, model.geoms[second].owner)) continue;
      pairs_.emplace_back(first, second);
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
}

void BulletDetector::addPoint(const Vec3& position, const Vec3& normal, double depth) {
  constexpr double kSame = 1e-6;  // m^2
  for (Found& f : found_) {
    if ((f.position - position).squaredNorm() > kSame) continue;
    if (depth > f.depth) f = {position, normal, depth};
    return;
  }
  found_.push_back({position, normal, depth});
}

void BulletDetector::touchPlane(const engine::ShapeDescription& shape, const Pose& pose,
                                const engine::ShapeDescription& plane) {
  const Vec3 direction(plane.plane[0], plane.plane[1], plane.plane[2]);
  const Vec3 normal = direction.normalized(), origin = direction * (plane.plane[3] / direction.squaredNorm());
  below_.clear();
  pointsBelowPlane(shape, pose, normal, origin, below_);
  for (const PlanePoint& p : below_) found_.push_back({p.position, normal, p.depth});
}

void BulletDetector::touch(const Model& model, Index a, Index b) {
  found_.clear();
  if (model.geoms[b].shape.shape == Shape::plane)
    return touchPlane(model.geoms[a].shape, poses_[a], model.geoms[b].shape);
  const auto wrap = [&](Index i) {
    const Solid& s = *solids_[i];
    return btCollisionObjectWrapper(nullptr, s.shape.get(), &s.object, s.object.getWorldTransform(), -1, -1);
  };
  const btCollisionObjectWrapper first = wrap(a), second = wrap(b);
  // A new algorithm has no memory of earlier steps.
  btCollisionAlgorithm* algorithm = dispatcher_.findAlgorithm(&first, &second, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  if (!algorithm) return;
  Points points(&first, &second, *this);
  algorithm->processCollision(&first, &second, btDispatcherInfo(), &points);
  algorithm->~btCollisionAlgorithm();
  dispatcher_.freeCollisionAlgorithm(algorithm);
}

void BulletDetector::thinOut(std::size_t most) {
  if (found_.size() <= most) return;
  engine::choosePoints(
      found_.size(), most, [this](std::size_t i) { return found_[i].position; },
      [this](std::size_t i) { return found_[i].depth; }, apart_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < apart_.size(); ++i)
    if (apart_[i] < 0) found_[kept++] = found_[i];
  found_.resize(kept);
}

void BulletDetector::detect(const Model& model, const State& state, engine::PairFilter filter, int perPair,
                            engine::Contacts& out) {
  for (Index i = 0; i < solids_.size(); ++i)
    if (model.geoms[i].body != kNone) place(model, state, i);
  findPairs(model, filter);
  for (const auto& [a, b] : pairs_) {
    touch(model, a, b);
    thinOut(static_cast<std::size_t>(std::max(perPair, 1)));
    const Geom &first = model.geoms[a], &second = model.geoms[b];
    for (const Found& f : found_) {
      engine::Contact& c = out.emplace_back();
      c.geomA = a, c.geomB = b;
      c.bodyA = first.body, c.bodyB = second.body;
      c.ownerA = first.owner, c.ownerB = second.owner;
      c.position = f.position, c.normal = f.normal, c.depth = f.depth;
    }
  }
}

}  // namespace spark::bullet
