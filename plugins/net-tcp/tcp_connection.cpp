#include "net-tcp/tcp_connection.h"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

#include "net-tcp/tcp_port.h"

namespace spark::net {

namespace {
using boost::asio::error::would_block;
using boost::system::error_code;

std::string describePeer(const tcp::socket& socket) {
  error_code ec;
  const auto end = socket.remote_endpoint(ec);
  return ec ? std::string("(gone)") : fmt::format("{}:{}", end.address().to_string(), end.port());
}

/// Detects clients whose machine has failed: after 30 s of silence the system sends probes, and ends the connection
/// after six unanswered ones. TCP_USER_TIMEOUT is not set, since it would also end clients that merely do not read.
void enableKeepAlive(tcp::socket& socket) {
  constexpr int kIdle = 30, kInterval = 10, kProbes = 6;  // s, s, number
  using Idle = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
  using Interval = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
  using Probes = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;
  error_code ignored;
  socket.set_option(tcp::socket::keep_alive(true), ignored);
  socket.set_option(Idle(kIdle), ignored);
  socket.set_option(Interval(kInterval), ignored);
  socket.set_option(Probes(kProbes), ignored);
}
}  // namespace

TcpConnection::TcpConnection(tcp::socket socket, std::uint64_t id, TcpPort& port)
    : socket_(std::move(socket)), port_(port), id_(id), peer_(describePeer(socket_)) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  enableKeepAlive(socket_);
}

Node& TcpConnection::port() { return port_; }

void TcpConnection::watchRead() {
  readable_ = false;
  socket_.async_wait(tcp::socket::wait_read,
                     MemoryHandler(readMemory_, [self = shared_from_this()](const error_code& ec) {
                       if (!ec) self->readable_ = true;
                     }));
}

void TcpConnection::watchWrite() {
  if (watchingWrite_ || closing_) return;
  watchingWrite_ = true;
  socket_.async_wait(tcp::socket::wait_write,
                     MemoryHandler(writeMemory_, [self = shared_from_this()](const error_code& ec) {
                       self->watchingWrite_ = false;
                       if (!ec) self->flush();
                     }));
}

void TcpConnection::shut() {
  closing_ = true;
  readable_ = false;
  error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_both, ignored);
  socket_.close(ignored);
}

void TcpConnection::close(std::string_view reason) {
  if (closing_) return;
  port_.logLimited(Level::warning, fmt::format("{} is closed: {}.", peer_, reason));
  shut();
}

bool TcpConnection::send(std::string_view message) {
  if (closing_) return false;
  if (!flush() || !idle()) {
    port_.countDropped();
    return false;
  }
  out_.clear();
  written_ = 0;
  port_.frame(message, out_);
  stalledSince_ = Clock::now();
  return flush();
}

bool TcpConnection::flush() {
  while (!closing_ && !idle()) {
    error_code ec;
    const std::size_t n = socket_.write_some(boost::asio::buffer(out_.data() + written_, out_.size() - written_), ec);
    if (n > 0) {
      markOutput();
      written_ += n;
      stalledSince_ = Clock::now();
    }
    if (ec == would_block) {
      watchWrite();
      return true;
    }
    if (ec) {
      // The next read reports the error and ends the connection.
      written_ = out_.size();
      readable_ = true;
      return false;
    }
  }
  return !closing_;
}

double TcpConnection::stalledSeconds() const {
  return idle() ? 0.0 : std::chrono::duration<double>(Clock::now() - stalledSince_).count();
}

double TcpConnection::quietSeconds(Clock::time_point now) const {
  return idle() ? 0.0 : std::chrono::duration<double>(now - std::max(stalledSince_, heardAt_)).count();
}

void TcpConnection::markSpoken() {
  spoken_ = true;
  if (!idle()) heardAt_ = Clock::now();
}

TcpConnection::Read TcpConnection::read(std::string& scratch) {
  error_code ec;
  const std::size_t n = socket_.read_some(boost::asio::buffer(scratch), ec);
  if (ec == would_block) {
    watchRead();
    return Read::nothing;
  }
  if (ec) return Read::ended;
  input_.append(scratch, 0, n);
  if (std::exchange(unanswered_, true)) markPieces();
  owesAck_ = true;
  if (inPieces_) acknowledge();
  return n < scratch.size() ? Read::all : Read::some;
}

void TcpConnection::markPieces() {
  inPieces_ = true;
  regular_ = 0;
}

void TcpConnection::markOutput() {
  unanswered_ = owesAck_ = false;
  if (inPieces_ && ++regular_ >= kRegular) inPieces_ = false;
}

void TcpConnection::acknowledge() {
  if (closing_ || !std::exchange(owesAck_, false)) return;
  // The option is no mode: it acknowledges what was received until now, and later input is delayed again.
  using QuickAck = boost::asio::detail::socket_option::boolean<IPPROTO_TCP, TCP_QUICKACK>;
  error_code ignored;
  socket_.set_option(QuickAck(true), ignored);
}

void TcpConnection::consume(std::size_t bytes) { input_.erase(0, bytes); }

void TcpConnection::markPartial(bool partial) {
  if (partial && !partial_) partialSince_ = Clock::now();
  partial_ = partial;
  // The rest of the message may have to wait for the acknowledgement.
  if (!partial) return;
  markPieces();
  acknowledge();
}

double TcpConnection::partialSeconds(Clock::time_point now) const {
  return partial_ ? std::chrono::duration<double>(now - partialSince_).count() : 0.0;
}

}  // namespace spark::net
