#pragma once
/// \file
/// Messages from viewers: one JSON object each.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace spark::web {

/// A message that was parsed and checked.
struct ViewerMessage {
  enum class What {
    view,      ///< sets `rate` and `fine`
    drawings,  ///< sets whether it gets drawings, `on`
    login,     ///< `text` is the referee's token
    command,   ///< `text` is a trainer command
    unwatch,   ///< ends watch `id`
    history,   ///< the piece of the past at `at`, or scene `scene`; without both, the outline
    request,   ///< any other: forwarded to the simulation thread
  } what = What::request;
  std::int64_t id = 0;
  double rate = 0;             ///< frames a second, kMinRate..kMaxRate; 0: unchanged
  std::optional<bool> fine{};  ///< empty: unchanged
  bool on = true;
  std::optional<double> at{};            ///< s, simulated; finite
  std::optional<std::uint32_t> scene{};  ///< number of a scene
  bool watch = false;                    ///< request: starts a watch
  std::string text;                      ///< request: the whole message
};

/// Maximum size of a message in bytes.
inline constexpr std::size_t kMaxMessageBytes = 16384;
/// Range of the rate that a viewer may request, in frames a second.
inline constexpr double kMinRate = 1, kMaxRate = 50;

/// Parses a message. Clamps numbers to their range. Throws Error with what was expected.
ViewerMessage readViewerMessage(std::string_view text);

}  // namespace spark::web
