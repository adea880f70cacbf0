#pragma once
/// \file
/// Messages over sockets, each behind a length of four bytes, big-endian.

#include <poll.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spark::spades {

/// Two sockets that do not block, or one for both directions. Owns them. One thread.
class FrameStream {
 public:
  /// Most bytes that wait for the other side to read, and longest message from it.
  static constexpr std::size_t kMost = 1 << 20;

  /// `input` and `output` may be the same. They are set not to block.
  FrameStream(int input, int output);
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  /// Sends a message, as far as the other side reads; the rest later.
  void send(std::string_view message);
  /// Sends what is unsent, and reads what has come. Does not wait.
  void poll();
  /// The next message that has come; valid until the next poll().
  std::optional<std::string_view> receive();
  /// Why nothing more will come; "": it is open.
  const std::string& lost() const { return lost_; }
  /// The descriptors to wait for: input always, output while something is unsent, else -1.
  int input() const { return input_; }
  int output() const { return out_.empty() ? -1 : output_; }
  /// Appends the descriptors to wait for: none if it is lost, since a closed one would be ready all the time.
  void addDescriptors(std::vector<pollfd>& out) const;

 private:
  void fail(std::string why) {
    if (lost_.empty()) lost_ = std::move(why);
  }
  void flush();
  const int input_, output_;
  std::string out_, in_, lost_;
  std::size_t read_ = 0;  ///< bytes of in_ that were received as messages
};

}  // namespace spark::spades
