#include <catch2/catch.hpp>
#include <map>

#include "patience.h"
#include "workers.h"

// Several simulations in one process and several threads must not influence each other through shared state.

using namespace sparkbatch;

namespace {
/// A match of two humanoids.
Options match() {
  Options options;
  options.config = "soccer.lua";
  options.settings = {
      {"team", "Red Blue"}, {"players", "1"}, {"Soccer.AutomaticKickOff", "true"}, {"Soccer.WaitBeforeKickOff", "0.4"}};
  options.duration = 1.6;
  return options;
}

/// The rows of the runs 1..n by number, without wall-clock times. Each run has its number as the seed.
std::map<int, Row> simulateAll(const Options& options, int n, int threads) {
  Workers workers(threads, [&options](const Run& run, RunControl& control) { return simulate(options, run, control); });
  std::map<int, Row> rows;
  int begun = 0;
  while (static_cast<int>(rows.size()) < n) {
    for (; begun < n && workers.idle() > 0; ++begun)
      workers.start({begun + 1, static_cast<std::uint64_t>(begun) + 1, {}});
    for (auto& result : workers.collect(std::chrono::seconds(1))) {
      REQUIRE(result);
      result->erase("cpuSeconds");
      result->erase("wallSeconds");
      rows[result->at("run").get<int>()] = *result;
    }
  }
  return rows;
}
}  // namespace

TEST_CASE("Simulations that run in parallel in one process give the same rows as alone") {
  const Options options = match();
  const auto together = simulateAll(options, 4, 3), alone = simulateAll(options, 4, 1);
  for (const auto& [number, row] : together) {
    CAPTURE(number, row.dump(), alone.at(number).dump());
    REQUIRE(row["end"] == "duration");
    REQUIRE(row["cycles"] == 80);
    REQUIRE(row == alone.at(number));
  }
  REQUIRE(alone.at(1)["stateHash"] != alone.at(2)["stateHash"]);
}

TEST_CASE("An abandoned simulation has no row, and its thread is free again") {
  Options options = match();
  options.duration = 0;
  Workers workers(2, [&options](const Run& run, RunControl& control) { return simulate(options, run, control); });
  workers.start({1, 1, {}});
  REQUIRE(workers.idle() == 1);
  while (workers.time() == 0) REQUIRE(workers.collect(std::chrono::milliseconds(5)).empty());
  workers.abandon();
  const auto results = workers.collect(spark::test::kPatience);
  REQUIRE(results.size() == 1);
  REQUIRE_FALSE(results.front());
  REQUIRE(workers.idle() == 2);
}
