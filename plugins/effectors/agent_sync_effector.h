#pragma once

#include "api/agents.h"

namespace spark {

/// `(syn)`: the agent has said all it wants to say in this cycle. Game control sees the message; there is nothing to do
/// here.
class AgentSyncEffector : public Effector, public ISyncEffector {
  SPARK_CLASS(AgentSyncEffector, Effector)
 public:
  static void describe(Description<AgentSyncEffector>& d) {
    d.doc("Takes (syn), by which an agent says in lockstep that the cycle may go on. Arguments are ignored.");
    d.implements<ISyncEffector>();
  }
  std::string predicate() const override { return "syn"; }
  std::string act(const Element&) override { return {}; }
};

}  // namespace spark
