#pragma once
/// \file
/// What viewers say: one JSON object a message.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace spark::web {

/// A message that was understood.
struct ViewerMessage {
  enum class What {
    view,      ///< `rate` and `fine` from now on
    drawings,  ///< `on`
    login,     ///< `text` is the token
    command,   ///< `text` is for the trainer
    unwatch,   ///< `id`
    request,   ///< anything else: the simulation's thread knows
  } what = What::request;
  std::int64_t id = 0;
  double rate = 0;             ///< frames a second; 0: as it was
  std::optional<bool> fine{};  ///< none: as it was
  bool on = true;
  bool watch = false;  ///< request: begins a watch
  std::string text;    ///< request: the message itself
};

/// Bytes of a message that are taken at most.
inline constexpr std::size_t kLongestMessage = 16384;
/// Frames a second that a viewer may ask for.
inline constexpr double kSlowest = 1, kFastest = 50;

/// Reads a message. Throws Error that says what was expected; numbers out of range are brought into it.
ViewerMessage readViewerMessage(std::string_view text);

}  // namespace spark::web
