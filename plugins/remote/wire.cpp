#include "wire.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <cerrno>
#include <chrono>
#include <cmath>

#include "spark/state_stream.h"

namespace spark::remote {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr std::size_t kHead = 4;            // bytes of a length
constexpr std::size_t kKept = 1024 * 1024;  // memory that a buffer keeps when it is empty

/// Drops the bytes that are done when they are many, or all.
void compact(std::string& buffer, std::size_t& done) {
  if (done < buffer.size() && done < 65536) return;
  buffer.erase(0, done);
  done = 0;
  if (buffer.empty() && buffer.capacity() > kKept) buffer.shrink_to_fit();
}
}  // namespace

std::string encode(const List& message) {
  StateWriter out(true);
  out.write(Value(message));
  return out.take();
}

List decode(std::string_view bytes) {
  StateReader in(bytes);
  Value value = in.readValue();
  if (!in.atEnd() || !value.isList() || value.toList().empty() || !value.toList()[0].isString())
    throw BadMessage("expected a message of a remote host, a list that begins with its kind");
  return std::move(value.toList());
}

const Value& at(const List& message, std::size_t index, Value::Type type) {
  if (index < message.size() && message[index].type() == type) return message[index];
  throw BadMessage(fmt::format("expected a message '{}' with a {} as element {}, found {}",
                               message.empty() ? "" : message[0].plain(), typeName(type), index,
                               index < message.size() ? message[index].text().substr(0, 200) : "none"));
}
const std::string& textAt(const List& message, std::size_t index) {
  return at(message, index, Value::Type::string).toString();
}
std::uint64_t numberAt(const List& message, std::size_t index) {
  return static_cast<std::uint64_t>(at(message, index, Value::Type::integer).toInteger());
}

Wire::Wire(Socket socket, std::string peer) : socket_(std::move(socket)), peer_(std::move(peer)) {
  socket_.non_blocking(true);
}

void Wire::send(const List& message) {
  const std::string bytes = encode(message);
  for (int shift = 24; shift >= 0; shift -= 8) out_ += static_cast<char>(bytes.size() >> shift);
  out_ += bytes;
}

bool Wire::flush() {
  while (unsent() > 0) {
    error_code ec;
    sent_ += socket_.write_some(asio::buffer(out_.data() + sent_, unsent()), ec);
    if (ec == asio::error::would_block) break;
    if (ec) return false;
  }
  compact(out_, sent_);
  return true;
}

bool Wire::receive() {
  compact(in_, taken_);
  std::array<char, 65536> bytes;
  while (in_.size() - taken_ <= limit_ + kHead) {
    error_code ec;
    const std::size_t n = socket_.read_some(asio::buffer(bytes), ec);
    in_.append(bytes.data(), n);
    if (ec == asio::error::would_block) return true;
    if (ec) return false;
  }
  return true;
}

std::optional<std::string_view> Wire::take() {
  const std::string_view rest = std::string_view(in_).substr(taken_);
  if (rest.size() < kHead) return std::nullopt;
  std::size_t size = 0;
  for (std::size_t i = 0; i < kHead; ++i) size = size << 8 | static_cast<unsigned char>(rest[i]);
  if (size > limit_)
    throw Error(fmt::format("expected messages of at most {} bytes, found one of {} bytes", limit_, size));
  if (rest.size() < kHead + size) return std::nullopt;
  taken_ += kHead + size;
  return rest.substr(kHead, size);
}

bool Wire::waitFor(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(std::max(seconds, 0.0));
  for (;;) {
    pollfd waited{descriptor(), static_cast<short>(POLLIN | (unsent() > 0 ? POLLOUT : 0)), 0};
    const std::chrono::duration<double, std::milli> left = end - Clock::now();
    const int found = ::poll(&waited, 1, static_cast<int>(std::ceil(std::max(left.count(), 0.0))));
    if (found > 0) return true;
    if (found == 0 || errno != EINTR) return false;
  }
}

Address Address::read(const std::string& text) {
  if (text.find('/') != std::string::npos) return {{}, {}, text};
  const std::size_t colon = text.rfind(':');
  const bool digits = colon != std::string::npos && colon + 1 < text.size() &&
                      std::all_of(text.begin() + static_cast<std::ptrdiff_t>(colon) + 1, text.end(),
                                  [](char c) { return c >= '0' && c <= '9'; });
  if (!digits)
    throw Error(fmt::format(
        "expected an address such as 127.0.0.1:3400, or the path of a Unix socket such as /tmp/spark.sock, found '{}'",
        text));
  std::string host = text.substr(0, colon), port = text.substr(colon + 1);
  if (port.size() > 5 || std::stoi(port) > 65535)
    throw Error(fmt::format("expected a port of at most 65535, found '{}'", text));
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host, port, {}};
}

}  // namespace spark::remote
