#include <catch2/catch.hpp>

#include "bench.h"

// Modifiers of whole percepts and actions: delay, jitter and dropout.

using namespace spark;
using namespace spark::test;

namespace {
/// The cycles in which the percepts of cycles 1, 2, ... come out, in their order.
std::vector<int> arrivals(Bench& bench, int percepts, int interval = 1) {
  std::vector<int> out;
  for (int cycle = 1; static_cast<int>(out.size()) < percepts; ++cycle) {
    bench.lists.clear();
    if (cycle % interval == 0 && cycle / interval <= percepts) bench.lists.open("S").add(cycle / interval).close();
    bench.pass(bench.lists);
    for (const Element e : bench.lists) {
      REQUIRE(e.at(1).integer() == static_cast<std::int64_t>(out.size()) + 1);  // in order, and none is lost
      out.push_back(cycle);
    }
  }
  return out;
}
}  // namespace

TEST_CASE("A delay of n cycles passes each percept on exactly n cycles later") {
  for (const int n : {0, 1, 3, 100}) {
    Bench bench;
    bench.add("Delay", {{"cycles", n}});
    for (int cycle = 0; cycle < 300; ++cycle)
      REQUIRE(bench.sense(cycle) == (cycle < n ? "" : fmt::format("(S {}.00)", cycle - n)));
  }
}

TEST_CASE("A delay in seconds counts simulated time, in whole cycles") {
  const auto [seconds, cycles] = GENERATE(table<double, int>({{0.06, 3}, {0.061, 4}, {0.05, 3}, {0.0, 0}, {2.0, 100}}));
  Bench bench;
  bench.add("Delay", {{"seconds", seconds}});
  const std::vector<int> times = arrivals(bench, 500);
  for (int i = 0; i < 500; ++i) REQUIRE(times[static_cast<std::size_t>(i)] == i + 1 + cycles);
}

TEST_CASE("With both, the longer dead time counts") {
  Bench bench;
  bench.add("Delay", {{"seconds", 0.06}, {"cycles", 2}});
  CHECK(arrivals(bench, 3) == std::vector<int>{4, 5, 6});
  Bench other;
  other.add("Delay", {{"seconds", 0.06}, {"cycles", 5}});
  CHECK(arrivals(other, 3) == std::vector<int>{6, 7, 8});
}

TEST_CASE("A percept of a sensor with an interval comes out in a cycle in which the sensor is not due") {
  Bench bench;
  bench.add("Delay", {{"cycles", 4}});
  CHECK(arrivals(bench, 4, 3) == std::vector<int>{7, 10, 13, 16});
}

TEST_CASE("A delayed percept is whole: names, integers, inner lists, several lists of a cycle") {
  Bench bench;
  bench.add("Delay", {{"cycles", 1}});
  const std::string percept = "(S (n a-name-of-many-letters) (id 7) (v 1.50 (2.50)))(T 1)";
  Predicates lists;
  lists.open("S").pair("n", "a-name-of-many-letters").pair("id", 7).open("v").add(1.5).open().add(2.5);
  lists.close().close().close().open("T").add(1).close();
  bench.pass(lists);
  CHECK(lists.empty());
  bench.pass(lists);
  CHECK(textOf(lists) == percept);
}

TEST_CASE("A shorter dead time lets nothing overtake") {
  Bench bench;
  Leaf& delay = bench.add("Delay", {{"cycles", 3}});
  CHECK(bench.sense(1) == "");
  setProperty(delay, "cycles", 0);
  CHECK(bench.sense(2) == "");
  CHECK(bench.sense(3) == "");
  CHECK(bench.sense(4) == "(S 1.00)(S 2.00)(S 3.00)(S 4.00)");
}

TEST_CASE("A delay holds so much memory and no more; what comes on top is lost") {
  Bench bench;
  bench.add("Delay", {{"cycles", 3}});
  const std::string text(9 << 20, 'x');
  const auto act = [&] {
    bench.lists.clear();
    bench.lists.open("say").add(text).close();
    bench.pass(bench.lists, Signal::Kind::action);
    return !bench.lists.empty();
  };
  std::vector<bool> out;
  for (int i = 0; i < 8; ++i) out.push_back(act());
  CHECK(out == std::vector<bool>{false, false, false, true, false, false, false, true});
}

TEST_CASE("Jitter delays by a random number of cycles, uniformly distributed, in order") {
  // Percepts that are so far apart that none waits for another.
  Bench bench;
  bench.add("Jitter", {{"cycles", 4}});
  constexpr int kPercepts = 5000, kInterval = 5;
  const std::vector<int> times = arrivals(bench, kPercepts, kInterval);
  std::vector<int> counts(5);
  std::vector<double> delays;
  for (int i = 0; i < kPercepts; ++i) {
    delays.push_back(times[static_cast<std::size_t>(i)] - kInterval * (i + 1));
    REQUIRE((delays.back() >= 0 && delays.back() <= 4));
    ++counts[static_cast<std::size_t>(delays.back())];
  }
  for (const int count : counts) CHECK(std::abs(count / double(kPercepts) - 0.2) < 0.025);
  CHECK(std::abs(autocorrelation(delays, 1)) < 0.06);
}

TEST_CASE("Jitter in every cycle keeps the order: each percept leaves when it and all before it may") {
  Bench bench;
  bench.add("Jitter", {{"cycles", 4}});
  const std::vector<int> times = arrivals(bench, 5000);
  int later = 0;
  for (int i = 0; i < 5000; ++i) {
    const int delay = times[static_cast<std::size_t>(i)] - (i + 1);
    REQUIRE((delay >= 0 && delay <= 4));
    later += delay;
  }
  // The delay is max(d0, d1 - 1, ..., d4 - 4) of five draws from 0 to 4. P(at most k) is the product of P(di <= k + i):
  // 0.2 0.4 0.6 0.8, 0.4 0.6 0.8, 0.6 0.8, 0.8, 1 for k = 0 to 4. The mean is the sum of 1 - P over k.
  CHECK(std::abs(later / 5000.0 - (4 - 0.0384 - 0.192 - 0.48 - 0.8)) < 0.1);
}

TEST_CASE("Jitter in seconds is uniformly distributed") {
  Bench bench;
  bench.add("Jitter", {{"seconds", 0.08}});  // less than four cycles
  const std::vector<int> times = arrivals(bench, 5000, 5);
  std::vector<int> counts(5);
  for (int i = 0; i < 5000; ++i)
    ++counts.at(static_cast<std::size_t>(times[static_cast<std::size_t>(i)] - 5 * (i + 1)));
  CHECK(counts[0] < 5);  // only a draw below the tolerance of 1 µs leaves at once
  for (int i = 1; i <= 4; ++i) CHECK(std::abs(counts[static_cast<std::size_t>(i)] / 5000.0 - 0.25) < 0.025);
}

TEST_CASE("Delay and jitter in a chain add up") {
  Bench bench;
  bench.add("Delay", {{"cycles", 2}});
  bench.add("Jitter", {{"cycles", 1}});
  const std::vector<int> times = arrivals(bench, 2000);
  int later = 0;
  for (int i = 0; i < 2000; ++i) {
    const int delay = times[static_cast<std::size_t>(i)] - (i + 1);
    REQUIRE((delay == 2 || delay == 3));
    later += delay == 3;
  }
  CHECK(std::abs(later / 2000.0 - 0.5) < 0.06);
}

TEST_CASE("Dropout loses its share of percepts, each independently of the others") {
  Bench bench;
  bench.add("Dropout", {{"probability", 0.3}});
  constexpr int kCycles = 20000;
  std::vector<double> lost;
  for (int i = 0; i < kCycles; ++i) lost.push_back(bench.sense(1).empty());
  CHECK(std::abs(Sample(lost).mean - 0.3) < 0.014);
  CHECK(std::abs(autocorrelation(lost, 1)) < 0.03);
}

TEST_CASE("Dropout with probability 0 loses nothing, with 1 everything") {
  Bench bench;
  Leaf& dropout = bench.add("Dropout");
  for (int i = 0; i < 100; ++i) REQUIRE(bench.sense(1) == "(S 1.00)");
  setProperty(dropout, "probability", 1);
  for (int i = 0; i < 100; ++i) REQUIRE(bench.sense(1) == "");
  CHECK_THROWS_AS(setProperty(dropout, "probability", 1.1), Error);
}

TEST_CASE("A cycle without a percept draws no random number") {
  Bench one, other;
  for (Bench* b : {&one, &other}) {
    b->add("Dropout", {{"probability", 0.5}});
    b->add("Jitter", {{"cycles", 2}});
    b->add("WhiteNoise", {{"sigma", 1}});
  }
  const auto play = [](Bench& b, int interval) {
    std::vector<std::pair<int, std::string>> all;  // how late, and what
    for (int i = 0; i < 50; ++i)
      for (int k = 0; k < interval; ++k)
        if (const std::string percept = k == 0 ? b.sense(i) : b.senseNothing(); !percept.empty())
          all.emplace_back(k, percept);
    return all;
  };
  CHECK(play(one, 3) == play(other, 6));
}

TEST_CASE("The state of a chain is saved and restored, percepts under way included") {
  const auto make = [](Bench& b) {
    b.add("Bias", {{"sigma", 1}});
    b.add("RandomWalk", {{"sigma", 1}});
    b.add("WhiteNoise", {{"sigma", 1}});
    b.add("Backlash", {{"width", 0.5}});
    b.add("Dropout", {{"probability", 0.2}});
    b.add("Delay", {{"cycles", 3}});
    b.add("Jitter", {{"cycles", 2}});
  };
  Bench one, other;
  make(one), make(other);
  for (int i = 0; i < 37; ++i) one.sense(i);
  for (int i = 0; i < 11; ++i) other.sense(-i);
  CHECK(stateHash(*one.sensor) != stateHash(*other.sensor));
  StateWriter saved(true);
  saveTree(*one.sensor, saved);
  StateReader in(saved.bytes());
  loadTree(*other.sensor, in);
  CHECK(in.atEnd());
  CHECK(stateHash(*one.sensor) == stateHash(*other.sensor));
  other.event = one.event;
  for (int i = 0; i < 100; ++i) {
    one.sense(i), other.sense(i);
    REQUIRE(textOf(one.lists, 17) == textOf(other.lists, 17));
    REQUIRE(stateHash(*one.sensor) == stateHash(*other.sensor));
  }
}

TEST_CASE("A state with another number of percepts under way than it counts is refused") {
  Bench one;
  one.add("Delay", {{"cycles", 3}});
  one.sense(5);
  StateWriter saved(true);
  saveTree(*one.sensor, saved);
  std::string refused;
  for (std::size_t at = 0; at + 8 <= saved.bytes().size(); at += 8) {
    std::string bytes(saved.bytes());
    if (bytes.substr(at, 8) != std::string("\1\0\0\0\0\0\0\0", 8)) continue;
    bytes[at] = 2;
    Bench other;
    other.add("Delay", {{"cycles", 3}});
    try {
      StateReader in(bytes);
      loadTree(*other.sensor, in);
    } catch (const std::exception& e) {
      refused += e.what();
    }
  }
  CHECK_THAT(refused, Catch::Contains("expected the 2 lists of a delay, found 1"));
}
