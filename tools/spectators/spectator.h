#pragma once
/// \file
/// One viewer without a picture: takes the stream and counts what comes.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace spectators {

/// What all are told.
struct Settings {
  std::string host = "127.0.0.1";
  unsigned short port = 3280;
  double rate = 0;  ///< frames a second; 0: what the host gives
  std::string detail = "fine";
};

/// What came.
struct Tally {
  std::uint64_t bytes = 0;  ///< of messages and their heads
  std::uint64_t keys = 0, deltas = 0, texts = 0;
  std::uint64_t bad = 0;  ///< frames that do not follow the one before, and no frames at all
  bool closed = false;    ///< the host ended it
};

class Spectator {
 public:
  /// `stalled`: reads nothing behind the handshake.
  static std::shared_ptr<Spectator> make(boost::asio::io_context& io, const Settings& settings, bool stalled);
  virtual ~Spectator() = default;
  /// Connects; `watching` is called when the first frame came (stalled: when it is connected).
  virtual void start(std::function<void()> watching) = 0;
  virtual const Tally& tally() const = 0;
};

}  // namespace spectators
