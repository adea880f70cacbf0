#pragma once
/// \file
/// A client of a port, with its input that is not split into messages yet and its unsent output.
///
/// Callbacks of Asio only record that a socket became readable or writable. Bytes are read when the port calls read(),
/// in the port's order: the order of delivery depends on what has arrived, not on the order in which the operating
/// system reports it.

#include <boost/asio/generic/stream_protocol.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "api/net.h"
#include "net-tcp/handler_memory.h"

namespace spark {
class StreamPort;
}

namespace spark::net {

/// The sockets of all transports: TCP, Unix.
using Stream = boost::asio::generic::stream_protocol;
using Clock = std::chrono::steady_clock;

/// Owned by its StreamPort and by its pending waits. Simulation thread only.
class StreamConnection final : public IConnection, public std::enable_shared_from_this<StreamConnection> {
 public:
  /// Result of read().
  enum class Read {
    nothing,  ///< no input
    some,     ///< the buffer is full; there may be more
    all,      ///< the buffer is not full: all available input was read
    ended,    ///< the client closed the connection or it failed
  };

  /// A client that was accepted. `peer`: its address. `delaysAcks`: its system waits for acknowledgements, as TCP does.
  struct Accepted {
    Stream::socket socket;
    std::string peer;
    bool delaysAcks = false;
  };
  /// `id`: unique within the port. `port` must outlive it.
  StreamConnection(Accepted accepted, std::uint64_t id, StreamPort& port);

  std::uint64_t id() const override { return id_; }
  const std::string& peer() const override { return peer_; }
  Node& port() override;
  bool send(std::string_view message) override;
  bool idle() const override { return written_ == out_.size(); }
  double stalledSeconds() const override;
  /// Seconds of wall time since the client last accepted a byte of the unsent output or completed a message; 0 if there
  /// is no unsent output.
  double quietSeconds(Clock::time_point now) const;
  void close(std::string_view reason) override;

  /// Closes the socket; the port calls IConnectionConsumer::disconnected() later.
  void shut();
  /// True if read() may find input.
  bool readable() const { return readable_; }
  /// True after close() or shut().
  bool closing() const { return closing_; }
  /// Reads once, at most scratch.size() bytes, and appends them to input(). Does not block.
  Read read(std::string& scratch);
  /// Acknowledges what was read, unless output has done so since. Without it the system waits up to 40 ms for output
  /// that carries the acknowledgement, and a client with Nagle's algorithm, which is the default, holds back its next
  /// bytes for as long.
  void acknowledge();
  /// Received bytes that are not consumed yet.
  const std::string& input() const { return input_; }
  /// Removes bytes from the front of input().
  void consume(std::size_t bytes);
  /// True if it has ever sent a complete message.
  bool spoken() const { return spoken_; }
  /// Records that it has sent a complete message.
  void markSpoken();
  /// Records whether the input ends with an incomplete message, for partialSeconds().
  void markPartial(bool partial);
  /// Seconds of wall time since the incomplete message began; 0 if there is none.
  double partialSeconds(Clock::time_point now) const;

 private:
  void watchRead();
  void watchWrite();
  /// Notes that input came in more than one piece since the last output.
  void markPieces();
  /// Notes that output was sent: it carries the acknowledgement.
  void markOutput();
  /// Writes unsent output as far as the system takes it; false if the connection failed.
  bool flush();

  Stream::socket socket_;
  StreamPort& port_;
  const std::uint64_t id_;
  std::string peer_, input_;
  std::string out_;          ///< the framed message that is being sent
  std::size_t written_ = 0;  ///< bytes of `out_` that are sent
  HandlerMemory readMemory_, writeMemory_;
  Clock::time_point stalledSince_{};  ///< when a byte was sent last
  Clock::time_point heardAt_{};       ///< when it last completed a message while output was unsent
  Clock::time_point partialSince_{};  ///< when the incomplete message began
  bool readable_ = true, closing_ = false, partial_ = false, watchingWrite_ = false, spoken_ = false;
  static constexpr int kRegular = 100;
  bool unanswered_ = false;  ///< bytes were read, and nothing was sent since
  const bool delaysAcks_;
  bool owesAck_ = false;   ///< they are not acknowledged
  bool inPieces_ = false;  ///< it sends more than one piece per output: each is acknowledged at once
  int regular_ = 0;        ///< outputs since it last did; after kRegular it counts as a client that does not
};

}  // namespace spark::net
