#pragma once
/// \file
/// The packets of the drawing port, in the format of RoboViz. A packet contains several commands, each a type, a
/// subtype and arguments:
///
///     0 0 name\0                              swap the buffers of all sets with this name prefix
///     1 0 x y radius thickness rgb name\0     circle            1 3 x y z radius rgb name\0         sphere
///     1 1 x y z x y z thickness rgb name\0    line              1 4 n rgba n times (x y z) name\0   polygon
///     1 2 x y z size rgb name\0               point             2 0 x y z rgb text\0 name\0         text
///     2 1 agent rgb text\0                    text at an agent  2 2 agent                           remove it
///     3 0 agent                               select the agent in the viewer: ignored here
///
/// Numbers are six ASCII characters, colours one byte per channel, agents their number - 1, plus 128 for the right
/// team.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "api/drawing.h"

namespace spark::drawing {

/// A command.
struct Command {
  enum class Kind { swap, draw, agentText, none } kind = Kind::none;
  std::string set;  ///< swap: prefix of the names; draw: the name
  Drawing drawing;  ///< draw, agentText; an empty agentText removes the agent's text
};

/// Reads untrusted packets: names and texts become short, valid UTF-8 without control characters; numbers are finite.
class PacketReader {
 public:
  static constexpr std::size_t kMaxNameBytes = 64, kMaxTextBytes = 128;  ///< longer ones are cut
  static constexpr float kMaxCoordinate = 1e5f;                          ///< m; a larger number is an error

  /// `packet` must outlive it.
  explicit PacketReader(std::span<const std::byte> packet) : rest_(packet) {}
  /// Reads the next command. False at the end of the packet and after an error; see failed().
  bool next(Command& out);
  /// True after an error.
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
  std::string text(std::size_t maxBytes);
  void readAgent(Drawing& out);

  std::span<const std::byte> rest_;
  bool failed_ = false;
};

/// The bytes as at most `maxBytes` of valid UTF-8: an invalid byte becomes "?", a control character a blank.
std::string cleanText(std::string_view bytes, std::size_t maxBytes);

/// Appends the command for a drawing. For agentText that is the command which sets, or with an empty text removes, the
/// agent's text.
void writeDrawing(const Drawing& drawing, std::string_view set, std::string& out);
/// Appends a swap command.
void writeSwap(std::string_view prefix, std::string& out);

}  // namespace spark::drawing
