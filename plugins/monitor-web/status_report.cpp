#include "status_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "api/phases.h"
#include "stream/messages.h"

namespace spark::web {

namespace {
void writeTimes(JsonWriter& json, const AgentTimes& times) {
  const auto steps = [&json](const char* name, double value) {
    json.key(name);
    std::isfinite(value) ? json.fixed(value, 2) : json.null();
  };
  json.key("thinking").beginObject();
  steps("last", times.last);
  steps("mean", times.mean);
  steps("senseLatency", times.senseLatency);
  steps("actLatency", times.actLatency);
  json.member("dropped", times.dropped).endObject();
}
}  // namespace

std::string StatusReport::make(int spectators) {
  const auto* clock = kernel_.root().find<ISimulation>();
  const double time = clock ? clock->time() : 0;
  const auto now = std::chrono::steady_clock::now();
  const double elapsed = std::chrono::duration<double>(now - std::exchange(lastCallAt_, now)).count();
  const double factor = elapsed > 0 ? (time - std::exchange(lastTime_, time)) / elapsed : 0;
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "status").key("realTimeFactor").fixed(factor, 3);
  json.member("cycle", clock ? clock->cycle() : 0).key("time").fixed(time, 2).member("spectators", spectators);
  writeGame(json);
  updateAgents();
  writeAgents(json);
  json.endObject();
  return out;
}

/// Well-known entries become members of their own; the others go into the list "status".
void StatusReport::writeGame(JsonWriter& json) {
  List others;
  for (StatusEntry& entry : reporters_.read(kernel_)) {
    if (isStatusWord(entry))
      json.member(entry.name, entry.value);
    else
      others.push_back(List{std::move(entry.name), std::move(entry.value)});
  }
  if (!others.empty()) json.member("status", Value(std::move(others)));
}

void StatusReport::updateAgents() {
  if (!tree_.changed(kernel_.root())) return;
  agents_.clear();
  if (const auto* control = kernel_.root().find<IGameControl>())
    for (const AgentAspect* agent : control->agents())
      agents_.push_back({agent, agent->path(), Below<IAgentIdentity>().find(*agent).object});
}

void StatusReport::writeAgents(JsonWriter& json) const {
  const auto* control = kernel_.root().find<IGameControl>();
  json.key("agents").beginArray();
  for (const Agent& agent : agents_) {
    const double latency = control->latency(*agent.aspect);
    json.beginObject().member("path", agent.path).member("team", agent.identity ? agent.identity->team() : "");
    json.member("number", agent.identity ? agent.identity->number() : 0).key("latency");
    std::isfinite(latency) ? json.fixed(latency * 1000, 2) : json.null();
    IConnection* const connection = control->connection(*agent.aspect);
    const auto* const port = connection ? connection->port().as<IAgentTimes>().object : nullptr;
    if (const auto times = port ? port->times(*connection) : std::nullopt) writeTimes(json, *times);
    json.endObject();
  }
  json.endArray();
}

}  // namespace spark::web
