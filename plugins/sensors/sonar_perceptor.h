#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/match.h"
#include "spark/random.h"

namespace spark {

/// `(US Left (0.87 2.31 5.00 ...))`: horizontal distances [m] to echo targets (IEchoTarget: other robots, posts) in a
/// cone about the y axis of its transform, nearest first. Missing echoes are reported as `maxRange`. Heights are
/// ignored: the cone is a sector of the ground plane.
class SonarPerceptor : public Perceptor {
  SPARK_CLASS(SonarPerceptor, Perceptor)
 public:
  static void describe(Description<SonarPerceptor>& d) {
    using S = SonarPerceptor;
    d.doc("Senses distances to other robots and posts in a cone in front of it: (US name (d1 d2 ...)) in m.");
    d.property("maxEchoes", &S::maxEchoes_).range(0, 100).doc("Number of reported distances.");
    d.property("senseCone", &S::senseConeDeg_).unit("deg").range(0, 360).doc("Full horizontal opening angle.");
    d.property("minRange", &S::minRange_).unit("m").min(0).doc("Smallest distance; nearer targets are reported at it.");
    d.property("maxRange", &S::maxRange_).unit("m").min(0).doc("Largest distance; farther targets are not detected.");
    d.property("noise", &S::noise_).doc("Adds Gaussian noise to the distances.");
    d.property("random", &S::random_).state().doc("State of the noise's random numbers.");
    d.method("setRange", &S::setRange).parameters({"min [m]", "max [m]"}).doc("Sets minRange and maxRange.");
    d.alias("addNoise", "setNoise");
  }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    listen();
    out.open("US").add(messageName()).open();
    const std::size_t count = maxEchoes_;
    for (std::size_t i = 0; i < count; ++i) out.add(i < echoes_.size() ? echoes_[i] : maxRange_);
    out.close().close();
  }

 private:
  static constexpr double kSigma = 0.005;  // standard deviation of the noise [m]

  void setRange(double min, double max) { minRange_ = min, maxRange_ = max; }

  /// Fills echoes_ with at most maxEchoes_ distances, nearest first.
  void listen() {
    const Matrix& here = transform()->world();
    const Vec3f forward = here.block<3, 1>(0, 1);
    echoes_.clear();
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

    // The nearest ones, with noise.
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
  double senseConeDeg_ = 60, minRange_ = 0.25, maxRange_ = 5.0;
  bool noise_ = false;
  RandomStream random_{*this, "sonar"};
  TreeWatch tree_;
  std::vector<const Transform*> targets_;
  std::vector<double> echoes_;
};

}  // namespace spark
