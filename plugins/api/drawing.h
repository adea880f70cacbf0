#pragma once
/// \file
/// What agents draw for those who watch: shapes and texts in named sets.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/drawing.h"
#include "spark/node.h"

namespace spark {

/// A shape or text in the world [m].
struct Drawing {
  enum class Kind { circle, line, point, sphere, polygon, text, agentText } kind = Kind::point;
  std::vector<Vec3f>
      points;  ///< circle (on the ground), point, sphere, text: one; line: two; polygon: its corners; agentText: none
  float size = 0;       ///< circle, sphere: radius [m]; point: pixels
  float thickness = 1;  ///< circle, line: pixels
  Color color;
  std::string text;  ///< text, agentText: UTF-8
  int team = 0;      ///< agentText: of which team, 0 or 1; on the wire left and right
  int number = 0;    ///< agentText: of which agent in it, 1..128
};

/// The drawings, at /sys/server/drawing; used in the simulation's thread.
class IDrawings {
 public:
  SPARK_INTERFACE(IDrawings, 1);
  static constexpr const char* kPath = "/sys/server/drawing";
  virtual ~IDrawings() = default;

  /// What is shown under one name.
  struct Set {
    std::string name;             ///< UTF-8; unique
    std::uint64_t version = 0;    ///< of the drawings, when this set changed last
    std::vector<Drawing> shapes;  ///< none: the set is gone
  };
  /// Counts changes of what is shown.
  virtual std::uint64_t version() const = 0;
  /// In order of name. Valid until something is drawn.
  virtual std::span<const Set> sets() const = 0;
  /// Takes a packet in the format of the installed base's drawing port: shapes, texts, and the swap that shows them.
  /// Bad bytes end it and are counted; nothing is thrown.
  virtual void draw(std::span<const std::byte> packet) = 0;
  /// Appends the packets that bring a viewer which was told of version `since` to what is shown now, each as recorders
  /// of the installed base write them: `[0, 0, 97, 0]`. `since` 0: whatever that viewer shows. Nothing when nothing
  /// changed.
  virtual void record(std::uint64_t since, std::string& out) const = 0;
};

}  // namespace spark
