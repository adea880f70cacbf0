#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(syn)`: the agent has finished its cycle. Game control reads the message itself, so act() has nothing to do.
class AgentSyncEffector : public Effector, public ISyncEffector {
  SPARK_CLASS(AgentSyncEffector, Effector)
 public:
  static void describe(Description<AgentSyncEffector>& d) {
    d.doc("Accepts (syn), with which an agent ends its cycle in lockstep.");
    d.implements<ISyncEffector>();
  }
  std::string predicate() const override { return "syn"; }
  std::string act(const Element& action) override { return expectNoArguments(action); }
};

}  // namespace spark
