#include "gamecontrol/hold.h"

#include <algorithm>
#include <string_view>
#include <tuple>

namespace spark::gamecontrol {

namespace {

constexpr std::string_view kScene = "scene", kInit = "init";

bool holds(const Predicates& predicates, std::string_view wanted) {
  for (const Element e : predicates)
    if (e.head() == wanted) return true;
  return false;
}

bool sent(const Participant& p, std::string_view predicate) { return holds(p.pending(), predicate); }
bool complete(const Participant& p) { return !p.leaving() && p.saidAll() && sent(p, kScene); }

/// Team name and number from the first init.
std::tuple<std::string_view, std::int64_t> whoIs(const Participant& p) {
  for (const Element e : p.pending()) {
    if (e.head() != kInit) continue;
    const Element team = e.named("teamname"), unum = e.named("unum");
    return {team ? team.at(1).text() : std::string_view(), unum ? unum.at(1).integer() : 0};
  }
  return {};
}

}  // namespace

void Hold::note(Participant& p) {
  if (holds(p.lastMessage(), kSync) && sent(p, kInit)) p.setSaidAll();
}

bool Hold::over(const List& newcomers, int expect, double patience, Log& log) {
  const auto now = Clock::now();
  int there = 0;
  for (const auto& p : newcomers) {
    if (complete(*p)) {
      ++there;
    } else if (!p->greeted() && sent(*p, kScene) && !sent(*p, kInit) && std::chrono::duration<double>(now - p->lastHeard()).count() > patience) {
      Predicates hello;
      hello.open("time").open("now").add(0.0).close().close();
      p->greet(hello);
    }
  }
  if (there != reported_) log.info("{} of {} expected agents are ready.", there, expect);
  reported_ = there;
  return there >= expect;
}

std::size_t Hold::order(List& newcomers, int expect) {
  int left = expect;
  const auto middle = std::stable_partition(newcomers.begin(), newcomers.end(), [&](const auto& p) { return complete(*p) && left-- > 0; });
  std::stable_sort(newcomers.begin(), middle, [](const auto& a, const auto& b) { return whoIs(*a) < whoIs(*b); });
  for (auto it = newcomers.begin(); it != middle; ++it) (*it)->holdBack(kScene);
  return static_cast<std::size_t>(middle - newcomers.begin());
}

}  // namespace spark::gamecontrol
