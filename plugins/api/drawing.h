#pragma once
/// \file
/// Drawings of agents for viewers: shapes and texts in named sets.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/drawing.h"
#include "spark/node.h"

namespace spark {

/// A shape or text in the world frame [m].
struct Drawing {
  enum class Kind { circle, line, point, sphere, polygon, text, agentText } kind = Kind::point;
  /// circle (parallel to the ground), point, sphere, text: one; line: two; polygon: its corners; agentText: none.
  std::vector<Vec3f> points;
  float size = 0;       ///< circle, sphere: radius [m]; point: size [pixels]
  float thickness = 1;  ///< circle, line [pixels]
  Color color;
  std::string text;  ///< text, agentText: UTF-8
  int team = 0;      ///< agentText: the agent's team, 0 or 1; on the wire left and right
  int number = 0;    ///< agentText: the agent's number in its team, 1..128
};

/// The drawing server, at /sys/server/drawing. Used in the simulation's thread.
class IDrawings {
 public:
  SPARK_INTERFACE(IDrawings, 1);
  static constexpr const char* kPath = "/sys/server/drawing";
  virtual ~IDrawings() = default;

  /// The shapes that are shown under one name.
  struct Set {
    std::string name;             ///< UTF-8; unique
    std::uint64_t version = 0;    ///< version() after the last change of this set
    std::vector<Drawing> shapes;  ///< empty: the set was removed
  };
  /// Number of changes of the sets so far.
  virtual std::uint64_t version() const = 0;
  /// All sets, sorted by name. Valid until the next draw().
  virtual std::span<const Set> sets() const = 0;
  /// Executes a packet in the format of the installed base's drawing port: shapes, texts, and the buffer swap that
  /// shows them. Malformed bytes end the packet and are counted. Does not throw.
  virtual void draw(std::span<const std::byte> packet) = 0;
  /// Appends the packets that bring a viewer from version `since` to the current one, each as recorders of the
  /// installed base write them: `[0, 0, 97, 0]`. `since` 0: from an unknown version. Appends nothing when nothing
  /// changed.
  virtual void record(std::uint64_t since, std::string& out) const = 0;
};

}  // namespace spark
