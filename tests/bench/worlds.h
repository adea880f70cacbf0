#pragma once
/// \file
/// The standard worlds: what everybody's figures speak of.

#include <string>
#include <vector>

namespace spark::bench {

/// A world by name: what stands in it and what that does.
struct World {
  enum class Kind { field, humanoids, spheres, boxes } kind = Kind::field;
  /// Humanoids only: upright without a command; upright, or fallen meanwhile, with all motors swinging; the same on top
  /// of each other.
  enum class Motion { rest, moving, heap } motion = Motion::rest;
  std::string name, title;
  int count = 0;     ///< humanoids, spheres or boxes
  int cycles = 400;  ///< measured by default

  /// Agents in it.
  int agents() const { return kind == Kind::humanoids || kind == Kind::spheres ? count : 0; }
  bool humanoid() const { return kind == Kind::humanoids; }
};

/// All of them, in the order of the table.
const std::vector<World>& worlds();

}  // namespace spark::bench
