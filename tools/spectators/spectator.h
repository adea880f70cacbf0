#pragma once
/// \file
/// A viewer without display: receives the stream and counts frames and bytes.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace spectators {

/// Settings of all spectators.
struct Settings {
  std::string host = "127.0.0.1";
  unsigned short port = 3280;
  double rate = 0;              ///< wanted frames per second; 0: the host's default
  std::string detail = "fine";  ///< "fine" or "coarse"
};

/// Counts of what was received.
struct Tally {
  std::uint64_t bytes = 0;  ///< of messages and their headers
  std::uint64_t keys = 0, deltas = 0, texts = 0;
  std::uint64_t bad = 0;  ///< malformed messages, and frames that do not follow the previous one
  bool closed = false;    ///< the host closed the connection
};

/// A connection of a viewer. Its handlers run in the thread of the io_context.
class Spectator {
 public:
  /// `stalled`: does not read after the handshake.
  static std::shared_ptr<Spectator> make(boost::asio::io_context& io, const Settings& settings, bool stalled);
  virtual ~Spectator() = default;
  /// Connects. Calls `watching` after the first frame, or after the handshake if the spectator is stalled.
  virtual void start(std::function<void()> watching) = 0;
  virtual const Tally& tally() const = 0;
};

}  // namespace spectators
