#include "frame_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace spark::spades {

namespace {
constexpr std::size_t kPrefix = 4;
}

FrameStream::FrameStream(int input, int output) : input_(input), output_(output) {
  for (const int end : {input_, output_}) ::fcntl(end, F_SETFL, ::fcntl(end, F_GETFL) | O_NONBLOCK);
}

FrameStream::~FrameStream() {
  ::close(input_);
  if (output_ != input_) ::close(output_);
}

void FrameStream::addDescriptors(std::vector<pollfd>& out) const {
  if (!lost_.empty()) return;
  out.push_back({input_, POLLIN, 0});
  if (!out_.empty()) out.push_back({output_, POLLOUT, 0});
}

void FrameStream::send(std::string_view message) {
  if (!lost_.empty()) return;
  if (out_.size() + message.size() > kMost) return fail("it does not read its messages");
  for (int shift = 24; shift >= 0; shift -= 8) out_ += static_cast<char>(message.size() >> shift);
  out_ += message;
  flush();
}

void FrameStream::flush() {
  while (!out_.empty()) {
    const ssize_t n = ::send(output_, out_.data(), out_.size(), MSG_NOSIGNAL);
    if (n > 0) {
      out_.erase(0, static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      return fail(fmt::format("it is closed: {}", std::strerror(errno)));
    }
  }
}

void FrameStream::poll() {
  if (!lost_.empty()) return;
  flush();
  in_.erase(0, std::exchange(read_, 0));
  std::array<char, 16384> buffer;
  while (lost_.empty() && in_.size() <= kMost) {
    const ssize_t n = ::read(input_, buffer.data(), buffer.size());
    if (n > 0) {
      in_.append(buffer.data(), static_cast<std::size_t>(n));
    } else if (n == 0) {
      fail("its program has ended, or closed the connection");
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      fail(fmt::format("it cannot be read: {}", std::strerror(errno)));
    }
  }
}

std::optional<std::string_view> FrameStream::receive() {
  const std::string_view rest = std::string_view(in_).substr(read_);
  if (rest.size() < kPrefix) return std::nullopt;
  std::size_t length = 0;
  for (const char byte : rest.substr(0, kPrefix)) length = length << 8 | static_cast<unsigned char>(byte);
  if (length > kMost) {
    fail(fmt::format("it announces a message of {} bytes, at most {} are taken", length, kMost));
    read_ = in_.size();
    return std::nullopt;
  }
  if (rest.size() - kPrefix < length) return std::nullopt;
  read_ += kPrefix + length;
  return rest.substr(kPrefix, length);
}

}  // namespace spark::spades
