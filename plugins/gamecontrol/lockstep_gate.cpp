#include "gamecontrol/lockstep_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gamecontrol/vacancies.h"

namespace spark::gamecontrol {

namespace {
/// The first kPacedMessages messages to an agent that has not sent (syn) yet are paced by joinPace, even if others
/// wait.
constexpr std::int64_t kPacedMessages = 50;
/// An agent whose name another one claims is closed after this multiple of answerWait.
constexpr double kPatienceWithClaims = 5;
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
double LockstepGate::waited(Clock::time_point last) const { return std::max(secondsBetween(waitingSince_, last), 0.0); }

bool LockstepGate::isOpen(const List& participants, const List& newcomers, const Limits& limits, Look look,
                          AgentLog& log) {
  if (!std::exchange(waiting_, true)) waitingSince_ = look.now;
  const auto joins = [](const auto& p) { return p->joining(); };
  const bool anyJoins = std::any_of(participants.begin(), participants.end(), joins) ||
                        std::any_of(newcomers.begin(), newcomers.end(), joins);
  const auto lapsed =
      std::count_if(participants.begin(), participants.end(), [](const auto& p) { return p->lapsed(); });
  bool untrusted = false;
  for (const auto& p : participants) {
    if (hasAnswered(*p, participants, limits, look.last, anyJoins, static_cast<int>(lapsed), log)) continue;
    if (!isUntrusted(*p, limits, look.last)) return false;
    untrusted = true;
  }
  if (!untrusted && !mustPace(participants, limits, look.last)) return true;
  return !waitForUntrusted(participants, look);
}

/// True if the gate need not wait for `p` now. One program may control many agents and read from each in turn: while
/// any agent is about to get its first percepts, the wait for the others is limited by answerWait.
bool LockstepGate::hasAnswered(Participant& p, const List& participants, const Limits& limits, Clock::time_point last,
                               bool anyJoins, int lapsed, AgentLog& log) const {
  if (p.leaving() || !p.mustAnswer() || p.answered()) return true;
  const double waits = waited(last);
  if (!p.pledged()) {
    if (waits < patience(p, limits, anyJoins, lapsed)) return false;
    log.write(Level::info,
              fmt::format("{} has not answered for {:.3g} s. The match does not wait for it until it sends its first "
                          "sync message, (syn) for most robots.",
                          p.label(), waits));
    p.giveUp();
    return true;
  }
  if (waits >= kPatienceWithClaims * limits.answerWait && isClaimed(participants, p, limits.policy)) {
    p.connection()->close(
        fmt::format("{} did not answer for {:.3g} s, and gives way to its successor", p.label(), waits));
    p.leave();
    return true;
  }
  if (anyJoins && !p.expected() && waits >= limits.answerWait) return true;
  if (limits.syncTimeout <= 0 || waits <= limits.syncTimeout) return false;
  p.connection()->close(fmt::format("{} did not answer for {} s, all others wait", p.label(), limits.syncTimeout));
  p.leave();
  return true;
}

/// For how long a cycle waits for an agent that has not sent a sync predicate yet [s]. Each of the `lapsed` agents,
/// which were waited for in vain, halves it: a team of which each player waits for the next one to join costs little
/// more than one such player.
double LockstepGate::patience(const Participant& p, const Limits& limits, bool anyJoins, int lapsed) const {
  const double own = std::ldexp(limits.answerWait * (anyJoins ? 1 : 1 + p.answers()), -lapsed);
  return std::max(limits.syncTimeout > 0 ? std::min(own, limits.syncTimeout) : own, limits.joinPace);
}

/// True if waiting for it is charged to the budget: it has not proved yet that it answers, or it is slow in this cycle
/// and was not expected.
bool LockstepGate::isUntrusted(const Participant& p, const Limits& limits, Clock::time_point last) const {
  return !p.trusted() || (!p.expected() && limits.syncTimeout > 0 && waited(last) > kSlow);
}

/// True if the next cycle would come too soon for a new agent: its answer may not be complete yet; or it reads until no
/// message is left before it answers, and could never join a match that runs as fast as possible.
bool LockstepGate::mustPace(const List& participants, const Limits& limits, Clock::time_point last) const {
  if (limits.joinPace <= 0) return false;
  const auto paced = [&](Clock::time_point since) { return secondsBetween(since, last) < limits.joinPace; };
  bool anyObserves = false, anyAnswers = false;
  for (const auto& p : participants) {
    if (p->leaving()) continue;
    if (p->observes() && p->sent() <= kPacedMessages && paced(p->mustAnswer() ? p->lastHeard() : cycleBeganAt_))
      return true;
    anyObserves |= p->observes();
    anyAnswers |= p->mustAnswer();
  }
  return anyObserves && !anyAnswers && paced(cycleBeganAt_);
}

/// Called when all trusted agents have answered, but untrusted ones have not, or the cycle must be paced for new ones.
/// True if the cycle waits for these: always if there are no trusted agents that it delays, otherwise within the
/// budget. When the budget is used up, the gate no longer waits for agents that have not answered.
bool LockstepGate::waitForUntrusted(const List& participants, Look look) {
  const auto delayed = [](const auto& p) { return !p->leaving() && p->mustAnswer() && p->trusted() && p->answered(); };
  if (std::none_of(participants.begin(), participants.end(), delayed)) return true;
  // The time since the cycle began does not refill the budget.
  budget_.refill(look.now);
  budget_.refill(cycleBeganAt_);
  if (chargedAt_ != Clock::time_point())
    budget_.spend(secondsBetween(chargedAt_, look.now));
  else if (waited(look.last) > kSlow)
    budget_.spend(kSlow);  // before a slow agent counted as untrusted
  chargedAt_ = look.now;
  if (budget_.available()) return true;
  for (const auto& p : participants)
    if (p->mustAnswer() && !p->answered() && !p->expected()) p->distrust();
  return false;
}

}  // namespace spark::gamecontrol
