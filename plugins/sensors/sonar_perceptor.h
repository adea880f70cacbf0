#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/match.h"
#include "spark/random.h"

namespace spark {

/// `(US Left (0.87 2.31 5.00 ...))`: distances over the ground to echo targets (other robots, posts: IEchoTarget) in a
/// cone about its transform's y axis, the nearest first; what is missing is told as the greatest distance. A sonar
/// looks level: heights do not count.
class SonarPerceptor : public Perceptor {
  SPARK_CLASS(SonarPerceptor, Perceptor)
 public:
  static void describe(Description<SonarPerceptor>& d) {
    using S = SonarPerceptor;
    d.doc("Senses distances to other robots and posts in a cone before it: (US name (d1 d2 ...)) in m.");
    d.property("maxEchoes", &S::maxEchoes_).range(0, 100).doc("Number of distances.");
    d.property("senseCone", &S::senseConeDeg_).unit("deg").range(0, 360).doc("Full opening angle, over the ground.");
    d.property("minRange", &S::minRange_).unit("m").min(0).doc("Nearest distance; what is nearer is told as this.");
    d.property("maxRange", &S::maxRange_).unit("m").min(0).doc("Farthest distance; what is farther is not heard.");
    d.property("noise", &S::noise_).doc("Distances are noisy.");
    d.property("random", &S::random_).state().doc("The noise's numbers.");
    d.method("setRange", &S::setRange).parameters({"min [m]", "max [m]"}).doc("Nearest and farthest distance.");
    d.alias("addNoise", "setNoise");
  }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    listen();
    out.open("US").add(name()).open();
    for (int i = 0; i < maxEchoes_; ++i) out.add(static_cast<std::size_t>(i) < echoes_.size() ? echoes_[i] : maxRange_);
    out.close().close();
  }

 private:
  static constexpr double kSigma = 0.005;  // m

  void setRange(double min, double max) { minRange_ = min, maxRange_ = max; }

  /// Fills echoes_, nearest first, as many as there are but no more than it tells.
  void listen() {
    const Matrix& here = transform()->world();
    const Vec3f forward = here.block<3, 1>(0, 1);
    echoes_.clear();
    if (tree_.changed(*this)) findTargets();
    for (const Transform* target : targets_) {
      const Vec3f to = positionOf(target->world()) - positionOf(here);
      const double distance = std::hypot(to.x(), to.y());
      const double cross = forward.x() * to.y() - forward.y() * to.x(),
                   along = forward.x() * to.x() + forward.y() * to.y();
      if (distance <= maxRange_ && std::abs(radToDeg(std::atan2(cross, along))) <= senseConeDeg_ / 2)
        echoes_.push_back(distance);
    }
    std::sort(echoes_.begin(), echoes_.end());
    if (echoes_.size() > static_cast<std::size_t>(maxEchoes_)) echoes_.resize(static_cast<std::size_t>(maxEchoes_));
    for (double& echo : echoes_)
      echo = std::max(minRange_, std::min(maxRange_, noise_ ? echo + random_.normal(0, kSigma) : echo));
  }

  /// The transforms of all echo targets of the scene but those of its own agent.
  void findTargets() {
    targets_.clear();
    const Leaf* self = nullptr;
    Node* top = parent();
    for (; top->parent() && top->as<SceneNode>(); top = top->parent())
      if (top->as<AgentAspect>()) self = top;
    collect(*top, self);
  }
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
