#pragma once
/// \file
/// One client of a port: what it sent and was not cut yet, what it was sent and did not take yet.
///
/// Nothing here is driven by callbacks. Asio only tells that a socket became readable or writable; bytes move when the
/// port asks for it, in the port's order, so that the order of delivery depends on what arrived and not on how the
/// operating system reported it.

#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "api/net.h"
#include "net-tcp/handler_memory.h"

namespace spark {
class TcpPort;
}

namespace spark::net {

using boost::asio::ip::tcp;
using Clock = std::chrono::steady_clock;

class TcpConnection final : public IConnection, public std::enable_shared_from_this<TcpConnection> {
 public:
  /// What reading brought. `all`: less than there was room for, so that nothing more is there. `ended`: the client has
  /// gone or the connection failed.
  enum class Read { nothing, some, all, ended };

  TcpConnection(tcp::socket socket, std::uint64_t id, TcpPort& port);

  std::uint64_t id() const override { return id_; }
  const std::string& peer() const override { return peer_; }
  Node& port() override;
  bool send(std::string_view message) override;
  bool idle() const override { return written_ == out_.size(); }
  double stalledSeconds() const override;
  /// Seconds since it last took a byte that waits for it or finished a message; 0 when nothing waits for it.
  double quietSeconds(Clock::time_point now) const;
  void close(std::string_view reason) override;

  /// Shuts the socket; the port still has to tell the consumer.
  void shut();
  /// True when the socket may have bytes for read().
  bool readable() const { return readable_; }
  bool closing() const { return closing_; }
  /// Reads once, into `scratch`, and appends to input().
  Read read(std::string& scratch);
  /// Received and not cut into messages yet.
  const std::string& input() const { return input_; }
  void consume(std::size_t bytes);
  /// It has sent a whole message.
  bool spoken() const { return spoken_; }
  void markSpoken();
  /// Notes that the input ends in a part of a message (or not), for partialSeconds().
  void markPartial(bool partial);
  /// Seconds since the unfinished message began; 0 when there is none.
  double partialSeconds(Clock::time_point now) const;

 private:
  void watchRead();
  void watchWrite();
  /// Writes what waits; false when the connection failed.
  bool flush();

  tcp::socket socket_;
  TcpPort& port_;
  const std::uint64_t id_;
  std::string peer_, input_, out_;
  std::size_t written_ = 0;
  HandlerMemory readMemory_, writeMemory_;
  Clock::time_point stalledSince_{}, heardAt_{}, partialSince_{};
  bool readable_ = true, closing_ = false, partial_ = false, watchingWrite_ = false, spoken_ = false;
};

}  // namespace spark::net
