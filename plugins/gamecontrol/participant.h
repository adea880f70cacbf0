#pragma once
/// \file
/// One agent: where its actions come from, its effectors and perceptors, and what is sent to it.
///
///     message ─► parser ─► ActionQueue ── act phase ───► EffectorTable ──► effectors
///     message ◄─ parser ◄─ TransitQueue ◄─ sense phase ─ PerceptorTable ◄─ perceptors
///
/// Where a perceptor or an effector has modifiers, they are applied in between.
///
/// Where nothing else is set, its latencies are those of SimSpark, which recorded matches depend on:
///
///     cycle k      connected: its aspect is created, its cycle count is 1
///     cycle k+1    the first message is executed: (scene ...) is stored in act, the robot is built in prepare
///     cycle k+2    end of act: effectors and perceptors are looked up; sense: first percepts
///     cycle k+3    act: the percepts are sent, after this cycle's input was read; the answer is executed in k+4
///
/// Actions for effectors that are not looked up yet are lost with a warning. Only `(syn)` counts at once: from then on
/// the agent takes part in lockstep.
///
/// The cycles before a client's first message are not counted, so that percepts that come in every third cycle do not
/// depend on the time between its connection and that message.

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "api/agents.h"
#include "api/inputs.h"
#include "api/mistakes.h"
#include "gamecontrol/action_queue.h"
#include "gamecontrol/agent_log.h"
#include "gamecontrol/effector_table.h"
#include "gamecontrol/judge_list.h"
#include "gamecontrol/latency_meter.h"
#include "gamecontrol/line_budget.h"
#include "gamecontrol/lockstep_record.h"
#include "gamecontrol/perceptor_table.h"
#include "gamecontrol/transit_queue.h"
#include "spark/state.h"

namespace spark::gamecontrol {

/// The sync predicate of agents without a robot; a robot's sync effector defines its own.
inline constexpr std::string_view kSync = "syn";

/// An agent behind a connection (a client), or one that a Behavior drives inside the host. Simulation thread, except
/// sense().
class Participant {
 public:
  /// A client. The connection must outlive it or be removed by disconnect().
  Participant(IConnection& connection, Clock::time_point now);
  /// An agent inside the host.
  Participant(Behavior& behavior, Clock::time_point now);
  /// One of saved state, see load().
  Participant(int number, AgentAspect& aspect, Behavior* behavior);

  /// For the log: "agent 3 (127.0.0.1:4711)".
  const std::string& label() const { return label_; }
  /// The agent's number, from 1; 0 before join().
  int number() const { return number_; }
  /// nullptr: inside the host, or disconnected.
  IConnection* connection() const { return connection_; }
  /// nullptr: before join(), or removed from the tree.
  AgentAspect* aspect() const { return aspect_.get(); }
  /// nullptr: a client, or removed from the tree.
  Behavior* behavior() const { return behavior_.get(); }
  bool inside() const { return inside_; }

  /// True if it is a rule with a mind: no agent to others.
  bool isRule() const { return isRule_; }
  /// True if its actions of this cycle were sent before its first percepts came: what they ask for, it requires.
  bool requiresNow(std::int64_t cycle) const { return cycle <= requiredUntil_; }
  /// It does not take part, as what it requires was refused: it acts no more, and leaves as soon as it has heard so.
  void reject(std::string why) { rejection_ = std::move(why); }
  bool rejected() const { return !rejection_.empty(); }
  /// When its last message came, as a number that grows with each message; 0: it has none.
  std::uint64_t arrival() const { return arrival_; }
  void setArrival(std::uint64_t n) { arrival_ = n; }

  /// Marks it for removal at the start of the next act phase.
  void leave() { leaving_ = true; }
  /// The same; its mind, if it has one, does not join again.
  void exclude() { leaving_ = excluded_ = true; }
  bool excluded() const { return excluded_ || rejected(); }
  /// True if it is to be removed: it was marked, or its aspect, behavior or connection is gone.
  bool leaving() const {
    return leaving_ || (number_ > 0 && !aspect()) || (inside_ ? !behavior() : !connection_ && !vacant_);
  }
  /// True for an object of the scene, or a rule, whose mind was removed and nothing else.
  bool lostMind() const { return inside_ && given_.isObject() && !behavior() && !excluded(); }
  /// The connection ended.
  void disconnect() { connection_ = nullptr; }
  /// True for a client of saved state whose robot stands there, and waits for a connection.
  bool vacant() const { return vacant_; }
  /// Where the client was connected when the state was saved.
  struct Seat {
    std::string port;  ///< path
    std::uint64_t key = 0;
    bool operator==(const Seat&) const = default;
    static Seat of(IConnection& connection) { return {connection.port().path(), connection.id()}; }
  };
  const Seat& seat() const { return seat_; }
  /// True if the client was connected when the state was saved.
  bool wasConnected() const { return wasConnected_; }
  /// True if it is vacant until its port starts its program again, see IReturningAgents.
  bool returns() const { return vacant_ && returns_; }
  /// A vacant one goes on with this connection.
  void connect(IConnection& connection, Clock::time_point now);
  /// The same, with the connection of a client that has not done anything yet. That one leaves.
  void takeOver(Participant& client, Clock::time_point now);

  /// What game control gives an agent when it joins.
  struct Given {
    std::size_t effectors = 0, perceptors = 0;
    /// The agent is an object of the scene, or a rule: it needs no robot.
    bool isObject() const { return effectors == perceptors; }
  };
  /// Assigns number and aspect. A behavior adds its first actions. The agent has a robot as soon as it has more than
  /// what is given.
  void join(int number, AgentAspect& aspect, Given given, Clock::time_point now);
  /// When it was created or joined last.
  Clock::time_point joinedAt() const { return joinedAt_; }
  void joinedSince(Clock::time_point then) { joinedAt_ = then; }
  /// True while it has sent messages but its first percepts may be under way.
  bool joining() const {
    return heardFrom_ && sent_ == 0 && cycles_ <= kCyclesToSense + latencies_.act + latencies_.sense;
  }

  // ---- actions ----

  /// Looks up the parser of a client: the one below its port, otherwise the one below `gameControl`.
  void resolveParser(Node& gameControl);
  /// Parses a message; its actions depart in the next turn. `maxPending`: bytes per cycle. Returns "", or
  /// why the connection is to be closed.
  std::string receive(std::string_view message, std::size_t maxPending, AgentLog& log, std::int64_t cycle,
                      Clock::time_point now);
  /// A client's first message has come.
  bool heardFrom() const { return heardFrom_; }
  /// When the last message came; before the first one, when it was created.
  Clock::time_point lastHeard() const { return lastHeard_; }
  /// Received actions that are not under way yet.
  const Predicates& pending() const { return actions_.pending(); }
  /// Those that are held back.
  const Predicates& deferred() const { return actions_.heldBack(); }
  /// The last message that could be parsed; before join() only, valid until the next one.
  const Predicates& lastMessage() const { return actions_.lastMessage(); }
  /// A turn of the agents begins: what it has received departs. `latencies`: of what it does and senses in this turn.
  void depart(std::int64_t cycle, const AgentLatencies& latencies);
  /// Executes the actions that are due and that no judge refuses. `event`: of the act phase.
  void execute(AgentLog& log, const Event& event, const JudgeList& judges);
  /// Logs that an action with that predicate had no effect, or another than it says, and why: once for each kind of
  /// mistake. False if the line was dropped because there were too many.
  bool remark(AgentLog& log, std::int64_t cycle, std::string_view predicate, std::string_view why);

  // ---- percepts ----

  /// Rebuilds the tables of effectors and perceptors if something below the aspect has changed. True if that brought
  /// its robot.
  bool resolveRobot();
  /// True if it has or had a robot.
  bool hasRobot() const { return hasRobot_; }
  /// Forgets perceptors that were removed, after a change of the tree.
  void dropRemovedPerceptors() { perceptors_.dropRemoved(); }
  /// Sets whether it senses in this cycle. `always`: its percepts are sent even if there are none.
  void setTurn(bool senses, bool always) {
    turn_ = senses;
    sendsEmpty_ = always;
  }
  /// Updates what its perceptors share with those of others, before sense(). `round`: number of the sense phase.
  void share(std::uint64_t round) {
    if (turn_) perceptors_.share(round, nextCycle());
  }
  /// Counts the cycle, calls the perceptors that are due, and encodes the message that arrives next. Any thread;
  /// changes only this agent. False if reportFaults() has something to report.
  bool sense(const Event& event);
  /// After sense(), in the simulation thread.
  void reportFaults(AgentLog& log) { perceptors_.reportFaults(label_, log); }
  /// True if percepts arrive in this cycle.
  bool hasArrivals(std::int64_t cycle) const { return percepts_.hasArrived(cycle); }
  /// Sends the percepts that arrive, or calls the behavior with them. `now`: the time of the phase. Returns the number
  /// of messages that were dropped because the client has not read an earlier one. `tape`: nullptr if there is none.
  int deliver(AgentLog& log, std::int64_t cycle, Clock::time_point now, IInputTape* tape);
  /// Number of messages with percepts that were sent.
  std::int64_t sent() const { return sent_; }
  /// What was sensed last.
  const Predicates& percepts() const { return percepts_.newest(); }
  /// Wall time from percepts to the answer [s], smoothed; NaN if unknown.
  double latency() const { return latency_.seconds(); }

  // ---- succession, see ISuccession ----

  /// Another client claims what this one has; `again`: it did so in the last cycle. False: this one has sent something
  /// since the first time.
  bool claim(bool again);
  /// It was claimed, and has sent nothing since.
  bool claimed() const { return claimed_; }
  /// True if it hangs: it has answered none of the last kHanging messages, nor for kHangingFor seconds of wall time.
  bool hangs(Clock::time_point now) const;

  // ---- lockstep ----

  /// Lockstep waits for it: it can answer percepts with a sync predicate, was sent some, and has sent that predicate
  /// before or answered every message so far.
  bool mustAnswer() const { return canSync() && lockstep_.attentive(); }
  /// It can answer percepts with a sync predicate, and had not sent that predicate before this cycle's percepts.
  bool observes() const { return canSync() && !lockstep_.bound(); }
  /// It has ever sent a sync predicate.
  bool pledged() const { return lockstep_.pledged(); }
  /// It left a message unanswered before it sent one.
  bool lapsed() const { return lockstep_.lapsed(); }
  /// It has answered all messages of this cycle.
  bool answered() const { return lockstep_.answered(); }
  /// Number of cycles that it has answered.
  int answers() const { return lockstep_.answers(); }
  /// True for agents that the start of the match waited for.
  bool expected() const { return lockstep_.expected(); }
  /// Lockstep waits for it without a budget.
  bool trusted() const { return inside_ || lockstep_.trusted(); }
  /// Counts its answer to the last turn. Call it before depart(). `trust`: it counts for trust.
  void countAnswer(bool trust) { lockstep_.countAnswer(trust); }
  /// It did not answer in time: unless it has sent a sync predicate it is not waited for.
  void giveUp() { lockstep_.giveUp(); }
  /// It delayed others for too long; see LockstepRecord.
  void distrust() { lockstep_.distrust(); }

  // ---- the hold before the start, see Hold ----

  struct Held {
    bool complete = false;      ///< it waits for nothing but the start
    bool greeted = false;       ///< a greeting was sent since its last message
    bool needsNoRobot = false;  ///< it answered a greeting without naming one: a rule makes it
    int answers = 0;            ///< number of greetings that it answered with a sync predicate
  };
  Held& held() { return held_; }
  const Held& held() const { return held_; }
  /// Ends the hold: defers all received actions except those with the head `first` until the first percepts were sent,
  /// when they would have come without the hold. `expected`: lockstep trusts it from the start.
  void holdBack(std::string_view first, bool expected);
  /// Sends a message outside of the cycle, to a client that waits for one.
  void greet(const Predicates& percepts);

  /// Saves the cycle count, and what is under way: percepts that were not sent yet, actions. Messages in the network
  /// are not part of the state.
  void save(StateWriter& out) const;
  /// What save() wrote, as a new participant with the robot that stands below `root` by the same path: a client has no
  /// connection. Throws Error if the robot or the behavior is not there.
  static std::unique_ptr<Participant> load(StateReader& in, int number, Node& root);

 private:
  /// In cycle 3 the agent senses first, if its first message named its robot and has no latency.
  static constexpr std::int64_t kCyclesToSense = 2;
  bool canSync() const { return !vacant_ && !effectors_.syncPredicate().empty() && sent_ > 0; }
  bool isSync(std::string_view predicate) const;
  void executeModified(AgentLog& log, const Event& event, const JudgeList& judges);
  void executeAction(Effector& effector, const Element& action, AgentLog& log, std::int64_t cycle,
                     const JudgeList& judges);
  /// While its robot waits to be loaded, actions are kept for it.
  bool waitsForRobot() const { return !hasRobot_ && effectors_.loading(); }
  bool deliverFirst(AgentLog& log, std::int64_t cycle, Clock::time_point now, IInputTape* tape);
  void think(AgentLog& log, std::int64_t cycle);
  /// The cycle count in the next sense phase.
  std::int64_t nextCycle() const { return cycles_ + (inside_ || heardFrom_ || cycles_ == 0); }
  void encode();
  /// Logs a line about the agent, unless one of that kind was. False if it was dropped.
  bool warn(AgentLog& log, std::int64_t cycle, std::uint64_t kind, std::string_view text);
  bool warn(AgentLog& log, std::int64_t cycle, std::string_view text) {
    return warn(log, cycle, Mistakes::kindOf({}, text), text);
  }
  void warnUnknown(AgentLog& log, std::int64_t cycle, std::string_view predicate);

  std::string label_;
  int number_ = 0;
  IConnection* connection_ = nullptr;
  Ref<Behavior> behavior_;
  Ref<AgentAspect> aspect_;
  Ref<IParser> parser_;
  const bool inside_;
  bool leaving_ = false, heardFrom_ = false, hasRobot_ = false, vacant_ = false;
  Seat seat_;
  bool wasConnected_ = false, returns_ = false;
  bool isRule_ = false, excluded_ = false;
  bool perceived_ = false;           ///< its first percepts have arrived
  std::int64_t requiredUntil_ = -1;  ///< cycle of its last action that was sent before them
  std::string rejection_;            ///< "", or why it does not take part
  std::uint64_t arrival_ = 0;
  bool turn_ = true, sendsEmpty_ = false;  ///< see setTurn()
  bool blind_ = false;                     ///< its robot has no perceptors: its behavior is called with empty percepts
  Given given_;
  LockstepRecord lockstep_;
  ActionQueue actions_;
  EffectorTable effectors_;
  PerceptorTable perceptors_;
  TransitQueue percepts_;
  AgentLatencies latencies_;  ///< of this turn
  std::string message_;       ///< the first message of percepts_, encoded if `encoded_`
  bool encoded_ = false;
  std::int64_t cycles_ = 0;  ///< the agent's cycle count
  std::int64_t sent_ = 0;
  std::uint64_t robotAt_ = 0;  ///< AgentAspect::changedAt() at the last resolveRobot()
  LatencyMeter latency_;
  Clock::time_point joinedAt_, lastHeard_;
  Held held_;
  static constexpr int kHanging = 250;
  static constexpr double kHangingFor = 5;
  bool claimed_ = false;
  int unanswered_ = 0;                ///< messages to it since its last one, at most kHanging
  static constexpr int kLines = 100;  ///< about one agent, in LineBudget::kWindow
  LineBudget lines_{kLines};
  Mistakes mistakes_;
};

}  // namespace spark::gamecontrol
