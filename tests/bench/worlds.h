#pragma once
/// \file
/// The standard worlds that are measured.

#include <string>
#include <string_view>
#include <vector>

namespace spark::bench {

/// A named world: its contents and how they move.
struct World {
  enum class Kind { field, humanoids, spheres, boxes } kind = Kind::field;
  /// Humanoids only. rest: they stand and get no commands. moving: all motors swing, and some may fall. heap: the same
  /// on top of each other.
  enum class Motion { rest, moving, heap } motion = Motion::rest;
  std::string name, title;
  int count = 0;     ///< humanoids, spheres or boxes
  int cycles = 400;  ///< number measured by default

  /// Number of agents.
  int agents() const { return kind == Kind::humanoids || kind == Kind::spheres ? count : 0; }
  bool humanoid() const { return kind == Kind::humanoids; }
};

/// All worlds, in the order of the table.
const std::vector<World>& worlds();
/// The one of that name, which must exist.
const World& worldOf(std::string_view name);

}  // namespace spark::bench
