#include "gamecontrol/participant.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gamecontrol/request_effector.h"
#include "gamecontrol/scene_effector.h"
#include "spark/error.h"
#include "spark/running.h"

namespace spark::gamecontrol {

namespace {
constexpr std::size_t kMaxLineLength = 300;  // of a log line, which may contain text from a client
}  // namespace

Participant::Participant(IConnection& connection, Clock::time_point now)
    : label_(fmt::format("agent at {}", connection.peer())),
      connection_(&connection),
      inside_(false),
      joinedAt_(now),
      lastHeard_(now) {}

Participant::Participant(Behavior& behavior, Clock::time_point now)
    : label_(fmt::format("agent of {}", behavior.path())),
      behavior_(&behavior),
      inside_(true),
      joinedAt_(now),
      lastHeard_(now) {}

Participant::Participant(int number, AgentAspect& aspect, Behavior* behavior)
    : label_(behavior ? fmt::format("agent {} ({})", number, behavior->path()) : fmt::format("agent {}", number)),
      number_(number),
      behavior_(behavior),
      aspect_(&aspect),
      inside_(behavior != nullptr),
      vacant_(!behavior),
      isRule_(aspect.as<ControlAspect>()) {
  if (!isRule_) aspect.setNumber(number);
}

void Participant::connect(IConnection& connection, Clock::time_point now) {
  connection_ = &connection;
  vacant_ = encoded_ = false;
  label_ = fmt::format("agent {} ({})", number_, connection.peer());
  joinedAt_ = lastHeard_ = now;
}

void Participant::takeOver(Participant& client, Clock::time_point now) {
  connect(*client.connection_, now);
  heardFrom_ = true;
  parser_ = client.parser_;
  lockstep_.resume(client.lockstep_);
  client.connection_ = nullptr;
  client.actions_.dropPending();
  client.leave();
}

void Participant::join(int number, AgentAspect& aspect, Given given, Clock::time_point now) {
  given_ = given;
  number_ = number;
  aspect_ = &aspect;
  isRule_ = static_cast<bool>(aspect.as<ControlAspect>());
  joinedAt_ = now;
  label_ = isRule_ ? fmt::format("rule {}", aspect.path())
                   : fmt::format("agent {} ({})", number, inside_ ? behavior()->path() : connection_->peer());
  if (inside_) behavior()->start(actions_.pending());
}

bool Participant::warn(AgentLog& log, std::int64_t cycle, std::uint64_t kind, std::string_view text) {
  if (mistakes_.known(kind) || mistakes_.full()) return true;
  if (!lines_.take(cycle)) return false;
  if (const auto n = lines_.takeDropped())
    log.write(Level::warning, fmt::format("{}: {} further lines were dropped.", label_, n));
  if (!log.write(Level::warning, fmt::format("{}: {}{}", label_, text.substr(0, kMaxLineLength),
                                             text.size() > kMaxLineLength ? " ..." : "")))
    return false;
  mistakes_.add(kind);
  if (mistakes_.full())
    log.write(Level::warning, fmt::format("{}: these were mistakes of {} kinds; no more of its mistakes are logged.",
                                          label_, Mistakes::kMax));
  return true;
}

bool Participant::remark(AgentLog& log, std::int64_t cycle, std::string_view predicate, std::string_view why) {
  const std::uint64_t kind = Mistakes::kindOf(predicate, why);
  return mistakes_.known(kind) || warn(log, cycle, kind, fmt::format("{}: {}", predicate, why));
}

void Participant::warnUnknown(AgentLog& log, std::int64_t cycle, std::string_view predicate) {
  constexpr std::size_t kMaxGuess = 40;  // bytes of a predicate for which a similar one is suggested
  const bool needsRobot = !hasRobot_ && !given_.isObject();
  const std::uint64_t kind = Mistakes::kindOf(predicate, needsRobot ? "no robot" : "unknown");
  if (mistakes_.known(kind)) return;
  const std::string hint = needsRobot
                               ? " It has no robot yet: expected (scene <file>), and the rest after its percepts."
                           : predicate.size() <= kMaxGuess ? didYouMean(predicate, effectors_.predicates())
                                                           : std::string();
  warn(log, cycle, kind,
       fmt::format("no effector registered for predicate {}{}.{}", predicate.substr(0, kMaxLineLength / 2),
                   predicate.size() > kMaxLineLength / 2 ? " ..." : "", hint));
}

// ---- actions ----

void Participant::resolveParser(Node& gameControl) {
  if (inside_ || !connection_) return;
  const Route<IParser> child = Child<IParser>();
  const Found<IParser> own = child.find(connection_->port());
  parser_ = own ? own : child.find(gameControl);
}

std::string Participant::receive(std::string_view message, std::size_t maxPending, AgentLog& log, std::int64_t cycle,
                                 Clock::time_point now) {
  heardFrom_ = true;
  lastHeard_ = now;
  claimed_ = false;
  unanswered_ = 0;
  latency_.onMessage(lastHeard_);
  if (!actions_.reserve(message.size(), maxPending))
    return fmt::format("it sent more than {} bytes within one cycle, or more than {} words are under way", maxPending,
                       ActionQueue::kMaxTokens);
  if (!parser_) return "there is no parser below its port or below game control";

  Predicates& actions = actions_.beginMessage();
  const ReadResult result = parser_->parse(message, actions);
  if (!result.message.empty())
    warn(log, cycle,
         fmt::format("{} at {}:{}; that predicate is ignored.", result.message, result.line, result.column));
  bool sync = false;
  for (const Element e : actions) {
    if (!e.isList())
      warn(log, cycle, fmt::format("expected (predicate arguments...), found '{}' outside of brackets.", e.text()));
    else
      sync |= isSync(e.head());
  }
  lockstep_.onMessage(sync);
  actions_.endMessage(number_ == 0);
  return {};
}

bool Participant::isSync(std::string_view predicate) const {
  return predicate == (hasRobot_ ? std::string_view(effectors_.syncPredicate()) : kSync) && !predicate.empty();
}

void Participant::depart(std::int64_t cycle, const AgentLatencies& latencies) {
  latencies_ = latencies;
  lockstep_.beginTurn();
  if (actions_.skips() || waitsForRobot()) return;
  actions_.depart(cycle + latencies.act);
  if (!perceived_) requiredUntil_ = cycle + latencies.act;
}

void Participant::execute(AgentLog& log, const Event& event, const JudgeList& judges) {
  const std::int64_t cycle = event.cycle;
  lockstep_.beginCycle();
  // In the cycle in which an agent connects, only its aspect is created.
  if (actions_.takeSkip() || waitsForRobot()) return;

  EffectorTable::Lookup lookup(effectors_);
  NowRunning now("act");
  for (TransitQueue& arriving = actions_.underWay(); arriving.hasArrived(cycle); arriving.pop())
    for (const Element action : arriving.first()) {
      if (!action.isList()) continue;
      if (leaving_ || rejected()) break;  // a judge disqualified it
      const std::string_view head = action.head();
      if (head.empty()) {
        warn(log, cycle, "expected (predicate arguments...), found a list that does not begin with a word.");
        continue;
      }
      const auto [effector, modified] = lookup.find(head);
      if (modified && effector) {
        modified->actions.append(action);
      } else if (effector) {
        now.at(effector);
        executeAction(*effector, action, log, cycle, judges);
      } else if (hasRobot_ || head != kSync) {
        warnUnknown(log, cycle, head);
      }
    }
  executeModified(log, event, judges);
}

/// Effectors with modifiers act after all others. Also without an action: an earlier one may be due now.
void Participant::executeModified(AgentLog& log, const Event& event, const JudgeList& judges) {
  for (const auto& m : effectors_.modified()) {
    NowRunning now("act");
    if (const Effector* effector = m->effector.get()) try {
        m->modifiers->apply({Signal::Kind::action, m->actions, 0}, event, now);
      } catch (const std::exception& fault) {
        effector->kernel().countFault();
        warn(log, event.cycle,
             fmt::format("{} ({}): {}", effector->path(), effector->classObject()->name(), fault.what()));
        m->actions.clear();
      }
    for (const Element action : m->actions) {
      Effector* const effector = m->effector.get();
      if (!effector || leaving_ || rejected()) break;
      now.at(effector);
      executeAction(*effector, action, log, event.cycle, judges);
    }
    m->actions.clear();
  }
}

void Participant::executeAction(Effector& effector, const Element& action, AgentLog& log, std::int64_t cycle,
                                const JudgeList& judges) {
  try {
    if (AgentAspect* const agent = isRule_ || judges.empty() ? nullptr : aspect()) {
      const Ref<Effector> judged(&effector);  // a judge may be a script that removes it
      if (const std::string why = judges.judgeAction(*agent, effector, action); !why.empty()) {
        if (const auto asks = judged && judged->isLinked() ? judged->as<RequestEffector>() : nullptr)
          asks->answerRefused(action, why);
        return void(remark(log, cycle, action.head(), fmt::format("refused: {}.", why)));
      }
    }
    if (const std::string why = effector.act(action); !why.empty()) remark(log, cycle, action.head(), why);
  } catch (const std::exception& fault) {
    effector.kernel().countFault();
    warn(log, cycle, fmt::format("{} ({}) threw: {}", effector.path(), effector.classObject()->name(), fault.what()));
  } catch (...) {
    effector.kernel().countFault();
    warn(log, cycle,
         fmt::format("{} ({}) threw something that is no std::exception", effector.path(),
                     effector.classObject()->name()));
  }
}

// ---- percepts ----

bool Participant::resolveRobot() {
  AgentAspect* root = aspect();
  const std::uint64_t changedAt = root ? root->changedAt() : 0;
  if (std::exchange(robotAt_, changedAt) == changedAt) return false;
  if (!root) {
    effectors_.clear();
    perceptors_.clear();
    return false;
  }
  const std::size_t effectors = effectors_.rebuild(*root), perceptors = perceptors_.rebuild(*root);
  const bool first = !hasRobot_ && (perceptors > given_.perceptors || effectors > given_.effectors);
  hasRobot_ |= first;
  blind_ = perceptors <= given_.perceptors && (hasRobot_ || gamecontrol::hasRobot(*root));
  return first && !isRule_;
}

bool Participant::sense(const Event& event) {
  if (!turn_) return true;
  cycles_ = nextCycle();
  const bool fine = perceptors_.sense(percepts_.add(event.cycle + latencies_.sense), event, cycles_);
  encode();
  return fine;
}

void Participant::encode() {
  if (std::exchange(encoded_, true)) return;
  message_.clear();
  if (!percepts_.first().empty() && connection_ && parser_) parser_->write(percepts_.first(), message_);
}

int Participant::deliver(AgentLog& log, std::int64_t cycle, Clock::time_point now, IInputTape* tape) {
  if (!percepts_.hasArrived(cycle)) return 0;
  int dropped = 0;
  const std::int64_t before = sent_;
  for (; percepts_.hasArrived(cycle); percepts_.pop(), encoded_ = false)
    if (!deliverFirst(log, cycle, now, tape)) ++dropped;
  lockstep_.ask(static_cast<int>(sent_ - before), dropped);
  return dropped;
}

/// False if the message was dropped.
bool Participant::deliverFirst(AgentLog& log, std::int64_t cycle, Clock::time_point now, IInputTape* tape) {
  if (leaving() || vacant_) return true;
  if (percepts_.first().empty() && !(inside_ ? blind_ : sendsEmpty_)) return true;
  perceived_ = true;
  if (inside_) {
    think(log, cycle);
    if (rejected()) leave();
    return true;
  }
  encode();
  unanswered_ = std::min(unanswered_ + 1, kHanging);
  bool sent = connection_->send(message_);
  if (tape) sent = tape->decide("sent", static_cast<std::uint64_t>(number_), sent, true);
  if (!sent) return false;
  ++sent_;
  latency_.onPercepts(now);
  // The actions that were held back answer the first percepts.
  if (sent_ == 1 && actions_.holdingBack()) actions_.releaseHeldBack();
  if (rejected()) {
    connection_->close(fmt::format("it does not take part: {}", rejection_));
    leave();
  }
  return true;
}

void Participant::think(AgentLog& log, std::int64_t cycle) {
  const NowRunning now("think", behavior());
  Predicates& actions = actions_.pending();
  try {
    behavior()->think(percepts_.first(), actions);
  } catch (const std::exception& fault) {
    if (behavior()) behavior()->kernel().countFault();  // it may have removed itself
    warn(log, cycle, fmt::format("it threw: {}", fault.what()));
  }
  if (actions.isUnbalanced() && actions.balance() != 0)
    warn(log, cycle, "its actions did not close each list that they opened, once.");
}

// ---- succession ----

bool Participant::claim(bool again) {
  if (again && !claimed_) return false;
  claimed_ = true;
  return true;
}

/// Messages alone do not tell: without lockstep, and as fast as possible, many are sent before a client can answer one.
bool Participant::hangs(Clock::time_point now) const {
  return unanswered_ >= kHanging && std::chrono::duration<double>(now - lastHeard_).count() > kHangingFor;
}

// ---- hold and state ----

void Participant::holdBack(std::string_view first, bool expected) {
  lockstep_.setExpected(expected);
  actions_.holdBack(first);
}

void Participant::greet(const Predicates& percepts) {
  if (!connection_ || !parser_) return;
  message_.clear();
  parser_->write(percepts, message_);
  connection_->send(message_);
  message_.clear();
}

void Participant::save(StateWriter& out) const {
  if (out.keeps()) {
    StateWriter own(true);
    const AgentAspect* const robot = aspect();
    own.write(robot ? robot->path() : "");
    own.write(inside_);
    own.write(inside_ && behavior() ? behavior()->path() : "");
    // Without a connection it had none in this run: keys of an earlier one mean nothing, unless its port starts it
    // again.
    const Seat seat = connection_ ? Seat::of(*connection_) : returns() ? seat_ : Seat{};
    own.write(seat.port);
    own.write(seat.key);
    own.write(connection_ != nullptr);
    own.write(heardFrom_);
    own.write(hasRobot_);
    own.write(robot && robotAt_ == robot->changedAt());
    own.write(given_.effectors);
    own.write(given_.perceptors);
    own.write(sent_);
    own.write(claimed_);
    own.write(perceived_);
    own.write(requiredUntil_);
    own.write(rejection_);
    own.write(static_cast<std::int64_t>(arrival_));
    lockstep_.save(own);
    if (!inside_) actions_.save(own);
    actions_.saveHold(own);
    own.write(actions_.underWay().size());
    own.write(percepts_.size());
    own.write(percepts_.size() > 0 ? percepts_.lastDue() : 0);
    out.aside(own.bytes());
  }
  out.write(cycles_);
  // What was sensed last is saved whether it is under way or not.
  savePredicates(percepts(), out);
  if (inside_) actions_.save(out);
  percepts_.save(out, percepts_.size() > 0 ? percepts_.size() - 1 : 0);
  actions_.underWay().save(out, actions_.underWay().size());
}

std::unique_ptr<Participant> Participant::load(StateReader& in, int number, Node& root) {
  const std::string bytes = in.readString();
  StateReader own(bytes);
  auto& robot = root.require<AgentAspect>(own.readString());
  const bool inside = own.readBool();
  const std::string behavior = own.readString();
  auto out = std::make_unique<Participant>(number, robot, inside ? &root.require<Behavior>(behavior) : nullptr);
  out->seat_.port = own.readString();
  out->seat_.key = static_cast<std::uint64_t>(own.readInteger());
  if (const Node* const port = out->seat_.port.empty() ? nullptr : root.find<Node>(out->seat_.port))
    out->returns_ = static_cast<bool>(port->as<IReturningAgents>());
  out->wasConnected_ = own.readBool();
  out->heardFrom_ = own.readBool();
  out->hasRobot_ = own.readBool();
  const bool resolved = own.readBool();
  out->given_.effectors = static_cast<std::size_t>(own.readInteger());
  out->given_.perceptors = static_cast<std::size_t>(own.readInteger());
  out->sent_ = own.readInteger();
  out->claimed_ = own.readBool();
  out->perceived_ = own.readBool();
  out->requiredUntil_ = own.readInteger();
  out->rejection_ = own.readString();
  out->arrival_ = static_cast<std::uint64_t>(own.readInteger());
  out->lockstep_.load(own);
  if (!inside) out->actions_.load(own);
  out->actions_.loadHold(own);
  const auto acts = static_cast<std::size_t>(own.readInteger());
  const auto percepts = static_cast<std::size_t>(own.readInteger());
  const std::int64_t lastDue = own.readInteger();
  out->cycles_ = in.readInteger();
  Predicates last;
  loadPredicates(in, last);
  if (inside) out->actions_.load(in);
  out->percepts_.load(in, percepts > 0 ? percepts - 1 : 0);
  std::swap(out->percepts_.add(lastDue), last);
  if (percepts == 0) out->percepts_.pop();
  out->actions_.underWay().load(in, acts);
  // A robot that was built in the last cycle is looked up in the next one.
  if (resolved || out->hasRobot_) out->resolveRobot();
  return out;
}

}  // namespace spark::gamecontrol
