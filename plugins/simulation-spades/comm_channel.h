#pragma once
/// \file
/// Messages between the simulator and a communication server, over connections that may break and come back.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frame_stream.h"

namespace spark::spades {

/// Numbered messages in both directions, none lost and none twice. Each side keeps what the other one has not
/// acknowledged, and sends it again on the next connection. A connection begins with a hello of the communication
/// server and a welcome; then frames are `M<message>`, or `K<count>`: so many messages were received.
class CommChannel {
 public:
  /// Goes on with a new connection, on which the other side said that it has received `received` messages.
  void attach(std::unique_ptr<FrameStream> stream, std::uint64_t received);
  /// Sends a message, now or on the next connection.
  void send(std::string message);
  /// Exchanges what has come. Does not wait.
  void poll();
  /// The next message.
  std::optional<std::string> receive();
  /// Messages received so far, for the hello or the welcome.
  std::uint64_t received() const { return received_; }
  /// Ends the connection, not the conversation.
  void close(std::string why);
  bool connected() const { return stream_ != nullptr; }
  /// Why the last connection ended.
  const std::string& lost() const { return lost_; }
  /// nullptr: not connected.
  const FrameStream* stream() const { return stream_.get(); }

 private:
  void acknowledge();
  void acknowledged(std::uint64_t count);
  std::unique_ptr<FrameStream> stream_;
  std::deque<std::string> kept_;           ///< frames that are not acknowledged
  std::deque<std::string> arrived_;        ///< not received by the caller yet
  std::uint64_t keptFrom_ = 0;             ///< number of the first of kept_
  std::uint64_t received_ = 0, told_ = 0;  ///< received, and acknowledged
  std::string lost_;
};

/// The first frame of a connection, from the communication server.
struct CommHello {
  static constexpr std::string_view kVersion = "spark-comm 2";
  std::string session;  ///< random, the same on each connection
  std::uint64_t received = 0;
  std::string token, name;
  std::vector<std::pair<std::string, std::string>> types;  ///< agent types of its database, and their timers

  std::string write() const;
  /// Throws Error if it is none, or of another version.
  static CommHello read(std::string_view frame);
};

/// The answers to it: `W<received>` or `R<why>`.
inline constexpr char kWelcome = 'W', kRefused = 'R';

/// A word and the rest of a message: ("to", "3 S1 11 ").
std::pair<std::string_view, std::string_view> splitWord(std::string_view text);
/// A number at the start of a word; throws Error if it is none.
std::uint64_t numberOf(std::string_view word);

}  // namespace spark::spades
