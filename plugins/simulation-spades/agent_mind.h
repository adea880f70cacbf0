#pragma once
/// \file
/// One agent in simulated time: what it is told when, how long it thinks, when its acts take effect.
///
/// Times are steps of the simulation, as integers. A sensation of time s arrives at s + senseLatency and begins a think
/// cycle, as a time notification does that the agent requested. The agent sends acts (A), requests (R) and questions
/// (C), and ends the cycle with D. Its think time is measured or modelled; all acts of a cycle are sent at its end and
/// take effect actLatency later:
///
///     sensed     arrives = cycle begins       D: cycle ends          acts take effect
///       s ──senseLatency──► a ─────think────────► e ───actLatency────► e + actLatency
///
/// What comes while it thinks waits for the end of the cycle. A time notification names the time that was requested, a
/// sensation that of its arrival.
///
/// After a cycle the agent may be informed how long it has thought (K). That begins no cycle, but it must answer D to
/// it as agents of the time do. Such agents keep one message of what they read, so the next one must not follow K
/// before they have read it; and only an answer shows that they have, in an order that is the same in every run.
///
/// The world may run on while the agent thinks, until the first time at which an act of it could take effect: at least
/// `least` think time, and the latency, after the beginning of the cycle. So agents think at the same time as one
/// another and as the world, and no result depends on when their messages come.
///
/// Latencies and the model of think times may change meanwhile. A sensation has the latency of the step in which it was
/// sent, a cycle those of the step in which it began; and none of an agent's sensations or acts overtakes an earlier
/// one.
///
/// Source: Obst and Rollmann, "Spark", 2004, sections 5.1 and 5.2; Riley, "SPADES", 2003.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recent_thoughts.h"

namespace spark::spades {

/// Simulated time [steps].
using Time = std::int64_t;
inline constexpr Time kNever = std::numeric_limits<Time>::max();

/// A number of steps for what an agent has used.
struct ThinkModel {
  std::optional<Time> fixed = 0;  ///< always as many steps; nullopt: measured
  double perStep = 0.01;          ///< measured: CPU time of a step [s], or instructions of a step
  bool instructions = false;      ///< measured: instructions count, not CPU time

  /// Shortest think time [steps]: before it no act can come.
  Time least() const { return fixed ? *fixed : 1; }
  /// Steps for a CPU time [s] and a number of instructions.
  Time thought(double cpuSeconds, double counted = 0) const {
    if (fixed) return *fixed;
    const double used = instructions ? counted : cpuSeconds;
    return std::max<Time>(1, static_cast<Time>(std::ceil(std::min(used / perStep, 1e9))));
  }
  bool operator==(const ThinkModel&) const = default;
};

/// Latencies of agents [steps].
struct Latencies {
  Time sense = 10, act = 10;
  /// A sensation that waits longer for the end of a cycle is dropped.
  Time mostWaiting = 50;
};

/// An act on its way to the world.
struct Act {
  Time due = 0;  ///< when it takes effect
  std::string data;
};

/// The agent's side of the conversation is in messages of one letter and text, without framing.
class AgentMind {
 public:
  /// Most bytes of the acts of a cycle.
  static constexpr std::size_t kMostActs = 1 << 20;
  explicit AgentMind(const Latencies& latencies) : latencies_(latencies) {}

  /// Queues what the agent senses at time `sent`; may be empty.
  void sense(Time sent, std::string data);
  /// The next message to the agent that is due at `now`, if it can take one; it begins a think cycle. `model`: of
  /// cycles that begin from now on. Call it in each step.
  std::optional<std::string> next(Time now, const ThinkModel& model);
  /// What follows from a message of the agent.
  enum class Result {
    nothing,
    ready,     ///< the agent is initialised
    question,  ///< it asks for the think time so far: answer with C
    done,      ///< the cycle ends: call end()
    exit,      ///< it leaves
    flood,     ///< it sends more than kMostActs in a cycle
  };
  Result take(std::string_view message);
  /// Ends the cycle after `thought` steps; appends its acts.
  void end(Time thought, std::vector<Act>& acts);
  /// The message that informs the agent of the think time of the cycle that ended last. Until it answers D, next() is
  /// nullopt. Not while thinking().
  std::string inform();

  /// Forgets what is on its way to the agent, and of what it thinks now nothing will come: time goes on elsewhere.
  void forget();

  bool ready() const { return ready_; }
  bool thinking() const { return thinking_; }
  /// True from inform() until the agent answers.
  bool informed() const { return informed_; }
  /// When the cycle began. Only while thinking().
  Time began() const { return began_; }
  /// The model of its think time. Only while thinking().
  const ThinkModel& model() const { return cycle_.model; }
  /// Until it answers, the world must not execute the step that begins at this time; kNever: no limit.
  Time horizon() const;
  /// How long it thought in its last cycles.
  const RecentThoughts& thoughts() const { return thoughts_; }
  /// Sensations that were dropped because the agent thought for too long.
  std::int64_t dropped() const { return dropped_; }

 private:
  struct Pending {
    Time due;   ///< arrives then, or later if the agent thinks
    Time sent;  ///< of a sensation; -1: a time notification
    std::string data;
  };
  /// What holds for cycles that begin at `from` or later.
  struct Terms {
    Time from, act;
    ThinkModel model;
    /// The first time at which acts of a cycle that begins at `at` could take effect.
    Time effect(Time at) const { return at + model.least() + act; }
  };
  const Terms& termsAt(Time at) const;

  const Latencies& latencies_;
  std::deque<Pending> pending_;  ///< in the order of insertion
  std::vector<std::string> acts_;
  std::vector<Time> requests_;
  bool ready_ = false, thinking_ = false, informed_ = false;
  bool stale_ = false;        ///< forget() was called since it began to think
  std::vector<Terms> terms_;  ///< in the order of time, from the cycle that began last on
  Terms cycle_{};             ///< of the cycle
  std::size_t actBytes_ = 0;  ///< of acts_
  Time began_ = 0, ended_ = 0;
  Time arrival_ = 0, effect_ = 0;  ///< of the last sensation, and of the acts of the last cycle
  std::int64_t dropped_ = 0;
  RecentThoughts thoughts_;
};

}  // namespace spark::spades
