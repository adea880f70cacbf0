#pragma once

#include "api/agents.h"

namespace spark {

/// In the installed base: commands to an emulated motor chip. This chip is not emulated here; commands are accepted and
/// have no effect.
class HMDPEffector : public Effector {
  SPARK_CLASS(HMDPEffector, Effector)
 public:
  static void describe(Description<HMDPEffector>& d) {
    d.doc("Accepted in scenes; the motor chip is not emulated, so (HMDP text) has no effect.");
  }
  std::string predicate() const override { return "HMDP"; }
  std::string act(const Element&) override { return "the motor chip is not emulated: commands have no effect"; }
};

}  // namespace spark
