#include "monitor_server.h"

#include <algorithm>

#include "api/command_check.h"
#include "log_player.h"
#include "monitor_log.h"
#include "script_item.h"
#include "spark/error.h"
#include "spark/plugin.h"
#include "spark/read_message.h"

namespace spark {

namespace {
constexpr std::uint32_t kMaxQueuedTokens = 1u << 15;  // of commands; messages beyond that are dropped
constexpr std::int64_t kLogInterval = 250;            // cycles between two log lines about dropped messages
constexpr std::size_t kMaxQuote = 40;                 // bytes of a command that a message repeats
}  // namespace

void MonitorServer::describe(Description<MonitorServer>& d) {
  using M = MonitorServer;
  d.doc("Sends frames of the scene to monitors and takes trainer commands. Children: an encoder, items, trainers.");
  d.link(&M::encoder_, Child<IMonitorEncoder>());
  d.link(&M::source_, Child<IFrameSource>());
  d.link(&M::scene_, At<ISceneServer>());
  d.link(&M::takers_, Child<IFrameTaker>());
  d.link(&M::items_, Child<IMonitorItem>());
  d.link(&M::trainers_, Child<ITrainer>());
  d.property("interval", &M::interval_)
      .unit("cycles")
      .min(1)
      .doc("A frame is made in every n-th cycle; commands are executed in the cycles after these.");
  d.property("precision", &M::precision_)
      .min(0)
      .doc("A matrix is sent again if one of its elements changed by more (metres; for rotations without unit).");
  d.property("clients", &M::clientCount).doc("Number of connected monitors.");
  d.method("command", &M::commandOrThrow)
      .parameters({"text"})
      .doc("Trainer commands as S-expressions; executed in the next cycle that takes commands.");
  d.method("requestFullState", &M::requestFullState).doc("Makes the next message to every client a full one.");
  d.implements<IMonitorServer>();
  d.implements<IConnectionConsumer>();
  d.on<&M::act>(phase::kAct);
  d.on<&M::publish>(phase::kPublish);
}

void MonitorServer::requestFullState() {
  for (auto& client : clients_) client->view.requestFull();
}

// ---- connections (between cycles) ----

void MonitorServer::connected(IConnection& connection) {
  // A frame refers to nodes: those of a log may be gone.
  if (newest_.frame.shape == 0 || source_ || !nodes_.fresh(kernel())) makeFrame(last_);
  clients_.push_back(std::make_unique<MonitorClient>(connection, newest_));
  sendTo({clients_.back().get()});
}

void MonitorServer::received(IConnection& connection, std::string_view message) {
  auto* parser = connection.port().childOf<IParser>();
  queueCommands(parser ? parser : childOf<IParser>(), connection.peer(), message);
}

std::string MonitorServer::command(std::string_view from, std::string_view message) {
  return queueCommands(nullptr, from, message);
}

std::string MonitorServer::queueCommands(IParser* parser, std::string_view from, std::string_view message) {
  updateKnownCommands();
  if (commands_.size() >= kMaxQueuedTokens) return dropMessage(from);
  const std::uint32_t before = commands_.size();
  const ReadResult result = parser ? parser->parse(message, commands_) : readMessage(message, commands_);
  if (commands_.size() > kMaxQueuedTokens) {
    commands_.truncate(before);
    return dropMessage(from);
  }
  std::string mistakes;
  const auto add = [&](std::string_view name, const std::string& why) {
    logOnce(from, name, why);
    mistakes += fmt::format("{}{}", mistakes.empty() ? "" : "; ", why);
  };
  if (!result.message.empty())
    add("", fmt::format("{}:{}: {}; the other commands count", result.line, result.column, result.message));
  else if (commands_.size() == before)
    add("", "expected commands in parentheses, found none");
  addMistakes(before, add);
  return mistakes;
}

/// The protocol has no replies, and monitors could not parse one: the log and callers inside the host get the mistakes.
/// A flood of mistakes must not cost more than the commands themselves.
template <typename Add>
void MonitorServer::addMistakes(std::uint32_t first, Add add) {
  constexpr int kMost = 8;
  int found = 0;
  for (const Element command : commands_) {
    if (command.index() < first) continue;
    const std::string why = mistakeOf(command);
    if (why.empty()) continue;
    if (++found > kMost) return add("", "there are more mistakes");
    mistaken_.push_back(command.index());
    add(command.isList() ? command.head() : std::string_view(), why);
  }
}

std::string MonitorServer::mistakeOf(const Element& command) const {
  if (!command.isList())
    return fmt::format("expected a command in parentheses, found '{}'", command.text().substr(0, kMaxQuote));
  const std::string_view name = command.head();
  if (name.empty()) return "expected a command, found parentheses without a name";
  if ((name == "reqfullstate" || name == "killsim") && command.size() > 1)
    return fmt::format("{}: expected no arguments, found {}: they are ignored", name, command.size() - 1);
  if (!knownCommands_.empty() && std::find(knownCommands_.begin(), knownCommands_.end(), name) == knownCommands_.end())
    return fmt::format("there is no command '{}' here.{}", name.substr(0, kMaxQuote),
                       didYouMean(name.substr(0, kMaxQuote), knownCommands_));
  for (const Found<ITrainer>& trainer : trainers_) {
    const auto check = trainer.leaf->as<ICommandCheck>();
    const std::string why = check ? check->check(command) : std::string();
    if (!why.empty()) return fmt::format("{}: {}", name.substr(0, kMaxQuote), why);
  }
  return {};
}

void MonitorServer::logOnce(std::string_view from, std::string_view name, std::string_view why) {
  const std::uint64_t kind = Mistakes::kindOf(name.substr(0, kMaxQuote), why);
  if (logged_.known(kind) || logged_.full()) return;
  logged_.add(kind);
  kernel().log().info("{}: from {}: {}{}", path(), from, why,
                      logged_.full() ? ". No more mistakes in commands are logged." : "");
}

void MonitorServer::commandOrThrow(const std::string& text) {
  if (const std::string why = command("the host's owner", text); !why.empty()) throw Error(why);
}

std::string MonitorServer::dropMessage(std::string_view from) {
  ++dropped_;
  if (!droppedLoggedAt_ || last_.cycle - *droppedLoggedAt_ >= kLogInterval) {
    droppedLoggedAt_ = last_.cycle;
    kernel().log().warning("{}: {} sends more commands than can wait for the next cycle; {} messages were dropped",
                           path(), from, dropped_);
    dropped_ = 0;
  }
  return "more commands wait than the next cycle can take: it was dropped";
}

void MonitorServer::disconnected(IConnection& connection) {
  std::erase_if(clients_, [&](const auto& client) { return &client->connection() == &connection; });
}

// ---- commands ----

void MonitorServer::act(const Event& event) {
  if (due(event)) versionAtAct_ = version();
  if (!takesCommands(event)) return;
  for (const Element command : commands_) execute(command);
  commands_.clear();
  mistaken_.clear();
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
    for (const Found<ITrainer>& trainer : trainers_)
      if (trainer->command(command, why)) {
        if (!why.empty()) ignored(command, why);
        return;
      }
  ignored(command, "no trainer knows it");
}

/// What was found wrong when the command came is logged already.
void MonitorServer::ignored(const Element& command, std::string_view why) {
  if (std::binary_search(mistaken_.begin(), mistaken_.end(), command.index())) return;
  const std::string_view name = command.isList() ? command.head() : command.text();
  logOnce("a trainer", name, fmt::format("command '{}' ignored: {}", name.substr(0, kMaxQuote), why));
}

// ---- frames ----

void MonitorServer::updateKnownCommands() {
  if (!tree_.changed(*this)) return;
  knownCommands_ = {"init", "getAck", "reqfullstate", "killsim"};
  for (const Found<ITrainer>& trainer : trainers_) {
    if (!trainer.leaf->classObject()->property("commands")) return knownCommands_.clear();
    const Value names = getProperty(*trainer.leaf, "commands");
    for (const Value& name : names.toList()) knownCommands_.push_back(name.toString());
  }
}

MonitorServer::Version MonitorServer::version() const {
  return {kernel().structureVersion(), scene_ ? scene_->modifiedCount() : 0};
}

void MonitorServer::makeFrame(const Event& event) {
  MonitorFrame& frame = newest_.frame;
  frame.cycle = event.cycle;
  ++newest_.serial;
  frame.env.predicates.clear();
  frame.env.entries.clear();
  if (source_)
    changed_ = source_->fill(frame, newest_.ids, event, !clients_.empty());
  else
    fillFromScene();
  if (changed_ || frame.shape == 0) ++frame.shape;
  // Monitors need at least one entry per message: add the time unless an item adds such an entry.
  const auto& entries = frame.env.entries;
  const auto isAlways = [](const Environment::Entry& e) { return e.policy == EnvPolicy::always; };
  if (std::none_of(entries.begin(), entries.end(), isAlways)) frame.env.put(EnvPolicy::always, "time", event.time);

  // Hash the entries, and distribute the events.
  newest_.precision = static_cast<float>(precision_);
  newest_.keys.clear();
  for (const auto& entry : entries) {
    newest_.keys.push_back(entry.policy == EnvPolicy::change ? keyOf(frame.env.predicates, entry.token) : EntryKey{});
    if (entry.policy != EnvPolicy::once) continue;
    const Element once(frame.env.predicates, entry.token);
    for (auto& client : clients_) client->view.addEvent(once);
    for (const Found<IFrameTaker>& taker : takers_) taker->event(once);
  }
}

void MonitorServer::fillFromScene() {
  changed_ = nodes_.refresh(kernel());
  nodes_.copyTo(newest_.frame.nodes);
  newest_.ids = nodes_.ids();
  for (const Found<IMonitorItem>& item : items_) item->contribute(newest_.frame.env);
}

void MonitorServer::publish(const Event& event) {
  last_ = {{}, event.time, event.step, event.cycle, nullptr};
  if (!due(event)) return;
  makeFrame(event);
  for (const Found<IFrameTaker>& taker : takers_) taker->take(newest_, encoder_.get(), event);
  skipped_ = changed_ && !source_ && !skipped_ && version() != versionAtAct_;
  if (skipped_) return;
  ready_.clear();
  for (auto& client : clients_)
    if (client->connection().idle()) ready_.push_back(client.get());
  sendTo(ready_);
}

IMonitorEncoder* MonitorServer::encoderFor(const MonitorClient& client) const {
  auto* own = client.connection().port().childOf<IMonitorEncoder>();
  return own ? own : encoder_.get();
}

void MonitorServer::sendTo(const std::vector<MonitorClient*>& clients) {
  encoders_.clear();
  for (const MonitorClient* client : clients) encoders_.push_back(encoderFor(*client));
  if (std::find(encoders_.begin(), encoders_.end(), nullptr) != encoders_.end()) {
    if (!noEncoderLogged_)
      kernel().log().error(
          "{}: expected an encoder below it, found none; monitors get nothing. Add one, e.g. new(\"SexpMonitor\", "
          "\"{}/encoder\").",
          path(), path());
    noEncoderLogged_ = true;
    return;
  }

  // Group equivalent clients; encode one of each group.
  leaders_.clear();
  encoding_.clear();
  for (std::size_t i = 0; i < clients.size(); ++i) {
    const auto same = [&](std::size_t k) {
      return encoders_[k] == encoders_[i] && clients[k]->view.isEquivalent(clients[i]->view);
    };
    const auto leader = std::find_if(encoding_.begin(), encoding_.end(), same);
    leaders_.push_back(leader == encoding_.end() ? i : *leader);
    if (leaders_.back() == i) encoding_.push_back(i);
  }
  const auto encode = [this, &clients](std::size_t k) { clients[encoding_[k]]->encode(*encoders_[encoding_[k]]); };
  if (encoding_.size() > 1)
    kernel().jobs().run(encoding_.size(), encode);
  else if (!encoding_.empty())
    encode(0);
  for (std::size_t i = 0; i < clients.size(); ++i)
    if (leaders_[i] != i) clients[i]->view.copyState(clients[leaders_[i]]->view);
  for (std::size_t i = 0; i < clients.size(); ++i) clients[i]->send(clients[leaders_[i]]->message());
}

}  // namespace spark

SPARK_PLUGIN("monitor", "1.0",
             "The monitor server: frames of the scene for monitors, commands from trainers; logs and their player.",
             spark::MonitorServer, spark::MonitorLog, spark::LogPlayer, spark::ScriptItem)
