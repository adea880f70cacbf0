#pragma once
/// \file
/// The effector with which a rule's mind disqualifies agents: `(disqualify number words...)`.

#include <fmt/format.h>

#include "api/agents.h"

namespace spark {

/// `(disqualify 3 it pushed)`: removes agent 3 at the start of the next cycle, closes its connection and logs why. It
/// acts below a rule (ControlAspect) only; agents cannot ask for it.
class DisqualifyEffector : public Effector {
  SPARK_CLASS(DisqualifyEffector, Effector)
 public:
  static void describe(Description<DisqualifyEffector>& d) {
    d.doc("(disqualify <number> <words>...): removes an agent, closes its connection and logs why; for rules only.");
  }
  std::string predicate() const override { return "disqualify"; }
  std::string act(const Element& action) override {
    const AgentAspect* const rule = agent();
    if (!rule || !rule->as<ControlAspect>())
      return "expected a rule above this effector, found none: only rules disqualify";
    const Element which = action.at(1);
    const std::optional<double> number = which && !which.isList() ? which.asNumber() : std::nullopt;
    if (!number) return "expected (disqualify <number of the agent> <words>...), found no number";
    std::string why;
    for (auto it = ++ ++action.begin(); it != action.end(); ++it)
      if ((*it).isText()) why += (why.empty() ? "" : " ") + std::string((*it).text());
    auto* const control = find<IGameControl>(IGameControl::kPath);
    if (control)
      for (AgentAspect* const agent : control->agents())
        if (agent->number() == *number)
          return control->disqualify(*agent, why.empty() ? "by a rule" : why), std::string();
    return fmt::format("expected the number of an agent, found {}: there is none", *number);
  }
};

}  // namespace spark
