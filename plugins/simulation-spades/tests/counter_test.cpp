#include <catch2/catch.hpp>
#include <cerrno>

#include "../instruction_counter.h"
#include "test_support.h"

using namespace spark;
using namespace spark::spades;

TEST_CASE("instructions are counted, or it says why they cannot be") {
  const std::string lacks = InstructionCounter::lacks();
  if (!lacks.empty()) {
    REQUIRE_THROWS_WITH(InstructionCounter(0), lacks);
    return;
  }
  const InstructionCounter counter(0);
  const double before = counter.count();
  volatile int n = 0;
  for (int i = 0; i < 1'000'000; ++i) n = n + i;
  REQUIRE(counter.count() - before > 1e6);
}

TEST_CASE("the reason names what is missing and what to use instead") {
  CHECK(InstructionCounter::lacks(0).empty());
  CHECK(
      InstructionCounter::lacks(ENOENT) ==
      "this machine cannot count the instructions of programs, as most virtual machines (perf_event_open: No such file "
      "or directory); use CpuThinkTime, or the timer 'jiffies', instead");
  CHECK(InstructionCounter::lacks(EACCES) ==
        "this user may not count the instructions of programs (perf_event_open: Permission denied); set "
        "/proc/sys/kernel/perf_event_paranoid to 2 or less, or use CpuThinkTime, or the timer 'jiffies', instead");
}

TEST_CASE("a counter that ran for a part of the time is scaled") {
  CHECK(InstructionCounter::scaled(1000, 500, 500) == 1000);
  CHECK(InstructionCounter::scaled(1000, 500, 250) == 2000);
  CHECK(InstructionCounter::scaled(0, 500, 0) == 0);
}
