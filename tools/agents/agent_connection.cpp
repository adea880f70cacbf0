#include "agent_connection.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <thread>

#include "spark/error.h"

namespace spark::agent {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {
constexpr std::size_t kMaxMessage = 1 << 20;  // bytes; a longer message means that the server speaks another protocol
constexpr std::size_t kPrefix = 4;            // bytes of the length prefix
constexpr std::size_t kRoom = 16384;          // bytes per read
constexpr auto kRetry = std::chrono::milliseconds(100);
}  // namespace

void AgentConnection::connect(const std::string& where, double patience, const std::function<error_code()>& attempt) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  while (const error_code ec = attempt()) {
    if (std::chrono::steady_clock::now() >= deadline)
      throw Error(fmt::format("cannot reach a server at {}: {}", where, ec.message()));
    std::this_thread::sleep_for(kRetry);
  }
}

void AgentConnection::connect(const std::string& host, int port, double patience) {
  tcp::socket socket(socket_.get_executor());
  connect(fmt::format("{}:{}", host, port), patience, [&] {
    error_code ec;
    const auto found = tcp::resolver(socket.get_executor()).resolve(host, std::to_string(port), ec);
    if (!ec) asio::connect(socket, found, ec);
    return ec;
  });
  socket.set_option(tcp::no_delay(true));
  socket_ = std::move(socket);
}

void AgentConnection::connectTo(const std::string& file, double patience) {
  using Local = asio::local::stream_protocol;
  Local::socket socket(socket_.get_executor());
  connect(file, patience, [&] {
    error_code ec, ignored;
    if (socket.is_open()) socket.close(ignored);
    socket.connect(Local::endpoint(file), ec);
    return ec;
  });
  socket_ = std::move(socket);
}

void AgentConnection::start(const Predicates& first, OnMessage onMessage, OnEnd onEnd) {
  onMessage_ = std::move(onMessage);
  onEnd_ = std::move(onEnd);
  if (!first.empty()) send(first);
  receive();
}

void AgentConnection::close() {
  error_code ignored;
  socket_.close(ignored);
}

// A blocking write: messages are small and the server always reads, so it returns at once, and messages stay in order.
void AgentConnection::send(const Predicates& predicates) {
  out_.assign(framing_ == Framing::length ? kPrefix : 0, '\0');
  language_.write(predicates, out_);
  if (framing_ == Framing::line) {
    std::replace(out_.begin(), out_.end(), '\n', ' ');
    out_ += '\n';
  } else {
    const std::size_t n = out_.size() - kPrefix;
    for (std::size_t i = 0; i < kPrefix; ++i) out_[i] = static_cast<char>(n >> (24 - 8 * i));
  }
  error_code ec;
  asio::write(socket_, asio::buffer(out_), ec);
  if (ec) end("sending failed: " + ec.message());
}

void AgentConnection::receive() {
  if (in_.size() - filled_ < kRoom) in_.resize(filled_ + kRoom);
  socket_.async_read_some(asio::buffer(in_.data() + filled_, in_.size() - filled_),
                          [this](const error_code& ec, std::size_t n) {
                            if (ec)
                              return end(ec == asio::error::eof ? "the server closed the connection" : ec.message());
                            filled_ += n;
                            answerAll();
                            if (socket_.is_open()) receive();
                          });
}

std::optional<std::string_view> AgentConnection::next(std::string_view all, std::size_t& at) {
  const std::string_view rest = all.substr(at);
  std::size_t start = 0, length = 0, end = 0;
  if (framing_ == Framing::line) {
    length = std::min(rest.find('\n'), rest.size());
    end = length + 1;
  } else if (rest.size() < kPrefix) {
    return std::nullopt;
  } else {
    for (const unsigned char byte : rest.substr(0, kPrefix)) length = length << 8 | byte;
    start = kPrefix;
    end = kPrefix + length;
  }
  if (length > kMaxMessage) {
    this->end(fmt::format("the server sends a message of {} bytes or more: it speaks another protocol", length));
    return std::nullopt;
  }
  if (end > rest.size()) return std::nullopt;
  at += end;
  return rest.substr(start, length);
}

/// Answers every complete message in the buffer.
void AgentConnection::answerAll() {
  const std::string_view all(in_.data(), filled_);
  std::size_t at = 0;
  while (socket_.is_open()) {
    const auto message = next(all, at);
    if (!message) break;
    ++received_;
    answer(*message);
  }
  std::copy(in_.data() + at, in_.data() + filled_, in_.data());
  filled_ -= at;
}

void AgentConnection::answer(std::string_view message) {
  percepts_.clear();
  actions_.clear();
  if (listens_) language_.read(message, percepts_);
  onMessage_(percepts_, actions_);
  if (!actions_.empty()) send(actions_);
}

void AgentConnection::end(const std::string& why) {
  if (!socket_.is_open()) return;
  close();
  if (onEnd_) onEnd_(why);
}

}  // namespace spark::agent
