#pragma once

#include "api/agents.h"

namespace spark {

/// In the installed base: the answers of an emulated motor chip. This chip is not emulated here; the class is accepted
/// in scenes and has no percepts.
class HMDPPerceptor : public Perceptor {
  SPARK_CLASS(HMDPPerceptor, Perceptor)
 public:
  static void describe(Description<HMDPPerceptor>& d) {
    d.doc("Accepted in scenes; the motor chip is not emulated, so there are no percepts.");
  }
  void sense(Predicates&, const Event&) override {}
};

}  // namespace spark
