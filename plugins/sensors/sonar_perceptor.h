#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/match.h"
#include "api/sound_cone.h"
#include "ray_perceptor.h"
#include "spark/random.h"

namespace spark {

/// `(US Left (0.87 2.31 5.00 ...))`: distances [m] to what is in a cone about the y axis of its transform, nearest
/// first. Missing echoes are reported as `maxRange`.
///
/// As in the installed base, it hears the echo targets (IEchoTarget: other robots, posts) and ignores heights: the cone
/// is a sector of the ground plane, and nothing hides a target. With `byRays` it hears each collider of which a part is
/// in the cone and not hidden, once, however thin it is; one that it touches or is in at `minRange`.
class SonarPerceptor : public RayPerceptor {
  SPARK_CLASS(SonarPerceptor, RayPerceptor)
 public:
  SonarPerceptor() { minRange_ = 0.25, maxRange_ = 5.0; }
  static void describe(Description<SonarPerceptor>& d) {
    using S = SonarPerceptor;
    d.doc("Senses distances to what is in a cone in front of it: (US name (d1 d2 ...)) in m.");
    d.property("byRays", &S::byRays_)
        .doc("Hears every collider in the cone; false: as in the installed base, other robots and posts, unhidden.");
    d.property("rings", &S::rings_)
        .range(0, 50)
        .doc(
            "For byRays: rings of rays that look for what is hidden where it is nearest; ring k has 6 k rays, around "
            "one in the middle of the cone.");
    d.property("maxEchoes", &S::maxEchoes_).range(0, 100).doc("Number of reported distances.");
    d.property("senseCone", &S::senseConeDeg_).unit("deg").range(0, 360).doc("Full opening angle of the cone.");
    d.property("noise", &S::noise_).doc("Adds Gaussian noise to the distances.");
    d.property("random", &S::random_).state().doc("State of the noise's random numbers.");
    d.alias("addNoise", "setNoise");
    d.link(&S::hearing_, At<IHearing>(IPhysicsServer::kPath));
  }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    echoes_.clear();
    byRays_ ? castCone() : listen();
    selectNearest();
    out.open("US").add(messageName()).open();
    const std::size_t count = maxEchoes_;
    for (std::size_t i = 0; i < count; ++i) out.add(i < echoes_.size() ? echoes_[i] : maxRange_);
    out.close().close();
  }

 private:
  static constexpr double kSigma = 0.005;  // standard deviation of the noise [m]

  bool casts() const override { return byRays_; }

  /// Adds the distances to what is heard in the cone.
  void castCone() {
    heard_.clear();
    if (beginMeasuring() && hearing_)
      hearing_->listen({pose().position, pose().rotation.col(1), degToRad(senseConeDeg_ / 2), maxRange_}, rings_,
                       agent(), heard_);
    for (const Echo& echo : heard_) echoes_.push_back(echo.distance);
  }

  /// Adds the distances to echo targets.
  void listen() {
    const Matrix& here = transform()->world();
    const Vec3f forward = here.block<3, 1>(0, 1);
    if (tree_.changed(*this)) findTargets();

    // Targets within range and cone, measured in the ground plane.
    for (const Transform* target : targets_) {
      const Vec3f to = positionOf(target->world()) - positionOf(here);
      const double distance = std::hypot(to.x(), to.y());
      const double cross = forward.x() * to.y() - forward.y() * to.x(),
                   along = forward.x() * to.x() + forward.y() * to.y();
      if (distance <= maxRange_ && std::abs(radToDeg(std::atan2(cross, along))) <= senseConeDeg_ / 2)
        echoes_.push_back(distance);
    }
  }

  /// Keeps the maxEchoes_ nearest distances, in order, and adds the noise.
  void selectNearest() {
    std::sort(echoes_.begin(), echoes_.end());
    if (const std::size_t count = maxEchoes_; echoes_.size() > count) echoes_.resize(count);
    for (double& echo : echoes_)
      echo = std::max(minRange_, std::min(maxRange_, noise_ ? echo + random_.normal(0, kSigma) : echo));
  }

  /// Collects the transforms of all echo targets of the scene except those of its own agent.
  void findTargets() {
    targets_.clear();
    const Leaf* self = nullptr;
    Node* top = parent();
    for (; top->parent() && top->as<SceneNode>(); top = top->parent())
      if (top->as<AgentAspect>()) self = top;
    collect(*top, self);
  }
  /// Collects those below `node`, except below `self`.
  void collect(const Node& node, const Leaf* self) {
    for (const auto& child : node.children()) {
      if (child.get() == self || !child->asNode()) continue;
      const auto mark = child->as<SceneNode>();
      if (mark && mark->transform() && child->as<IEchoTarget>()) targets_.push_back(mark->transform());
      collect(*child->asNode(), self);
    }
  }

  int maxEchoes_ = 10;
  double senseConeDeg_ = 60;
  bool noise_ = false, byRays_ = false;
  int rings_ = 3;
  RandomStream random_{*this, "sonar"};
  TreeWatch tree_;
  std::vector<const Transform*> targets_;
  std::vector<double> echoes_;
  std::vector<Echo> heard_;  ///< of these echoes, by rays
  Link<IHearing> hearing_;
};

}  // namespace spark
