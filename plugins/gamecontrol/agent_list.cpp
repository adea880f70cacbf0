#include "gamecontrol/agent_list.h"

#include <fmt/format.h>

#include <string>

#include "spark/error.h"

namespace spark::gamecontrol {

const std::vector<AgentAspect*>& AgentList::all(const Node& control) const {
  if (!tree_.changed(control)) return agents_;
  agents_.clear();
  for (const auto& p : participants_)
    if (AgentAspect* a = p->aspect(); a && a->isLinked() && !p->isRule()) agents_.push_back(a);
  return agents_;
}

List AgentList::paths(const Node& control) const {
  List out;
  for (const AgentAspect* const agent : all(control)) out.emplace_back(agent->path());
  return out;
}

AgentAspect& AgentList::at(const Value& agent, const Node& control) const {
  const std::string which = agent.plain();
  const Leaf* const named = agent.isString() ? control.kernel().root().find<Leaf>(which) : nullptr;
  const auto isNumber = [&](int number) {
    return agent.isNumber() ? agent.toNumber() == number : std::to_string(number) == which;
  };
  std::string known;
  for (AgentAspect* const a : all(control)) {
    if (named == a || isNumber(a->number())) return *a;
    known += fmt::format("{}{} {}", known.empty() ? "" : ", ", a->number(), a->path());
  }
  throw Error(fmt::format("expected the number or the path of an agent, found '{}'; {}", which,
                          known.empty() ? "there is none" : "there are " + known));
}

Participant* AgentList::of(const AgentAspect& aspect) const {
  for (const auto& p : participants_)
    if (p->aspect() == &aspect) return p.get();
  return nullptr;
}

}  // namespace spark::gamecontrol
