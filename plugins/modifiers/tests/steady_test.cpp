#include <catch2/catch.hpp>

#include "allocations.h"
#include "lab.h"

// A chain of all modifiers allocates nothing once it is warm.

using namespace spark;
using namespace spark::test;

TEST_CASE("Agents with all modifiers allocate nothing in steady state") {
  const char* const all = R"(
      (nd Bias (setSigma 1)) (nd WhiteNoise (setSigma 1)) (nd RandomWalk (setSigma 1)) (nd Quantization (setStep 0.1))
      (nd Saturation (setMost 9)) (nd Gain (setGain 2)) (nd Backlash (setWidth 1)) (nd Dropout (setProbability 0.2))
      (nd Delay (setCycles 5)) (nd Jitter (setCycles 3)))";
  const std::string robot =
      "(nd CycleSensor (setName plain))(nd CycleSensor (setName a-sensor-with-a-long-name) {0})"
      "(nd Recorder (setName motor) {0})";
  Lab lab(fmt::format(fmt::runtime(robot), all), 3);
  // Actions are executed by the act phase of the cycle after the one in which they were thought of.
  const auto play = [&](int cycles) {
    int allocations = 0;
    for (int i = 0; i < cycles; ++i) {
      Allocations::on = false;
      for (Speaker* s : lab.speakers) s->next = "(motor 1.5)(motor -2)";
      for (int agent = 1; agent <= 3; ++agent) static_cast<Recorder&>(lab.part("motor", agent)).done.clear();
      allocations += Allocations::in([&] { lab.run(1); });
    }
    return allocations;
  };
  play(300);
  const int without = [&] {
    Lab plain(fmt::format(fmt::runtime(robot), ""), 3);
    plain.run(300);
    return Allocations::in([&] { plain.run(1); });
  }();
  CHECK(play(300) == 300 * without);  // what the call of the method allocates
}
