#include "agent_connection.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
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

void AgentConnection::connect(const std::string& host, int port, double patience) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    error_code ec;
    tcp::resolver resolver(socket_.get_executor());
    const auto found = resolver.resolve(host, std::to_string(port), ec);
    if (!ec) asio::connect(socket_, found, ec);
    if (!ec) break;
    if (std::chrono::steady_clock::now() >= deadline)
      throw Error(fmt::format("cannot reach a server at {}:{}: {}", host, port, ec.message()));
    std::this_thread::sleep_for(kRetry);
  }
  socket_.set_option(tcp::no_delay(true));
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
  out_.assign(4, '\0');
  language_.write(predicates, out_);
  const std::size_t n = out_.size() - 4;
  for (int i = 0; i < 4; ++i) out_[static_cast<std::size_t>(i)] = static_cast<char>(n >> (24 - 8 * i));
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

/// Answers every complete message in the buffer.
void AgentConnection::answerAll() {
  const std::string_view all(in_.data(), filled_);
  std::size_t at = 0;
  while (socket_.is_open() && all.size() - at >= kPrefix) {
    std::size_t n = 0;
    for (const unsigned char byte : all.substr(at, kPrefix)) n = n << 8 | byte;
    if (n > kMaxMessage)
      return end(fmt::format("the server announced a message of {} bytes: it speaks another protocol", n));
    if (all.size() - at - kPrefix < n) break;
    ++received_;
    answer(all.substr(at + kPrefix, n));
    at += kPrefix + n;
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
