#include "monitor_server.h"

#include <algorithm>

#include "spark/plugin.h"

namespace spark {

namespace {
/// Commands that may wait for the next due cycle, in tokens; messages beyond are dropped.
constexpr std::uint32_t kMostWaiting = 1u << 15;
/// Cycles between two lines about dropped messages.
constexpr std::int64_t kComplainEvery = 250;
}  // namespace

void MonitorServer::describe(Description<MonitorServer>& d) {
  using M = MonitorServer;
  d.doc("Sends frames of the scene to monitors and takes trainer commands. Children: an encoder, items, trainers.");
  d.property("interval", &M::interval_).unit("cycles").min(1).doc("A frame is made, and commands are executed, in every n-th cycle.");
  d.property("stallTimeout", &M::stallTimeout_).unit("s").min(0).doc("A client that takes nothing for so long (wall time) is closed.");
  d.property("precision", &M::precision_).min(0).doc("A matrix is sent again when one of its elements changed by more (metres, or unit vectors).");
  d.property("clients", &M::clientCount).doc("Number of connected monitors.");
  d.method("requestFullState", &M::requestFullState).doc("The next message to every client is full.");
  d.implements<IMonitorServer>();
  d.implements<IConnectionConsumer>();
  d.on<&M::act>(phase::kAct);
  d.on<&M::publish>(phase::kPublish);
}

void MonitorServer::requestFullState() {
  for (auto& client : clients_) client->requestFull();
}

// ---- connections (the simulation's thread, between cycles) ----

void MonitorServer::connected(IConnection& connection) {
  lookUpHelpers();
  if (!nodes_.fresh(kernel()) || frame_.shape == 0) makeFrame();
  clients_.push_back(std::make_unique<MonitorClient>(connection, frame_));
  sendTo({clients_.back().get()});
}

void MonitorServer::received(IConnection& connection, std::string_view message) {
  if (commands_.size() >= kMostWaiting) return dropMessage(connection);
  const std::uint32_t before = commands_.size();
  auto* parser = connection.port().childOf<IParser>();
  if (!parser) parser = childOf<IParser>();
  const ReadResult result = parser ? parser->parse(message, commands_) : readSexp(message, commands_);
  if (!result.message.empty())
    kernel().log().debug("{}: from {}: {}:{}: {}; what came before it counts", path(), connection.peer(), result.line, result.column, result.message);
  if (commands_.size() <= kMostWaiting) return;
  commands_.truncate(before);
  dropMessage(connection);
}

void MonitorServer::dropMessage(IConnection& connection) {
  ++dropped_;
  if (toldDroppedAt_ && cycle_ - *toldDroppedAt_ < kComplainEvery) return;
  toldDroppedAt_ = cycle_;
  kernel().log().warning("{}: {} sends more commands than can wait for the next cycle; {} messages were dropped", path(), connection.peer(), dropped_);
  dropped_ = 0;
}

void MonitorServer::disconnected(IConnection& connection) {
  std::erase_if(clients_, [&](const auto& client) { return &client->connection() == &connection; });
}

// ---- commands ----

void MonitorServer::act(const Event& event) {
  if (!due(event) || commands_.empty()) return;
  lookUpHelpers();
  for (const Element command : commands_) execute(command);
  commands_.clear();
}

void MonitorServer::execute(const Element& command) {
  const std::string_view name = command.head();
  if (name == "init" || name == "getAck") return;
  if (name == "reqfullstate") return requestFullState();
  if (name == "killsim") {
    kernel().log().info("{}: a monitor asked to end the simulation", path());
    return kernel().requestStop();
  }
  std::string why;
  if (!name.empty())
    for (ITrainer* trainer : trainers_)
      if (trainer->command(command, why)) {
        if (!why.empty()) kernel().log().debug("{}: command '{}' ignored: {}", path(), name, why);
        return;
      }
  if (command.isList())
    kernel().log().debug("{}: unknown command '{}' ignored", path(), name);
  else
    kernel().log().debug("{}: expected a command in parentheses, found '{}'; ignored", path(), command.text());
}

// ---- frames ----

void MonitorServer::lookUpHelpers() {
  if (helpersAt_ == kernel().structureVersion()) return;
  items_.clear();
  trainers_.clear();
  encoder_ = childOf<IMonitorEncoder>();
  for (const auto& child : children()) {
    if (auto* item = child->as<IMonitorItem>()) items_.push_back(item);
    if (auto* trainer = child->as<ITrainer>()) trainers_.push_back(trainer);
  }
  helpersAt_ = kernel().structureVersion();
}

void MonitorServer::makeFrame() {
  if (nodes_.refresh(kernel()) || frame_.shape == 0) ++frame_.shape;
  frame_.cycle = cycle_;
  nodes_.copyTo(frame_.nodes);

  // The environment: every message needs at least one entry, so without an item that says the time it is said here.
  Environment& env = frame_.env;
  env.predicates.clear();
  env.entries.clear();
  for (IMonitorItem* item : items_) item->contribute(env);
  const auto isAlways = [](const Environment::Entry& e) { return e.policy == EnvPolicy::always; };
  if (std::none_of(env.entries.begin(), env.entries.end(), isAlways)) env.put(EnvPolicy::always, "time", time_);

  keys_.clear();
  for (const auto& entry : env.entries) {
    keys_.push_back(entry.policy == EnvPolicy::change ? keyOf(env.predicates, entry.token) : EntryKey{});
    if (entry.policy == EnvPolicy::once)
      for (auto& client : clients_) client->addEvent(Element(env.predicates, entry.token));
  }
}

void MonitorServer::publish(const Event& event) {
  time_ = event.time;
  cycle_ = event.cycle;
  if (!due(event)) return;
  lookUpHelpers();
  makeFrame();
  ready_.clear();
  for (auto& client : clients_) {
    if (client->connection().stalledSeconds() > stallTimeout_)
      client->close(fmt::format("the monitor took nothing for {} s", stallTimeout_));
    else if (!client->closing() && client->connection().idle())
      ready_.push_back(client.get());
  }
  sendTo(ready_);
}

IMonitorEncoder* MonitorServer::encoderFor(const MonitorClient& client) const {
  auto* own = client.connection().port().childOf<IMonitorEncoder>();
  return own ? own : encoder_;
}

void MonitorServer::sendTo(const std::vector<MonitorClient*>& clients) {
  encoders_.clear();
  for (const MonitorClient* client : clients) encoders_.push_back(encoderFor(*client));
  if (std::find(encoders_.begin(), encoders_.end(), nullptr) != encoders_.end()) {
    if (!toldNoEncoder_)
      kernel().log().error("{}: expected an encoder below it, found none; monitors get nothing. Add one, e.g. new(\"SexpMonitor\", \"{}/encoder\").", path(), path());
    toldNoEncoder_ = true;
    return;
  }
  const auto encode = [this, &clients](std::size_t i) {
    clients[i]->encode(*encoders_[i], nodes_.ids(), keys_, static_cast<float>(precision_));
  };
  if (clients.size() > 1)
    kernel().jobs().run(clients.size(), encode);
  else if (!clients.empty())
    encode(0);
  for (MonitorClient* client : clients) client->send();
}

}  // namespace spark

SPARK_PLUGIN("monitor", "1.0", "The monitor server: frames of the scene for monitors, commands from trainers.", spark::MonitorServer)
