#include "net-tcp/stream_connection.h"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

#include "net-tcp/stream_port.h"

namespace spark::net {

namespace {
using boost::asio::error::would_block;
using boost::system::error_code;

}  // namespace

StreamConnection::StreamConnection(Accepted accepted, std::uint64_t id, StreamPort& port)
    : socket_(std::move(accepted.socket)),
      port_(port),
      id_(id),
      peer_(std::move(accepted.peer)),
      delaysAcks_(accepted.delaysAcks) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
}

Node& StreamConnection::port() { return port_; }

void StreamConnection::watchRead() {
  readable_ = false;
  socket_.async_wait(Stream::socket::wait_read,
                     MemoryHandler(readMemory_, [self = shared_from_this()](const error_code& ec) {
                       if (!ec) self->readable_ = true;
                     }));
}

void StreamConnection::watchWrite() {
  if (watchingWrite_ || closing_) return;
  watchingWrite_ = true;
  socket_.async_wait(Stream::socket::wait_write,
                     MemoryHandler(writeMemory_, [self = shared_from_this()](const error_code& ec) {
                       self->watchingWrite_ = false;
                       if (!ec) self->flush();
                     }));
}

void StreamConnection::shut() {
  closing_ = true;
  readable_ = false;
  error_code ignored;
  socket_.shutdown(Stream::socket::shutdown_both, ignored);
  socket_.close(ignored);
}

void StreamConnection::close(std::string_view reason) {
  if (closing_) return;
  port_.logLimited(Level::warning, fmt::format("{} is closed: {}.", peer_, reason));
  shut();
}

bool StreamConnection::send(std::string_view message) {
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

bool StreamConnection::flush() {
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

double StreamConnection::stalledSeconds() const {
  return idle() ? 0.0 : std::chrono::duration<double>(Clock::now() - stalledSince_).count();
}

double StreamConnection::quietSeconds(Clock::time_point now) const {
  return idle() ? 0.0 : std::chrono::duration<double>(now - std::max(stalledSince_, heardAt_)).count();
}

void StreamConnection::markSpoken() {
  spoken_ = true;
  if (!idle()) heardAt_ = Clock::now();
}

StreamConnection::Read StreamConnection::read(std::string& scratch) {
  error_code ec;
  const std::size_t n = socket_.read_some(boost::asio::buffer(scratch), ec);
  if (ec == would_block) {
    watchRead();
    return Read::nothing;
  }
  if (ec) return Read::ended;
  input_.append(scratch, 0, n);
  if (std::exchange(unanswered_, true)) markPieces();
  owesAck_ = delaysAcks_;
  if (inPieces_) acknowledge();
  return n < scratch.size() ? Read::all : Read::some;
}

void StreamConnection::markPieces() {
  inPieces_ = true;
  regular_ = 0;
}

void StreamConnection::markOutput() {
  unanswered_ = owesAck_ = false;
  if (inPieces_ && ++regular_ >= kRegular) inPieces_ = false;
}

void StreamConnection::acknowledge() {
  if (closing_ || !std::exchange(owesAck_, false)) return;
  // The option is no mode: it acknowledges what was received until now, and later input is delayed again.
  using QuickAck = boost::asio::detail::socket_option::boolean<IPPROTO_TCP, TCP_QUICKACK>;
  error_code ignored;
  socket_.set_option(QuickAck(true), ignored);
}

void StreamConnection::consume(std::size_t bytes) { input_.erase(0, bytes); }

void StreamConnection::markPartial(bool partial) {
  if (partial && !partial_) partialSince_ = Clock::now();
  partial_ = partial;
  // The rest of the message may have to wait for the acknowledgement.
  if (!partial) return;
  markPieces();
  acknowledge();
}

double StreamConnection::partialSeconds(Clock::time_point now) const {
  return partial_ ? std::chrono::duration<double>(now - partialSince_).count() : 0.0;
}

}  // namespace spark::net
