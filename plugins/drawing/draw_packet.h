#pragma once
/// \file
/// The packets of the drawing port, as the installed base's viewer reads them. Several commands stand in a packet, each
/// a type, a subtype and what belongs to it:
///
///     0 0 name\0                              swap: shows what was drawn under names that begin so, begins anew
///     1 0 x y radius thickness rgb name\0     circle            1 3 x y z radius rgb name\0         sphere
///     1 1 x y z x y z thickness rgb name\0    line              1 4 n rgba n times (x y z) name\0   polygon
///     1 2 x y z size rgb name\0               point             2 0 x y z rgb text\0 name\0         text
///     2 1 agent rgb text\0                    text at an agent  2 2 agent                           no text there
///     3 0 agent                               the viewer is to select the agent: ignored here
///
/// Numbers are six ASCII characters, colours a byte each, agents their number - 1, with 128 added on the right.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "api/drawing.h"

namespace spark::drawing {

/// What one command says.
struct Command {
  enum class Kind { swap, draw, agentText, none } kind = Kind::none;
  std::string set;  ///< swap: how names begin; draw: the name
  Drawing drawing;  ///< agentText: with an empty text it takes the agent's away
};

/// Reads packets of outside origin: names and texts come out as short, valid UTF-8 without control characters, numbers
/// finite.
class PacketReader {
 public:
  static constexpr std::size_t kLongestName = 64, kLongestText = 128;  ///< bytes; what is longer is cut
  static constexpr float kFarthest = 1e5f;                             ///< m; what is farther out is no place

  explicit PacketReader(std::span<const std::byte> packet) : rest_(packet) {}
  /// The next command. False at the end and at what is none: then failed() says which.
  bool next(Command& out);
  /// The rest of the packet could not be read.
  bool failed() const { return failed_; }

 private:
  bool read(Command& out);
  bool readShape(std::uint8_t type, Drawing& out);
  bool readText(std::uint8_t type, Command& out);
  std::uint8_t byte();
  float number();
  float length();
  Vec3f point();
  Color color(bool alpha = false);
  std::string text(std::size_t longest);
  void readAgent(Drawing& out);

  std::span<const std::byte> rest_;
  bool failed_ = false;
};

/// As PacketReader leaves texts.
std::string cleanText(std::string_view bytes, std::size_t longest);

/// Appends the command that draws; for agentText the one that sets, or with an empty text takes away, the agent's text.
void writeDrawing(const Drawing& drawing, std::string_view set, std::string& out);
/// Appends the command that swaps.
void writeSwap(std::string_view prefix, std::string& out);

}  // namespace spark::drawing
