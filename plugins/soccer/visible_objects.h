#pragma once
/// \file
/// The objects of the scene that vision can see, collected once for all eyes.

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "agent_state.h"
#include "api/agents.h"
#include "api/physics.h"

namespace spark::soccer {

/// The visible objects of the scene and their positions. The objects are collected again when the shape of the tree
/// changed, the positions updated once in each sense phase. All eyes share the instance of the settings; they read it
/// in the sense phase, possibly in several threads.
///
/// If an eye has a limited range, the robots are also sorted into a grid of square cells on the ground plane, so that
/// each eye tests only robots near it:
///
///        ─ ─ ┬───┬───┬───┬ ─ ─       Entries are sorted by row and column. For each row that its range overlaps, an
///            │   │ 4 │ 9 │           eye finds the first column by binary search and reads the columns in its range.
///        ─ ─ ┼───┼───┼───┼ ─ ─       The robots found are sorted by index, because percepts are in scene order.
///            │ 2 │(7)│   │
class VisibleObjects {
 public:
  /// A visible object.
  struct Object {
    const ObjectState* state;
    const Transform* frame = nullptr;  ///< the transform above `state`; nullptr: none
    IRigidBody* body = nullptr;        ///< of that transform
    Vec3f position = Vec3f::Zero();    ///< world frame [m]
  };
  /// A robot: its state and its visible parts. A robot without such parts is seen at the position of its state.
  struct Robot {
    AgentAspect* agent;
    AgentState* state = nullptr;
    const Transform* frame = nullptr;  ///< the transform above `state`
    IRigidBody* body = nullptr;        ///< of that transform
    Vec3f position = Vec3f::Zero();    ///< of `state`, world frame [m]
    std::uint32_t firstPart = 0, parts = 0;
  };
  /// A line of the field.
  struct FieldLine {
    const Line* line;
    Vec3f begin = Vec3f::Zero(), end = Vec3f::Zero();  ///< world frame [m]
  };
  static constexpr float kUnlimited = std::numeric_limits<float>::infinity();

  /// Updates objects and positions; in the simulation's thread. `range`: of the eye that calls it [m].
  void update(Kernel& kernel, float range = kUnlimited);
  /// Like update(), but only once for each `round`.
  void share(Kernel& kernel, std::uint64_t round, float range);

  /// Flags, goal posts and the ball, in scene order.
  std::span<const Object> field() const { return field_; }
  /// In scene order.
  std::span<const Robot> robots() const { return robots_; }
  /// The visible parts of a robot, in scene order.
  std::span<const Object> partsOf(const Robot& robot) const {
    return std::span(parts_).subspan(robot.firstPart, robot.parts);
  }
  /// In scene order.
  std::span<const FieldLine> lines() const { return lines_; }
  /// Upper bound of the number of points that an eye tests.
  std::size_t size() const { return field_.size() + robots_.size() + parts_.size() + 2 * lines_.size(); }
  /// The ball; nullptr if there is none.
  const Object* ball() const;
  /// The state of an agent (its outermost aspect); nullptr if it has none.
  AgentState* stateOf(const AgentAspect* agent) const;
  /// Sets `out` to the indices of robots of which any part may be within `range` [m] of `position`, in scene order.
  /// Includes all that are; may include others.
  void findNear(const Vec3f& position, float range, std::vector<std::uint32_t>& out) const;

 private:
  using Cell = std::uint64_t;                  ///< row in the upper 32 bits, column in the lower
  static constexpr float kMinCellSize = 0.1f;  ///< m

  void collect(Kernel& kernel);
  void updatePositions();
  void sortIntoCells();
  /// Row or column of a coordinate [m], saturated at both ends; NaN: 0.
  std::uint32_t cellOf(float coordinate) const;
  void findAll(std::vector<std::uint32_t>& out) const;

  TreeWatch tree_;
  std::uint64_t round_ = 0;
  std::vector<Object> field_, parts_;
  std::vector<Robot> robots_;
  std::vector<FieldLine> lines_;
  /// Sorted by address. Only for lookups: the order differs between runs.
  std::vector<std::pair<const AgentAspect*, AgentState*>> states_;
  float cellSize_ = kUnlimited;                        ///< edge of a cell [m]; infinite: there is no grid
  std::vector<std::pair<Cell, std::uint32_t>> cells_;  ///< cells with the robots in them, sorted
};

/// Position of a frame in the world frame [m]; the origin for nullptr.
inline Vec3f worldPosition(const Transform* frame) { return frame ? positionOf(frame->world()) : Vec3f(Vec3f::Zero()); }
/// Position of a node in the world frame [m].
inline Vec3f worldPosition(const SceneNode& node) { return worldPosition(node.transform()); }

}  // namespace spark::soccer
