#include "gamecontrol/hold.h"

#include <algorithm>
#include <string_view>
#include <tuple>

namespace spark::gamecontrol {

namespace {

constexpr std::string_view kScene = "scene";
constexpr int kAnswersWithoutName = 2;
constexpr std::size_t kMostNamed = 12;  // clients in one line

bool holds(const Predicates& predicates, std::string_view wanted) {
  for (const Element e : predicates)
    if (e.head() == wanted) return true;
  return false;
}

bool sent(const Participant& p, std::string_view predicate) { return holds(p.pending(), predicate); }
bool named(const Participant& p, const IJoinPolicy* policy) { return policy && sent(p, policy->predicate()); }
bool complete(const Participant& p) { return !p.leaving() && p.held().saidAll && sent(p, kScene); }
double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Team name and number as it said them first; for those that have none, what they said of their robot.
std::tuple<std::string_view, std::int64_t, std::string> whoIs(const Participant& p, const IJoinPolicy* policy) {
  Predicates robot;
  IJoinPolicy::Name name;
  bool known = false;
  for (const Element e : p.pending()) {
    if (e.head() == kScene) robot.append(e);
    if (policy && e.head() == policy->predicate() && !std::exchange(known, true)) name = policy->read(e);
  }
  std::string text;
  writeSexp(robot, 6, text);
  return {name.team, name.number, text};
}

/// "agent at 127.0.0.1:4711 has named its robot, owes (init ...) and (syn)".
std::string owes(const Participant& p, const IJoinPolicy* policy) {
  const bool scene = sent(p, kScene), isNamed = named(p, policy);
  if (!p.heardFrom()) return p.label() + " has said nothing";
  const std::string name = policy && !isNamed ? fmt::format("({} ...)", policy->predicate()) : std::string();
  if (!scene) return p.label() + " owes (scene ...)" + (name.empty() ? "" : ", " + name) + " and (syn)";
  if (isNamed) return p.label() + " has named its robot and its team, owes (syn)";
  if (!policy) return p.label() + " has named its robot, owes (syn)";
  return p.label() + " has named its robot, owes " + name + " and (syn)" +
         (sent(p, kSync) ? fmt::format("; if it has no {}, (syn) to two messages", policy->predicate()) : "");
}

}  // namespace

void Hold::note(Participant& p, const IJoinPolicy* policy) {
  const bool answers = std::exchange(p.held().greeted, false);
  if (!holds(p.lastMessage(), kSync)) return;
  p.held().answers += answers;
  if (!policy || named(p, policy) || p.held().answers >= kAnswersWithoutName) p.held().saidAll = true;
}

bool Hold::isThere(const Participant& p) const { return complete(p) || (givenUp_ && !p.leaving() && sent(p, kScene)); }

bool Hold::over(const List& newcomers, const Terms& terms, Log& log) {
  const auto now = Clock::now();
  noteProgress(newcomers, terms.policy, now);
  const auto there =
      static_cast<int>(std::count_if(newcomers.begin(), newcomers.end(), [](const auto& p) { return complete(*p); }));
  if (std::exchange(reported_, there) != there) log.info("{} of {} expected agents are ready.", there, terms.agents);
  if (there >= terms.agents) return true;
  greet(newcomers, terms.greetAfter, now);
  const bool anybody =
      std::any_of(newcomers.begin(), newcomers.end(), [](const auto& p) { return !p->leaving() && sent(*p, kScene); });
  givenUp_ = anybody && terms.startAfter > 0 && seconds(now - progressAt_) >= terms.startAfter;
  if (givenUp_)
    log.warning(
        "Of {} expected agents {} are ready, and nothing more came for {} s (joinWait): the match starts. Others join "
        "as they come.",
        terms.agents, there, terms.startAfter);
  else
    report(newcomers, terms, now, log);
  return givenUp_;
}

void Hold::greet(const List& newcomers, double patience, Clock::time_point now) const {
  for (const auto& p : newcomers) {
    if (p->leaving() || complete(*p) || p->held().greeted || !sent(*p, kScene) ||
        seconds(now - p->lastHeard()) <= patience)
      continue;
    Predicates hello;
    hello.open("time").open("now").add(0.0).close().close();
    p->greet(hello);
    p->held().greeted = true;
  }
}

/// More was said than ever before. Those that come and go again are none.
void Hold::noteProgress(const List& newcomers, const IJoinPolicy* policy, Clock::time_point now) {
  int said = 0;
  for (const auto& p : newcomers) said += sent(*p, kScene) + named(*p, policy) + p->held().saidAll;
  if (said <= furthest_) return;
  furthest_ = said;
  progressAt_ = now;
}

void Hold::report(const List& newcomers, const Terms& terms, Clock::time_point now, Log& log) {
  if (reportedAt_ == Clock::time_point()) reportedAt_ = now;
  if (seconds(now - reportedAt_) < terms.reportEvery) return;
  reportedAt_ = now;
  std::string line;
  std::size_t left = 0, connected = 0;
  for (const auto& p : newcomers) {
    connected += !p->leaving();
    if (complete(*p) || p->leaving()) continue;
    if (++left <= kMostNamed) line += owes(*p, terms.policy) + "; ";
  }
  if (left > kMostNamed) line += fmt::format("{} more are not ready; ", left - kMostNamed);
  const auto missing = static_cast<std::int64_t>(terms.agents) - static_cast<std::int64_t>(connected);
  if (missing > 0) line += fmt::format("{} {} not connected; ", missing, missing == 1 ? "is" : "are");
  if (terms.startAfter > 0 && furthest_ > 0)
    line +=
        fmt::format("without any news the match starts in {:.0f} s; ", terms.startAfter - seconds(now - progressAt_));
  if (line.empty()) return;
  line.resize(line.size() - 2);
  log.info("Waiting for {} of {} agents: {}.", terms.agents - reported_, terms.agents, line);
}

std::size_t Hold::order(List& newcomers, int expect, const IJoinPolicy* policy) const {
  int left = expect;
  // Those that are complete before those that are merely there.
  const auto whole = std::stable_partition(newcomers.begin(), newcomers.end(),
                                           [&](const auto& p) { return complete(*p) && left-- > 0; });
  const auto middle = std::stable_partition(whole, newcomers.end(),
                                            [&](const auto& p) { return left > 0 && isThere(*p) && left-- > 0; });
  std::stable_sort(newcomers.begin(), middle,
                   [&](const auto& a, const auto& b) { return whoIs(*a, policy) < whoIs(*b, policy); });
  for (auto it = newcomers.begin(); it != middle; ++it) (*it)->holdBack(kScene, !givenUp_);
  return static_cast<std::size_t>(middle - newcomers.begin());
}

}  // namespace spark::gamecontrol
