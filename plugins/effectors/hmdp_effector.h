#pragma once

#include "api/agents.h"

namespace spark {

/// Commands to the emulated motor chip of the installed base. No chip is emulated: they are accepted and have no
/// effect.
class HMDPEffector : public Effector {
  SPARK_CLASS(HMDPEffector, Effector)
 public:
  static void describe(Description<HMDPEffector>& d) {
    d.doc("Accepted in scenes; no motor chip is emulated, so (HMDP text) has no effect.");
  }
  std::string predicate() const override { return "HMDP"; }
  std::string act(const Element&) override { return {}; }
};

}  // namespace spark
