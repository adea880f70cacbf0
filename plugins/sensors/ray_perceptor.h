#pragma once

#include <algorithm>
#include <optional>

#include "api/agents.h"
#include "api/measurement.h"
#include "api/physics.h"

namespace spark {

/// Base of sensors that measure distances with rays. Rays start at the sensor's transform and look along its y axis, as
/// heads do. They meet everything that collides, except what moves of the sensor's own agent, and its static colliders
/// that contain the sensor.
class RayPerceptor : public Perceptor, public ISharedView, public IMeasurement {
  SPARK_CLASS(RayPerceptor, Perceptor)
 public:
  static void describe(Description<RayPerceptor>& d) {
    using R = RayPerceptor;
    d.doc("Measures distances with rays.");
    d.abstract();
    d.implements<ISharedView>();
    d.implements<IMeasurement>();
    d.link(&R::physics_, At<IPhysicsServer>());
    d.property("minRange", &R::minRange_)
        .unit("m")
        .min(0)
        .doc("Smallest distance; nearer surfaces are reported at it.");
    d.property("maxRange", &R::maxRange_)
        .unit("m")
        .min(0)
        .doc("Largest distance, which is reported, too, where there is no surface.");
    d.method("setRange", &R::setRange).parameters({"min [m]", "max [m]"}).doc("Sets minRange and maxRange.");
  }
  Measured measured() const override { return {Measured::Kind::numbers, minRange_, maxRange_, maxRange_}; }
  void share(std::uint64_t) override {
    if (IPhysicsServer* const physics = casts() ? physics_.get() : nullptr) physics->prepareRays();
  }

 protected:
  /// False for sensors that measure without rays.
  virtual bool casts() const { return true; }
  /// Starts a measurement at the present pose of the transform. False if there is nothing to measure.
  bool beginMeasuring() {
    if (tree_.changed(*this)) {
      auto* const aspect = ancestor<AgentAspect>();
      agent_ = aspect ? &aspect->object() : nullptr;
    }
    ready_ = physics_ && physics_->hasWorld() && transform();
    if (ready_) pose_ = toPose(transform()->world());
    return ready_;
  }
  /// The pose of the measurement, world frame.
  const Pose& pose() const { return pose_; }
  /// The object of its agent, of which it does not sense what moves; nullptr: none.
  const Node* agent() const { return agent_; }
  /// The first surface in a direction of the sensor's frame (any length above 0), within maxRange.
  std::optional<RayHit> cast(const Vec3& direction) const {
    if (!ready_) return std::nullopt;
    return physics_->castRay(pose_.position, pose_.rotation * direction, maxRange_, agent_);
  }
  /// The distance to report [m].
  double distance(const std::optional<RayHit>& hit) const {
    return hit ? std::max(minRange_, hit->distance) : maxRange_;
  }

  double minRange_ = 0, maxRange_ = 10;

 private:
  void setRange(double min, double max) {
    if (!(min >= 0 && max >= min))
      throw RefusedValue(fmt::format("expected 0 <= min <= max [m], found {:g} and {:g}", min, max));
    minRange_ = min, maxRange_ = max;
  }

  Link<IPhysicsServer> physics_;
  TreeWatch tree_;
  const Node* agent_ = nullptr;
  bool ready_ = false;  ///< there is something to measure
  Pose pose_;
};

}  // namespace spark
