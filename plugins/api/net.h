#pragma once
/// \file
/// Connections. The network server (`/sys/server/net`) has ports below it; each port has a framing below it, and
/// perhaps a parser. A port delivers whole messages to its consumer, in the simulation's thread, during
/// IInputSource::poll() and wait().

#include <cstdint>
#include <string>
#include <string_view>

#include "spark/abi/api/net.h"
#include "spark/node.h"

namespace spark {

/// The connection of one client. Owned by its port; destroyed after IConnectionConsumer::disconnected() returned.
class IConnection {
 public:
  virtual ~IConnection() = default;
  /// Unique within the port; never reused.
  virtual std::uint64_t id() const = 0;
  /// Address of the client: "127.0.0.1:4711".
  virtual const std::string& peer() const = 0;
  /// The port node, for instance to look for a parser below it.
  virtual Node& port() = 0;
  /// Frames and sends a message. Returns false when an earlier message is still in the send buffer: the message is
  /// dropped and counted. Never blocks.
  virtual bool send(std::string_view message) = 0;
  /// True when the send buffer is empty.
  virtual bool idle() const = 0;
  /// Seconds since the client last accepted a byte of the send buffer; 0 when idle.
  virtual double stalledSeconds() const = 0;
  /// Closes the connection and logs the reason; disconnected() follows at the next poll.
  virtual void close(std::string_view reason) = 0;
};

/// The receiver of a port's messages: game control, the monitor server, a test.
class IConnectionConsumer {
 public:
  SPARK_INTERFACE(IConnectionConsumer, 1);
  virtual ~IConnectionConsumer() = default;
  /// A client has connected.
  virtual void connected(IConnection& connection) = 0;
  /// A whole message has arrived, framing removed. `message` is valid during the call.
  virtual void received(IConnection& connection, std::string_view message) = 0;
  /// The client has disconnected or was closed; `connection` is destroyed after the call.
  virtual void disconnected(IConnection& connection) = 0;
};

/// Cuts a byte stream into messages. A child of a port.
class IFraming {
 public:
  SPARK_INTERFACE(IFraming, 1);
  virtual ~IFraming() = default;
  /// Result of take().
  struct Frame {
    enum class Status {
      message,  ///< a whole message
      more,     ///< the message is not complete yet
      bad       ///< no message of this framing, or one that is too long
    } status = Status::more;
    std::size_t consumed = 0;  ///< bytes to remove from the start
    std::string_view message;  ///< a view into the bytes
    std::string why;           ///< bad: the reason, one sentence
  };
  /// Looks for a message at the start of the received bytes. `limit`: length of the longest allowed message [bytes].
  virtual Frame take(std::string_view bytes, std::size_t limit) = 0;
  /// Appends `message` with its framing to `out`.
  virtual void frame(std::string_view message, std::string& out) = 0;
};

}  // namespace spark
