#pragma once

#include "api/agents.h"

namespace spark {

/// Answers of the emulated motor chip of the installed base. No chip is emulated: it is accepted and stays silent.
class HMDPPerceptor : public Perceptor {
  SPARK_CLASS(HMDPPerceptor, Perceptor)
 public:
  static void describe(Description<HMDPPerceptor>& d) {
    d.doc("Accepted in scenes; no motor chip is emulated, so it never has anything to say.");
  }
  void sense(Predicates&, const Event&) override {}
};

}  // namespace spark
