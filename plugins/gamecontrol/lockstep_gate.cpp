#include "gamecontrol/lockstep_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace spark::gamecontrol {

namespace {
/// The first kPacedMessages messages to an agent that has not sent (syn) yet are paced by joinPace, even if others
/// wait.
constexpr std::int64_t kPacedMessages = 50;
/// An agent that delays a cycle for longer is slow [s].
constexpr double kSlow = 1;

double secondsBetween(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}
}  // namespace

void LockstepGate::beginCycle(Clock::time_point now) {
  waiting_ = false;
  cycleBeganAt_ = now;
  if (chargedAt_ != Clock::time_point()) budget_.spend(secondsBetween(std::exchange(chargedAt_, {}), now));
}

/// Seconds that this cycle has waited.
double LockstepGate::waited(Clock::time_point now) const { return secondsBetween(waitingSince_, now); }

bool LockstepGate::isOpen(const List& participants, const List& newcomers, const Limits& limits,
                          Clock::time_point now) {
  if (!std::exchange(waiting_, true)) waitingSince_ = now;
  const auto joins = [](const auto& p) { return p->joining(); };
  const bool anyJoins = std::any_of(participants.begin(), participants.end(), joins) ||
                        std::any_of(newcomers.begin(), newcomers.end(), joins);
  bool untrusted = false;
  for (const auto& p : participants) {
    if (hasAnswered(*p, limits, now, anyJoins)) continue;
    if (!isUntrusted(*p, limits, now)) return false;
    untrusted = true;
  }
  if (!untrusted && !mustPace(participants, limits, now)) return true;
  return !waitForUntrusted(participants, now);
}

/// True if the gate need not wait for `p` now. One program may control many agents and read from each in turn: while
/// any agent is about to get its first percepts, the wait for the others is limited by answerWait.
bool LockstepGate::hasAnswered(Participant& p, const Limits& limits, Clock::time_point now, bool anyJoins) const {
  if (p.leaving() || !p.mustSync() || p.synced()) return true;
  if (anyJoins && !p.expected() && waited(now) >= limits.answerWait) return true;
  if (limits.syncTimeout <= 0 || waited(now) <= limits.syncTimeout) return false;
  p.connection()->close(fmt::format("{} did not answer for {} s, all others wait", p.label(), limits.syncTimeout));
  p.leave();
  return true;
}

/// True if waiting for it is charged to the budget: it has not proved yet that it answers, or it is slow in this cycle
/// and was not expected.
bool LockstepGate::isUntrusted(const Participant& p, const Limits& limits, Clock::time_point now) const {
  return !p.trusted() || (!p.expected() && limits.syncTimeout > 0 && waited(now) > kSlow);
}

/// True if the next cycle would come too soon for a new agent. Some clients read until no message is left before they
/// continue; they could never join a match that runs as fast as possible.
bool LockstepGate::mustPace(const List& participants, const Limits& limits, Clock::time_point now) const {
  if (secondsBetween(cycleBeganAt_, now) >= limits.joinPace) return false;
  bool anyObserves = false, anySyncs = false;
  for (const auto& p : participants) {
    if (p->leaving()) continue;
    if (p->observes() && p->sent() <= kPacedMessages) return true;
    anyObserves |= p->observes();
    anySyncs |= p->mustSync();
  }
  return anyObserves && !anySyncs;
}

/// Called when all trusted agents have answered, but untrusted ones have not, or the cycle must be paced for new ones.
/// True if the cycle waits for these: always if there are no trusted agents, which could be delayed, otherwise within
/// the budget. When the budget is used up, the gate no longer waits for agents that have not answered.
bool LockstepGate::waitForUntrusted(const List& participants, Clock::time_point now) {
  const auto delayed = [](const auto& p) { return !p->leaving() && p->mustSync() && p->trusted(); };
  if (std::none_of(participants.begin(), participants.end(), delayed)) return true;
  // The time since the cycle began does not refill the budget.
  budget_.refill(now);
  budget_.refill(cycleBeganAt_);
  if (chargedAt_ != Clock::time_point())
    budget_.spend(secondsBetween(chargedAt_, now));
  else if (waited(now) > kSlow)
    budget_.spend(kSlow);  // before a slow agent counted as untrusted
  chargedAt_ = now;
  if (budget_.available()) return true;
  for (const auto& p : participants)
    if (p->mustSync() && !p->synced() && !p->expected()) p->distrust();
  return false;
}

}  // namespace spark::gamecontrol
