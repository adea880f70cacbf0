#include "loading.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>

#include "api/agents.h"
#include "spark/error.h"
#include "spark/script_server.h"

// A match is deterministic, so the n-th cycle of every repetition does the same work, and the minimum of its times is
// the cost of that work. A quiet cycle has the same number of robots, all asleep, and the same vision perceptors are
// due (vision runs in every third cycle). The excess over a quiet cycle is the cost of the change. It includes the
// solver's work for the new robot, which is awake.

namespace spark::bench {

namespace {

constexpr int kCyclesPerChange = 60, kShown = 8, kQuiet = 15, kVisionPeriod = 3, kKinds = 5;

double cpuMicros() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double heapKB() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1024;
}

/// Loads its robot, beams to its position, and rests.
class Newcomer : public Behavior {
  SPARK_CLASS(Newcomer, Behavior)
 public:
  static void describe(Description<Newcomer>& d) { d.doc("An agent that joins and then rests."); }
  int index = 0;

  void start(Predicates& actions) override {
    actions.open("scene").add("rsg/agent/nao/nao_hetero.rsg").add(index % kKinds).close();
  }
  void think(const Predicates&, Predicates& actions) override {
    ++thoughts_;
    if (thoughts_ == 1)
      actions.open("init").pair("unum", index % 11 + 1).pair("teamname", index < 11 ? "Left" : "Right").close();
    else if (thoughts_ == 4)
      actions.open("beam")
          .add(-2 - 2.4 * (index % 11 % 4))
          .add(4.0 * (index % 11 / 4 - 1) + 0.3 * (index % 11 % 4))
          .add(0.0)
          .close();
  }

 private:
  int thoughts_ = 0;
};

/// A soccer simulation that writes its monitor log to /dev/null, which costs as much as a monitor.
class Match {
 public:
  Match() {
    const auto bin = std::filesystem::canonical("/proc/self/exe").parent_path();
    const auto share = std::filesystem::weakly_canonical(bin / ".." / "share" / "spark");
    kernel_.log().setLevel(Level::error);
    kernel_.plugins().scan(bin / ".." / "plugins");
    scripts(kernel_).addFolder(share / "lua");
    scripts(kernel_).run(fmt::format("host = {{ share = \"{}\", scenePaths = {{}} }}", share.string()), "bench");
    for (const char* port : {"agents", "monitors"})
      scripts(kernel_).addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
    scripts(kernel_).addOverride("webPort", 0);
    scripts(kernel_).addOverride("monitorLog", "/dev/null");
    scripts(kernel_).runConfig("soccer.lua");
    simulation_ = &kernel_.root().require<Leaf>("/sys/server/simulation");
    setProperty(*simulation_, "rate", "max");
    kernel_.registerClass<Newcomer>();
    home_ = &kernel_.create<Node>("Node", "/usr/agent");
  }

  void join(int i) {
    auto made = kernel_.classOf("Newcomer").create();
    made->setName(fmt::format("newcomer{}", i));
    static_cast<Newcomer&>(*made).index = i;
    home_->add(std::move(made));
  }
  void leave() { home_->remove(*home_->children().back()); }

  CycleCost cycle() {
    callMethod(*simulation_, "resetTimers", {});
    const double before = cpuMicros();
    callMethod(*simulation_, "runCycles", std::vector<Value>{1});
    CycleCost cost;
    cost.total = cpuMicros() - before;
    const Value means = getProperty(*simulation_, "phaseMicros");
    for (const Value& v : means.toList()) cost.phases.push_back(v.at(1)->toNumber());
    return cost;
  }
  std::vector<CycleCost> cycles(int n) {
    std::vector<CycleCost> out;
    for (int i = 0; i < n; ++i) out.push_back(cycle());
    return out;
  }
  std::vector<std::string> phases() const {
    std::vector<std::string> out;
    const Value means = getProperty(*simulation_, "phaseMicros");
    for (const Value& v : means.toList()) out.push_back(v.at(0u)->toString());
    return out;
  }

 private:
  Kernel kernel_;
  Leaf* simulation_ = nullptr;
  Node* home_ = nullptr;
};

/// All cycles after each change.
struct Run {
  std::vector<std::vector<CycleCost>> joins, leaves;
  double kBPerRobot = 0;
};

Run play(Match& match, int robots) {
  Run run;
  double heap = 0;
  match.cycles(kCyclesPerChange);
  for (int i = 0; i < robots; ++i) {
    if (i == std::min(kKinds, robots - 1)) heap = heapKB();
    match.join(i);
    run.joins.push_back(match.cycles(kCyclesPerChange));
  }
  run.kBPerRobot = (heapKB() - heap) / std::max(1, robots - kKinds);
  for (int i = 0; i < robots; ++i) {
    match.leave();
    run.leaves.push_back(match.cycles(kCyclesPerChange));
  }
  return run;
}

void keepMinimum(CycleCost& minimum, const CycleCost& other) {
  minimum.total = std::min(minimum.total, other.total);
  for (std::size_t i = 0; i < minimum.phases.size(); ++i)
    minimum.phases[i] = std::min(minimum.phases[i], other.phases[i]);
}

void keepMinimum(std::vector<std::vector<CycleCost>>& minimum, const std::vector<std::vector<CycleCost>>& other) {
  for (std::size_t i = 0; i < minimum.size(); ++i)
    for (std::size_t k = 0; k < minimum[i].size(); ++k) keepMinimum(minimum[i][k], other[i][k]);
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// The median over those of the last cycles in which the same vision perceptors are due as in cycle `k`.
CycleCost quietAs(std::size_t k, const std::vector<CycleCost>& cycles) {
  const auto over = [&](const auto& get) {
    std::vector<double> all;
    for (std::size_t i = cycles.size() - kQuiet; i < cycles.size(); ++i)
      if (i % kVisionPeriod == k % kVisionPeriod) all.push_back(get(cycles[i]));
    return median(std::move(all));
  };
  CycleCost out;
  out.total = over([](const CycleCost& c) { return c.total; });
  for (std::size_t p = 0; p < cycles.front().phases.size(); ++p)
    out.phases.push_back(over([p](const CycleCost& c) { return c.phases[p]; }));
  return out;
}

CycleCost operator-(CycleCost a, const CycleCost& b) {
  a.total -= b.total;
  for (std::size_t p = 0; p < a.phases.size(); ++p) a.phases[p] -= b.phases[p];
  return a;
}

std::vector<Change> costs(const std::vector<std::vector<CycleCost>>& changes, const std::function<int(int)>& robots) {
  std::vector<Change> out;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Change c;
    c.robots = robots(static_cast<int>(i));
    c.quiet = quietAs(0, changes[i]);
    for (std::size_t k = 0; k < kShown; ++k) c.excess.push_back(changes[i][k] - quietAs(k, changes[i]));
    out.push_back(std::move(c));
  }
  return out;
}

void printRow(const Change& c) {
  fmt::print("{:>6} {:>8.0f} ", c.robots, c.quiet.total);
  for (const CycleCost& cycle : c.excess) fmt::print("{:>7.0f}", cycle.total);
  fmt::print("\n");
}

/// Prints the excess of each shown cycle by phase.
void printPhases(const Loading& loading, const Change& c) {
  fmt::print("by phase, with {} robots:\n", c.robots);
  for (std::size_t p = 0; p < loading.phases.size(); ++p) {
    fmt::print("{:>15} ", loading.phases[p]);
    for (const CycleCost& cycle : c.excess) fmt::print("{:>7.0f}", cycle.phases[p]);
    fmt::print("\n");
  }
}

/// The excess of the most expensive cycle.
double worstOf(const Change& c) {
  double worst = 0;
  for (const CycleCost& cycle : c.excess) worst = std::max(worst, cycle.total);
  return worst;
}

Json rowOf(const Loading& loading) {
  std::vector<double> joins, leaves;
  for (std::size_t i = kKinds; i < loading.joins.size(); ++i) joins.push_back(worstOf(loading.joins[i]));
  for (const Change& c : loading.leaves) leaves.push_back(worstOf(c));
  return {{"world", "loading"},
          {"robots", loading.joins.size()},
          {"worstMicros", *std::max_element(joins.begin(), joins.end())},
          {"medianMicros", median(joins)},
          {"worstLeaveMicros", *std::max_element(leaves.begin(), leaves.end())},
          {"firstMicros", worstOf(loading.joins.front())},
          {"kBPerRobot", loading.kBPerRobot}};
}

void print(const Loading& loading) {
  fmt::print("CPU µs of a quiet cycle, and the excess of the cycles from the one in which a robot joins\n");
  fmt::print("robots    quiet  +0: it connects  +1: it loads  +2: it senses ...\n");
  for (const Change& c : loading.joins) printRow(c);
  for (const auto* c : {&loading.joins.front(), &loading.joins.back()}) printPhases(loading, *c);
  fmt::print("robots    quiet  +0: it leaves ...\n");
  for (const Change& c : loading.leaves) printRow(c);
  printPhases(loading, loading.leaves.front());
  const Json row = rowOf(loading);
  fmt::print(
      "excess of the longest cycle: at most {:.0f} µs after a join, median {:.0f}; after a leave at most {:.0f}; after "
      "the first join {:.0f}; heap {:.0f} kB per robot\n",
      row["worstMicros"].get<double>(), row["medianMicros"].get<double>(), row["worstLeaveMicros"].get<double>(),
      row["firstMicros"].get<double>(), loading.kBPerRobot);
}

}  // namespace

Loading measureLoading(int robots, int repeats) {
  Loading loading;
  Run minimum;
  for (int i = 0; i < repeats; ++i) {
    Match match;
    if (loading.phases.empty()) loading.phases = match.phases();
    Run run = play(match, robots);
    loading.kBPerRobot = run.kBPerRobot;
    if (i == 0) {
      minimum = std::move(run);
    } else {
      keepMinimum(minimum.joins, run.joins);
      keepMinimum(minimum.leaves, run.leaves);
    }
  }
  loading.joins = costs(minimum.joins, [](int i) { return i + 1; });
  loading.leaves = costs(minimum.leaves, [robots](int i) { return robots - i - 1; });
  return loading;
}

void runLoading(bool json) {
  const Loading loading = measureLoading(22, 9);
  if (json)
    fmt::print("{}\n", Json::array({rowOf(loading)}).dump(1));
  else
    print(loading);
}

}  // namespace spark::bench
