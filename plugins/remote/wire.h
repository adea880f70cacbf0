#pragma once
/// \file
/// The connection of two hosts: messages over a stream, each a list of values.
///
/// A message is its length (32 bits, big-endian) and the bytes of a list (StateWriter), the first element of which
/// names its kind (messages.h).

#include <boost/asio/generic/stream_protocol.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "spark/error.h"
#include "spark/value.h"

namespace spark::remote {

/// The bytes of a message, without its length.
std::string encode(const List& message);
/// The other side does not speak as a host does.
class BadMessage : public Error {
 public:
  using Error::Error;
};
/// The message of these bytes. Throws Error if they are no list that begins with a text.
List decode(std::string_view bytes);
/// Element `index` of a message, which must have this type. Throws BadMessage if it has not.
const Value& at(const List& message, std::size_t index, Value::Type type);
/// The same for a text.
const std::string& textAt(const List& message, std::size_t index);
/// The same for an integer, as a number of a request, node or event.
std::uint64_t numberAt(const List& message, std::size_t index);

/// Sends and receives messages over a connected socket. Blocks in waitFor() only.
class Wire {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  /// `socket`: connected. `peer`: its address, for messages to people.
  Wire(Socket socket, std::string peer);

  /// The length of the longest message that is accepted [bytes], 64 KiB at first.
  void setLimit(std::size_t bytes) { limit_ = bytes; }
  /// Appends a message to what is to be sent.
  void send(const List& message);
  /// Sends as much as the peer takes now. False: the connection is broken.
  bool flush();
  /// The bytes that are still to be sent.
  std::size_t unsent() const { return out_.size() - sent_; }
  /// Reads what has arrived. False: the connection has ended; what came before can still be taken.
  bool receive();
  /// The next message that has arrived completely, without its length; valid until the next receive(). Throws Error if
  /// it is too long.
  std::optional<std::string_view> take();
  /// True if bytes have been read that were not taken yet, perhaps a message.
  bool holds() const { return taken_ < in_.size(); }
  /// Waits until something arrives, at most `seconds`. False: the time ran out.
  bool waitFor(double seconds);
  /// As of the system, for waiting.
  int descriptor() { return socket_.native_handle(); }
  const std::string& peer() const { return peer_; }

 private:
  Socket socket_;
  std::string peer_;
  std::string in_, out_;
  std::size_t taken_ = 0, sent_ = 0;  ///< bytes of in_ and out_ that are done
  std::size_t limit_ = 65536;
};

/// Where a host listens or is found: "127.0.0.1:3400", "[::1]:3400", or the path of a Unix socket, which has a '/'.
struct Address {
  std::string host, port;  ///< of TCP
  std::string path;        ///< of a Unix socket; empty: TCP
  /// Throws Error for other texts.
  static Address read(const std::string& text);
};

}  // namespace spark::remote
