#include "dialogue.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace spark::bench {

namespace {
constexpr std::array<const char*, 24> kMotors{"he1",  "he2",  "rae1", "rae2", "rae3", "rae4", "lae1", "lae2",
                                              "lae3", "lae4", "rle1", "rle2", "rle3", "rle4", "rle5", "rle6",
                                              "lle1", "lle2", "lle3", "lle4", "lle5", "lle6", "rle7", "lle7"};
constexpr std::size_t kMotorsWithoutToes = 22;
constexpr int kToedType = 4, kTypes = 5;
constexpr std::size_t kDirections = 10;  // number of directions in which spheres drive
constexpr const char* kSync = "(syn)";

double angle(std::int64_t n) { return 2 * std::numbers::pi * static_cast<double>(n % kPeriod) / kPeriod; }
double printed(double v) { return std::round(100 * v) / 100; }

using Period = std::array<std::string, kPeriod>;

Period swings(std::size_t motors) {
  Period out;
  for (int n = 0; n < kPeriod; ++n) {
    for (std::size_t i = 0; i < motors; ++i)
      out[n] += fmt::format("({} {:.2f})", kMotors[i], motorSpeed(static_cast<int>(i), n));
    out[n] += kSync;
  }
  return out;
}

Period drives(std::size_t direction) {
  Period out;
  for (int n = 0; n < kPeriod; ++n)
    out[n] = fmt::format("(drive {:.2f} {:.2f} 0){}", drivePower(direction, n, 0), drivePower(direction, n, 1), kSync);
  return out;
}

const Period& motions(const World& world, std::size_t agent) {
  static const std::array<Period, 2> walks{swings(kMotorsWithoutToes), swings(kMotors.size())};
  static const std::array<Period, kDirections> ways = [] {
    std::array<Period, kDirections> all;
    for (std::size_t i = 0; i < kDirections; ++i) all[i] = drives(i);
    return all;
  }();
  return world.humanoid() ? walks[agent % kTypes == kToedType ? 1 : 0] : ways[agent % kDirections];
}
}  // namespace

int motorIndex(std::string_view effector) {
  for (std::size_t i = 0; i < kMotors.size(); ++i)
    if (effector == kMotors[i]) return static_cast<int>(i);
  return -1;
}

double motorSpeed(int i, std::int64_t n) { return printed(0.8 * std::sin(angle(n) + 0.7 * i)); }

double drivePower(std::size_t agent, std::int64_t n, int axis) {
  const double a = angle(n) + 2 * std::numbers::pi * static_cast<double>(agent % kDirections) / kDirections;
  return printed(60 * (axis == 0 ? std::cos(a) : std::sin(a)));
}

Dialogue::Dialogue(const World& world, std::size_t agent)
    : world_(world),
      agent_(agent),
      begin_(kJoinCycles * (world.humanoid() ? world.count - static_cast<std::int64_t>(agent) : 1) + kSettleCycles) {
  if (world.motion == World::Motion::heap) begin_ += kHeapCycles;
  motions(world, agent);
}

/// Humanoids fill the left team first; spheres join both teams alternately.
std::string Dialogue::init() const {
  const std::size_t number = world_.humanoid() ? agent_ % 11 : agent_ / 2;
  const bool left = world_.humanoid() ? agent_ < 11 : agent_ % 2 == 0;
  return fmt::format("(init (unum {})(teamname {})){}", number + 1, left ? "Left" : "Right", kSync);
}

/// A position in the team's own half: four columns, three rows.
std::string Dialogue::beam() const {
  const auto column = static_cast<double>(agent_ % 11 % 4), row = static_cast<double>(agent_ % 11 / 4);
  return fmt::format("(beam {:.2f} {:.2f} 0){}", -(2 + 2.4 * column), 4 * (row - 1) + 0.3 * column, kSync);
}

std::string_view Dialogue::say(std::int64_t received) {
  if (received == 0)
    text_ = world_.humanoid() ? fmt::format("(scene rsg/agent/nao/nao_hetero.rsg {}){}", agent_ % kTypes, kSync)
                              : fmt::format("(scene rsg/agent/sphere.rsg){}", kSync);
  else if (received == 1)
    text_ = init();
  else if (received == 4 && world_.humanoid())
    text_ = beam();
  else if (world_.motion == World::Motion::rest || received < begin_)
    return kSync;
  else
    return motions(world_, agent_)[static_cast<std::size_t>((received - begin_) % kPeriod)];
  return text_;
}

}  // namespace spark::bench
