#include "gamecontrol/hold.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

namespace spark::gamecontrol {

namespace {

constexpr std::string_view kScene = "scene";
constexpr int kAnswersWithoutIdentity = 2;
constexpr std::size_t kMaxListed = 12;  // clients in a log line

bool contains(const Predicates& predicates, std::string_view head) {
  for (const Element e : predicates)
    if (e.head() == head) return true;
  return false;
}

bool sent(const Participant& p, std::string_view predicate) { return contains(p.pending(), predicate); }
bool identified(const Participant& p, const IJoinPolicy* policy) { return policy && sent(p, policy->predicate()); }
bool complete(const Participant& p) {
  return !p.leaving() && (p.held().needsNoRobot || (p.held().complete && sent(p, kScene)));
}
/// True if the match may start with this agent when time is up. Without a policy a rule may make its robot.
bool usable(const Participant& p, const IJoinPolicy* policy) {
  return !p.leaving() && (sent(p, kScene) || (!policy && p.heardFrom()));
}
double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Team name, number, and the text of `(scene ...)`. If an agent has stated several identities the first one counts.
std::tuple<std::string_view, std::int64_t, std::string> sortKey(const Participant& p, const IJoinPolicy* policy) {
  Predicates robot;
  IJoinPolicy::Name name;
  bool found = false;
  for (const Element e : p.pending()) {
    if (e.head() == kScene) robot.append(e);
    if (policy && e.head() == policy->predicate() && !std::exchange(found, true)) name = policy->read(e);
  }
  std::string text;
  writeSexp(robot, 6, text);
  return {name.team, name.number, text};
}

/// The state of an agent, for the log: "agent at 127.0.0.1:4711 has named its robot, owes (init ...) and (syn)".
std::string describeMissing(const Participant& p, const IJoinPolicy* policy) {
  const bool isIdentified = identified(p, policy);
  if (!p.heardFrom()) return fmt::format("{} has said nothing", p.label());
  const std::string init = policy && !isIdentified ? fmt::format("({} ...)", policy->predicate()) : std::string();
  if (!sent(p, kScene) && !policy)
    return fmt::format("{} owes (scene ...) and (syn), or any answer to (time ...) if a rule makes its robot",
                       p.label());
  if (!sent(p, kScene))
    return fmt::format("{} owes (scene ...){}{} and (syn)", p.label(), init.empty() ? "" : ", ", init);
  if (isIdentified) return fmt::format("{} has named its robot and its team, owes (syn)", p.label());
  if (!policy) return fmt::format("{} has named its robot, owes (syn)", p.label());
  const std::string hint =
      sent(p, kSync) ? fmt::format("; if it has no {}, (syn) to two messages", policy->predicate()) : std::string();
  return fmt::format("{} has named its robot, owes {} and (syn){}", p.label(), init, hint);
}

}  // namespace

void Hold::onMessage(Participant& p, const IJoinPolicy* policy) {
  const bool answersGreeting = std::exchange(p.held().greeted, false);
  if (answersGreeting && !policy && !sent(p, kScene)) p.held().needsNoRobot = true;
  if (!contains(p.lastMessage(), kSync)) return;
  p.held().answers += answersGreeting;
  if (!policy || identified(p, policy) || p.held().answers >= kAnswersWithoutIdentity) p.held().complete = true;
}

/// True if the match starts with this agent.
bool Hold::isReady(const Participant& p, const IJoinPolicy* policy) const {
  return complete(p) || (timedOut_ && usable(p, policy));
}

bool Hold::isOver(const List& newcomers, const Terms& terms, Log& log) {
  const auto now = terms.now;
  updateProgress(newcomers, terms.policy, now);
  const auto ready =
      static_cast<int>(std::count_if(newcomers.begin(), newcomers.end(), [](const auto& p) { return complete(*p); }));
  if (std::exchange(complete_, ready) != ready) log.info("{} of {} expected agents are ready.", ready, terms.agents);
  if (ready >= terms.agents) return true;

  greetSilent(newcomers, terms, now);
  const bool anyUsable =
      std::any_of(newcomers.begin(), newcomers.end(), [&](const auto& p) { return usable(*p, terms.policy); });
  timedOut_ = anyUsable && terms.startAfter > 0 && seconds(now - progressAt_) >= terms.startAfter;
  if (timedOut_)
    log.warning(
        "Of {} expected agents {} are ready, and nothing more came for {} s (joinWait): the match starts. Others join "
        "as they come.",
        terms.agents, ready, terms.startAfter);
  else
    report(newcomers, terms, now, log);
  return timedOut_;
}

void Hold::greetSilent(const List& newcomers, const Terms& terms, Clock::time_point now) const {
  for (const auto& p : newcomers) {
    const bool owesRobot = terms.policy && !sent(*p, kScene);
    if (p->leaving() || complete(*p) || p->held().greeted || owesRobot ||
        seconds(now - p->lastHeard()) <= terms.greetAfter)
      continue;
    Predicates greeting;
    greeting.open("time").open("now").add(0.0).close().close();
    p->greet(greeting);
    p->held().greeted = true;
  }
}

/// There is progress if more steps are done by the connected agents than ever before, so that a client that connects
/// again and again makes none.
void Hold::updateProgress(const List& newcomers, const IJoinPolicy* policy, Clock::time_point now) {
  int steps = 0;
  for (const auto& p : newcomers)
    steps += sent(*p, kScene) + identified(*p, policy) + p->held().complete + p->held().needsNoRobot;
  if (steps <= progress_) return;
  progress_ = steps;
  progressAt_ = now;
}

void Hold::report(const List& newcomers, const Terms& terms, Clock::time_point now, Log& log) {
  if (reportedAt_ == Clock::time_point()) reportedAt_ = now;
  if (seconds(now - reportedAt_) < terms.reportEvery) return;
  reportedAt_ = now;

  std::string line;
  std::size_t incomplete = 0, connected = 0;
  for (const auto& p : newcomers) {
    connected += !p->leaving();
    if (complete(*p) || p->leaving()) continue;
    if (++incomplete <= kMaxListed) line += describeMissing(*p, terms.policy) + "; ";
  }
  if (incomplete > kMaxListed) line += fmt::format("{} more are not ready; ", incomplete - kMaxListed);
  const auto missing = terms.agents - static_cast<std::int64_t>(connected);
  if (missing > 0) line += fmt::format("{} {} not connected; ", missing, missing == 1 ? "is" : "are");
  if (terms.startAfter > 0 && progress_ > 0)
    line +=
        fmt::format("without any news the match starts in {:.0f} s; ", terms.startAfter - seconds(now - progressAt_));
  if (line.empty()) return;
  line.resize(line.size() - 2);  // the last "; "
  log.info("Waiting for {} of {} agents: {}.", terms.agents - complete_, terms.agents, line);
}

void Hold::orderNewcomers(List& newcomers, int expect, const IJoinPolicy* policy) const {
  // Take at most `expect` agents, complete ones first.
  int places = expect;
  const auto completeEnd = std::stable_partition(newcomers.begin(), newcomers.end(),
                                                 [&](const auto& p) { return complete(*p) && places-- > 0; });
  const auto end = std::stable_partition(
      completeEnd, newcomers.end(), [&](const auto& p) { return places > 0 && isReady(*p, policy) && places-- > 0; });
  std::stable_sort(newcomers.begin(), end,
                   [&](const auto& a, const auto& b) { return sortKey(*a, policy) < sortKey(*b, policy); });
  for (auto it = newcomers.begin(); it != end; ++it) (*it)->holdBack(kScene, !timedOut_);
}

}  // namespace spark::gamecontrol
