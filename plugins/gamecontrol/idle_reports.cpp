#include "gamecontrol/idle_reports.h"

#include <algorithm>

namespace spark::gamecontrol {

void IdleReports::report(Leaf& node, std::string_view why) {
  if (std::find(reported_.begin(), reported_.end(), node.id()) != reported_.end()) return;
  reported_.push_back(node.id());
  node.kernel().log().warning("{} ({}) {}.", node.path(), node.classObject()->name(), why);
}

void IdleReports::reportEffectors(Node& node) {
  std::vector<ControlAspect*> rules;
  node.collect(rules);
  for (ControlAspect* const rule : rules) {
    std::vector<Effector*> effectors;
    rule->collect(effectors);
    std::vector<Behavior*> minds;
    if (!effectors.empty()) rule->collect(minds);
    if (!effectors.empty() && minds.empty())
      report(*effectors.front(), "is never used: a rule's effectors need a Behavior below the rule, its mind");
  }
}

}  // namespace spark::gamecontrol
