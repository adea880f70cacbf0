#pragma once
/// \file
/// Connections: a network server (`/sys/server/net`) with ports below it, a framing (and perhaps a parser) below each
/// port. A port delivers whole messages to its consumer, in the simulation's thread, during IInputSource::poll and
/// wait.

#include <cstdint>
#include <string>
#include <string_view>

#include "spark/abi/api/net.h"
#include "spark/node.h"

namespace spark {

/// One client. Owned by its port; gone after IConnectionConsumer::disconnected returned.
class IConnection {
 public:
  virtual ~IConnection() = default;
  /// Never used again within a port.
  virtual std::uint64_t id() const = 0;
  /// "127.0.0.1:4711".
  virtual const std::string& peer() const = 0;
  /// The port node, e.g. to look for a parser below it.
  virtual Node& port() = 0;
  /// Frames and sends a message, or drops and counts it when an earlier one has not left yet; returns false then. Never
  /// blocks.
  virtual bool send(std::string_view message) = 0;
  /// True when nothing is waiting to leave.
  virtual bool idle() const = 0;
  /// Seconds since the client last took a byte that was waiting for it; 0 when idle.
  virtual double stalledSeconds() const = 0;
  /// Closes with a line in the log; disconnected() follows at the next poll.
  virtual void close(std::string_view reason) = 0;
};

/// What a port delivers to: game control, the monitor server, a test.
class IConnectionConsumer {
 public:
  SPARK_INTERFACE(IConnectionConsumer, 1);
  virtual ~IConnectionConsumer() = default;
  virtual void connected(IConnection& connection) = 0;
  /// One whole message, framing removed. Valid during the call.
  virtual void received(IConnection& connection, std::string_view message) = 0;
  virtual void disconnected(IConnection& connection) = 0;
};

/// Cuts a byte stream into messages; a helper below a port.
class IFraming {
 public:
  SPARK_INTERFACE(IFraming, 1);
  virtual ~IFraming() = default;
  /// What take() found at the start of the bytes.
  struct Frame {
    enum class Status { message, more, bad } status = Status::more;
    std::size_t consumed = 0;  ///< bytes to drop
    std::string_view message;  ///< a view into the bytes
    std::string why;           ///< bad: one sentence
  };
  /// Looks at the bytes received so far; `limit`: the longest message [bytes].
  virtual Frame take(std::string_view bytes, std::size_t limit) = 0;
  /// Appends the framed message.
  virtual void frame(std::string_view message, std::string& out) = 0;
};

}  // namespace spark
