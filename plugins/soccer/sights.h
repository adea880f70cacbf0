#pragma once
/// \file
/// What there is to be seen in the scene: one look at it for all eyes.

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "agent_state.h"
#include "api/agents.h"

namespace spark::soccer {

/// The visible objects of the scene, collected when the shape of the tree changed, and where they are, brought up to
/// date once a sense phase. Eyes of a league share the one of its settings: they read it in the sense phase, possibly
/// in several threads.
///
/// For eyes that see so far and no farther the robots are sorted into square cells of the ground plane, so that each
/// looks at what is near:
///
///        ─ ─ ┬───┬───┬───┬ ─ ─       sorted by row and column; an eye takes from each row that its range meets
///            │   │ 4 │ 9 │           the run of columns that it meets: a search a row. What it finds it sorts
///        ─ ─ ┼───┼───┼───┼ ─ ─       by robot, since percepts come in scene order, whoever is near
///            │ 2 │(7)│   │
class Sights {
 public:
  /// Something visible.
  struct Mark {
    const ObjectState* object;
    const Transform* frame = nullptr;  ///< the transform above it, nullptr for none
    Vec3f place = Vec3f::Zero();       ///< in the world [m]
  };
  /// A robot: its state, and the marked parts (none: it is seen by its state alone).
  struct Robot {
    AgentAspect* agent;
    AgentState* state = nullptr;
    const Transform* frame = nullptr;  ///< the transform above the state
    Vec3f place = Vec3f::Zero();       ///< of the state [m]
    std::uint32_t firstPart = 0, parts = 0;
  };
  /// A line of the field.
  struct Stroke {
    const Line* line;
    Vec3f begin = Vec3f::Zero(), end = Vec3f::Zero();  ///< in the world [m]
  };
  static constexpr float kUnlimited = std::numeric_limits<float>::infinity();

  /// Brings all up to date, in the simulation's thread; `range`: how far who asks can see [m].
  void update(Kernel& kernel, float range = kUnlimited);
  /// As update, but once for each `round`.
  void share(Kernel& kernel, std::uint64_t round, float range);

  /// Flags, goals, ball, in scene order.
  std::span<const Mark> field() const { return field_; }
  /// In scene order.
  std::span<const Robot> robots() const { return robots_; }
  std::span<const Mark> partsOf(const Robot& robot) const {
    return std::span(parts_).subspan(robot.firstPart, robot.parts);
  }
  std::span<const Stroke> lines() const { return lines_; }
  /// Number of all points that may be seen.
  std::size_t size() const { return field_.size() + robots_.size() + parts_.size() + 2 * lines_.size(); }
  /// The ball's mark, nullptr where there is no ball.
  const Mark* ball() const;
  /// What the match knows of an agent, nullptr when it knows nothing.
  AgentState* stateOf(const AgentAspect* agent) const;
  /// Indices of the robots of which something may be within `range` [m] of `place`, in scene order; all where there is
  /// no limit.
  void near(const Vec3f& place, float range, std::vector<std::uint32_t>& out) const;

 private:
  using Cell = std::uint64_t;                ///< row and column
  static constexpr float kLeastCell = 0.1f;  ///< m

  void collect(Kernel& kernel);
  void place();
  void sortIntoCells();
  std::uint32_t cellOf(float coordinate) const;
  void all(std::vector<std::uint32_t>& out) const;

  TreeWatch tree_;
  std::uint64_t round_ = 0;
  std::vector<Mark> field_, parts_;
  std::vector<Robot> robots_;
  std::vector<Stroke> lines_;
  std::vector<std::pair<const AgentAspect*, AgentState*>> states_;  ///< by address, to look up only
  float cell_ = kUnlimited;                                         ///< edge of a cell [m]
  std::vector<std::pair<Cell, std::uint32_t>> cells_;               ///< cell and robot
};

/// World position of a frame; the scene's origin for none.
inline Vec3f placeOf(const Transform* frame) { return frame ? positionOf(frame->world()) : Vec3f(Vec3f::Zero()); }
/// World position of a node.
inline Vec3f placeOf(const SceneNode& node) { return placeOf(node.transform()); }

}  // namespace spark::soccer
