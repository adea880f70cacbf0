#pragma once
/// \file
/// One agent as game control sees it: where its actions come from, what is still to be realised, what it is to be sent.
///
/// The latency of the installed base, which recorded sessions depend on:
///
///     cycle k      connected: aspect made, counter 1
///     cycle k+1    first message realised: (scene ...) is stored in act, the robot built in prepare
///     cycle k+2    end of act: effectors and perceptors are looked up; sense: first percepts
///     cycle k+3    act: percepts sent, after this cycle's inputs were taken; what answers them acts in k+4
///
/// Effectors that a message addresses before they were looked up are "not registered": the action is lost with a
/// warning. Only `(syn)` counts at once: who sends it takes part in lockstep from then on.
///
/// A client is idle until its first message: the cycles until then are not counted, so that what comes in every third
/// cycle does not depend on how long it hesitated.

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"
#include "gamecontrol/agent_lines.h"
#include "gamecontrol/line_budget.h"
#include "spark/state.h"

namespace spark::gamecontrol {

/// What a sync predicate is called as long as no robot says otherwise.
inline constexpr std::string_view kSync = "syn";

class Participant {
 public:
  /// Behind a connection, which outlives it or is taken away by disconnect().
  explicit Participant(IConnection& connection);
  /// Driven from inside.
  explicit Participant(Behavior& behavior);

  /// "agent 3 (127.0.0.1:4711)".
  const std::string& label() const { return label_; }
  int number() const { return number_; }
  IConnection* connection() const { return connection_; }
  AgentAspect* aspect() const { return aspect_.get(); }
  Behavior* behavior() const { return behavior_.get(); }
  bool inside() const { return inside_; }
  /// From now on it is to be removed at the start of the next act.
  void leave() { leaving_ = true; }
  /// True when it has to go: told to, or what it lives from is gone.
  bool leaving() const { return leaving_ || (number_ > 0 && !aspect()) || (inside_ ? !behavior() : !connection_); }
  void disconnect() { connection_ = nullptr; }

  /// Gets its place in the tree and, when it lives inside, its first actions.
  void join(int number, AgentAspect& aspect);
  /// Looks its parser up again.
  void resolveParser(Node& gameControl);
  IParser* parser() const { return parser_.get(); }

  /// A message came: parsed at once, realised in the next act. Returns "" or why the connection has to be closed.
  std::string receive(std::string_view message, std::size_t maxPending, AgentLines& log, std::int64_t cycle);
  /// Looks effectors and perceptors up again if something changed below its aspect. True when it has a robot now and
  /// had none before.
  bool resolveRobot();
  /// The tree changed since the last look: perceptors that died are asked no more.
  void forgetTheDead();
  // A crowd does not fit the caches: while others have their turn, what this one will look at in its own is on its way
  // there. Each part leads to the next, so that the way has stages.
  static constexpr std::size_t kStages = 3;
  /// Before realise, when two others have theirs first.
  void approachActing() const;
  /// Before share, when two others have theirs first.
  void approachSharing() const;
  /// Before sense, when so many others have theirs first: kStages, then fewer. Runs on any thread.
  void approachSensing(std::size_t distance) const;

  /// Realises what is pending.
  void realise(AgentLines& log, std::int64_t cycle);
  /// What a behaviour thought of becomes pending.
  void promote();
  /// Before the sense phase, in the simulation's thread: lets what its perceptors look at with others be brought up to
  /// date.
  void share(std::uint64_t round);
  /// Counts the cycle, asks the perceptors that are due, encodes. Runs on any thread, changes only this agent. False
  /// when a perceptor threw or left lists open, which are closed.
  bool sense(const Event& event);
  /// After sense, on the simulation's thread: reports a perceptor that threw and asks it no more; reports one that left
  /// lists open, once.
  void reportFaults(AgentLines& log);
  /// Sends or hands over what was sensed last, at the instant `now`. False when the message was dropped because an
  /// earlier one has not left.
  bool deliver(AgentLines& log, std::int64_t cycle, Clock::time_point now);

  /// Lockstep: it can answer percepts with a sync predicate, was sent some, and has sent that predicate before.
  bool mustSync() const { return canSync() && pledged_; }
  /// As mustSync, but it never sent a sync predicate: it is told what every cycle brings and not waited for.
  bool watches() const { return canSync() && !pledged_; }
  bool synced() const { return synced_; }
  /// Lockstep waits for it without counting: it was expected, lives inside, or has answered often enough.
  bool trusted() const { return inside_ || expected_ || turnsAnswered_ >= kProbation; }
  /// The cycle that begins found its answer there, or did without.
  void countAnswer() { turnsAnswered_ += synced_; }
  /// It kept others waiting for too long: it is not waited for until it answers again, and trusted only when it has
  /// done so often.
  void distrust() { turnsAnswered_ = 0, pledged_ = false; }
  /// It was heard from, and its first percepts may be on their way.
  bool joining() const { return heardFrom_ && sent_ == 0 && counter_ <= kCyclesToFirstPercepts; }
  bool heardFrom() const { return heardFrom_; }
  bool hasRobot() const { return hadRobot_; }
  /// Messages with percepts that it was sent.
  std::int64_t sent() const { return sent_; }
  Clock::time_point joinedAt() const { return joinedAt_; }
  Clock::time_point lastHeard() const { return lastHeard_; }
  /// What it sensed last.
  const Predicates& percepts() const { return percepts_; }
  /// Wall time from percepts to the answer [s], smoothed; NaN when not known.
  double latency() const { return latency_; }
  /// What is under way inside the host: percepts that were not sent yet, what a behaviour wants to do next. Messages on
  /// the wire are not.
  void save(StateWriter& out) const;
  void load(StateReader& in);

  /// What was received and not realised yet.
  const Predicates& pending() const { return pending_; }
  /// The last message that could be read; before it joined, and valid until the next one comes.
  const Predicates& lastMessage() const { return arrived_; }
  /// What the hold has seen of a client.
  struct Held {
    bool saidAll = false;  ///< it waits for nothing but the clock
    bool greeted = false;  ///< it was sent a message since it was last heard
    int answers = 0;       ///< to such messages, with a sync predicate
  };
  Held& held() { return held_; }
  const Held& held() const { return held_; }
  /// Keeps all but the predicate `first` back until the first percepts were sent: what it sent during the hold then
  /// comes in time. `expected`: lockstep always waits for it.
  void holdBack(std::string_view first, bool expected);
  /// True for agents that were held until all expected ones were there.
  bool expected() const { return expected_; }
  /// One message outside of the cycle, to a client that waits for something before it goes on.
  void greet(const Predicates& percepts);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr std::int64_t kCyclesToFirstPercepts = 3;
  static constexpr int kProbation = 100;  // answers
  struct Slot {
    std::string predicate;
    Ref<Effector> effector;
    const void* node = nullptr;  ///< the effector's memory, not to be read
    std::size_t next =
        0;  ///< index of the one that was addressed after it last: agents say the same things in the same order
  };
  struct Shared {
    Ref<Perceptor> perceptor;
    ISharedView* view;
    const Perceptor* alive;  ///< as asked_
  };
  bool canSync() const { return !syncPredicate_.empty() && sent_ > 0; }
  bool isSync(std::string_view predicate) const;
  /// It asked for its robot, which is to come in one of the next cycles.
  bool loading() const;
  std::size_t resolveEffectors(AgentAspect& root);
  void act(Effector& effector, const Element& action, AgentLines& log, std::int64_t cycle);
  std::size_t fetchNext(std::size_t index) const;
  Slot* slot(std::string_view predicate, std::size_t& guess);
  /// What the counter is in the next sense phase.
  std::int64_t nextCount() const { return counter_ + (inside_ || heardFrom_ || counter_ == 0); }
  static bool isDue(const Perceptor& p, std::int64_t count) { return count % std::max(1, p.interval()) == 0; }
  void keep(const Predicates& arrived);
  void noteAnswer();
  void encode();
  void balance(std::size_t perceptor);
  void warn(AgentLines& log, std::int64_t cycle, std::string_view text);

  std::string label_;
  int number_ = 0;
  IConnection* connection_ = nullptr;
  Ref<Behavior> behavior_;
  Ref<AgentAspect> aspect_;
  Ref<IParser> parser_;
  const bool inside_;
  bool leaving_ = false, skipCycle_ = true, heardFrom_ = false, hadRobot_ = false, expected_ = false,
       holdingBack_ = false;
  Held held_;
  int turnsAnswered_ = 0;
  bool pledged_ = false, synced_ = false;  ///< sent a sync predicate: ever, since the last cycle
  Clock::time_point joinedAt_ = Clock::now(), lastHeard_ = joinedAt_;
  Clock::time_point askedAt_{};  ///< when the first percepts were sent that it has not answered; zero: there are none
  double latency_ = std::numeric_limits<double>::quiet_NaN();

  Predicates pending_, arrived_, percepts_;
  Predicates later_;  ///< held back, or thought of and not due yet
  std::size_t pendingBytes_ = 0;
  std::string message_, first_;
  std::vector<Slot> effectors_;  ///< by predicate
  std::size_t firstSlot_ = 0;    ///< the one that was addressed first last
  std::vector<Ref<Perceptor>> perceptors_;
  std::vector<Perceptor*> asked_;  ///< perceptors_, as long as the tree stays: a reference costs a cache line each
  std::vector<Shared> shared_;
  std::size_t faulty_ = kNone;  ///< index of a perceptor that threw
  std::string fault_;
  std::size_t unbalanced_ = kNone;     ///< index of a perceptor whose lists had to be closed, and
  int open_ = 0;                       ///< what Predicates::balance() said of them
  std::vector<std::uint64_t> blamed_;  ///< ids of those that were reported so
  std::string syncPredicate_;
  std::uint64_t robotAt_ = 0;  ///< its aspect's changedAt() at the last look
  std::int64_t counter_ = 0, sent_ = 0;
  LineBudget budget_{10};
};

}  // namespace spark::gamecontrol
