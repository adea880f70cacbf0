#include "status_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "api/phases.h"
#include "messages.h"

namespace spark::web {

namespace {
/// A property's value, nil when there is no such node or property.
Value valueOf(const Leaf* leaf, std::string_view property) {
  return leaf && leaf->classObject()->property(property) ? getProperty(*leaf, property) : Value();
}

/// The node AgentState below an agent: robots of the installed base have it in a nested aspect.
const Leaf* stateBelow(const Node& node) {
  for (const auto& child : node.children()) {
    if (child->name() == "AgentState") return child.get();
    if (!child->asNode()) continue;
    if (const Leaf* found = stateBelow(*child->asNode())) return found;
  }
  return nullptr;
}
}  // namespace

std::string StatusReport::make(int spectators) {
  const auto* clock = kernel_.root().find<ISimulation>("/sys/server/simulation");
  const double time = clock ? clock->time() : 0;
  const auto now = std::chrono::steady_clock::now();
  const double passed = std::chrono::duration<double>(now - std::exchange(madeAt_, now)).count();
  const double factor = passed > 0 ? (time - std::exchange(time_, time)) / passed : 0;
  std::string out =
      fmt::format("{{\"type\":\"status\",\"realTimeFactor\":{:.3f},\"cycle\":{},\"time\":{:.2f},\"spectators\":{}",
                  factor, clock ? clock->cycle() : 0, time, spectators);
  putMatch(out);
  lookUpAgents();
  putAgents(out);
  return out += '}';
}

void StatusReport::putMatch(std::string& out) const {
  const Leaf* match = kernel_.root().find("/sys/server/gamecontrol/GameStateAspect");
  const Value mode = valueOf(match, "playMode"), score = valueOf(match, "score");
  if (mode.isString()) out += ",\"playMode\":", putQuoted(out, mode.toString());
  if (score.isList() && score.toList().size() == 2)
    out += fmt::format(",\"score\":[{},{}]", score.toList()[0].plain(), score.toList()[1].plain());
}

void StatusReport::lookUpAgents() {
  if (std::exchange(lookedUpAt_, kernel_.structureVersion()) == kernel_.structureVersion()) return;
  agents_.clear();
  if (const auto* control = kernel_.root().find<IGameControl>("/sys/server/gamecontrol"))
    for (const AgentAspect* agent : control->agents()) agents_.push_back({agent, agent->path(), stateBelow(*agent)});
}

void StatusReport::putAgents(std::string& out) const {
  const auto* control = kernel_.root().find<IGameControl>("/sys/server/gamecontrol");
  out += ",\"agents\":[";
  for (const Agent& agent : agents_) {
    const Value team = valueOf(agent.state, "team"), number = valueOf(agent.state, "unum");
    const double latency = control->latency(*agent.aspect);
    if (out.back() != '[') out += ',';
    out += "{\"path\":", putQuoted(out, agent.path);
    out += ",\"team\":", putQuoted(out, team.isString() ? team.toString() : "");
    out += fmt::format(",\"number\":{},\"latency\":", number.isNumber() ? number.plain() : "0");
    out += std::isfinite(latency) ? fmt::format("{:.2f}}}", latency * 1000) : "null}";
  }
  out += ']';
}

}  // namespace spark::web
