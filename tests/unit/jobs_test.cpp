#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <thread>

#include "spark/kernel.h"

using spark::Jobs;

TEST_CASE("Every job runs exactly once with any number of threads") {
  for (const int threads : {1, 2, 4, 8}) {
    Jobs jobs;
    jobs.setThreads(threads);
    CHECK(jobs.threads() == threads);
    for (const std::size_t n : {0u, 1u, 2u, 3u, 1000u}) {
      std::vector<int> counts(n, 0);
      jobs.run(n, [&](std::size_t i) { ++counts[i]; });
      CHECK(std::accumulate(counts.begin(), counts.end(), std::size_t{0}) == n);
      CHECK(std::all_of(counts.begin(), counts.end(), [](int c) { return c == 1; }));
    }
  }
}

TEST_CASE("A round of jobs ends before the next one starts") {
  // With a core for each thread, the threads spin for the next round. With many more threads than cores, they sleep at
  // once and often wake up too late for it.
  const int threads = GENERATE(2, 4, 40);
  Jobs jobs;
  jobs.setThreads(threads);
  std::vector<std::uint64_t> cells(64, 0);
  for (std::uint64_t round = 1; round <= 1000; ++round) {
    jobs.run(cells.size(), [&](std::size_t i) { cells[i] = cells[i] + 1; });
    REQUIRE(std::all_of(cells.begin(), cells.end(), [&](std::uint64_t c) { return c == round; }));
  }
}

TEST_CASE("The number of threads may change between rounds") {
  Jobs jobs;
  std::atomic<int> total{0};
  for (const int threads : {3, 1, 2, 0, -1, 5}) {
    jobs.setThreads(threads);
    CHECK(jobs.threads() == std::max(1, threads));
    jobs.run(100, [&](std::size_t) { ++total; });
  }
  CHECK(total == 600);
  jobs.setThreads(1000);
  CHECK(jobs.threads() == 64);
}

TEST_CASE("A log is written from many threads at once, line by line") {
  spark::Kernel kernel;
  std::set<std::string> lines;
  kernel.log().setSink([&](spark::Level, std::string_view line) { lines.emplace(line); });
  kernel.jobs().setThreads(4);
  kernel.jobs().run(200, [&](std::size_t i) { kernel.log().info("line {} ends", i); });
  CHECK(lines.size() == 200);
  CHECK(lines.count("line 199 ends") == 1);
}

TEST_CASE("Kernels in different threads do not disturb each other") {
  std::vector<std::thread> threads;
  std::atomic<int> made{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 5; ++i) {
        spark::Kernel kernel;
        made += kernel.create("Node", "/usr/x").path() == "/usr/x";
      }
    });
  for (std::thread& t : threads) t.join();
  CHECK(made == 20);
}
