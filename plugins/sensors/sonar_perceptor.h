#pragma once

#include "api/agents.h"

namespace spark {

/// Distances to players and goal posts in a cone. Accepted, with its settings; it senses nothing.
class SonarPerceptor : public Perceptor {
  SPARK_CLASS(SonarPerceptor, Perceptor)
 public:
  static void describe(Description<SonarPerceptor>& d) {
    using S = SonarPerceptor;
    d.doc("Accepted in scenes with its settings; it senses nothing.");
    d.property("maxEchoes", &S::maxEchoes_).min(0).doc("Number of distances.");
    d.property("senseCone", &S::senseConeDeg_).unit("deg").range(0, 360).doc("Full opening angle.");
    d.property("minRange", &S::minRange_).unit("m").min(0).doc("Nearest distance.");
    d.property("maxRange", &S::maxRange_).unit("m").min(0).doc("Farthest distance.");
    d.property("noise", &S::noise_).doc("Distances are noisy.");
    d.method("setRange", &S::setRange).parameters({"min [m]", "max [m]"}).doc("Nearest and farthest distance.");
    d.alias("addNoise", "setNoise");
  }
  void setRange(double min, double max) { minRange_ = min, maxRange_ = max; }
  void sense(Predicates&, const Event&) override {}

 private:
  int maxEchoes_ = 10;
  double senseConeDeg_ = 60, minRange_ = 0.25, maxRange_ = 5.0;
  bool noise_ = false;
};

}  // namespace spark
