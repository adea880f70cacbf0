#include "spectator.h"

#include <fmt/format.h>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstring>
#include <utility>

namespace spectators {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::size_t kFrameHead = 20, kLongHead = 126, kLongestHead = 65536;
constexpr std::size_t kLongest = 64u << 20;

/// Size of the WebSocket header of a message from a server [bytes].
std::size_t headOf(std::size_t size) { return size < kLongHead ? 2 : size < kLongestHead ? 4 : 10; }

class Watching : public Spectator, public std::enable_shared_from_this<Watching> {
 public:
  Watching(asio::io_context& io, const Settings& settings, bool stalled)
      : settings_(settings), stalled_(stalled), socket_(io) {}

  const Tally& tally() const override { return tally_; }

  void start(std::function<void()> watching) override {
    watching_ = std::move(watching);
    auto& plain = socket_.next_layer();
    plain.async_connect({asio::ip::make_address(settings_.host), settings_.port},
                        [self = shared_from_this()](error_code ec) {
                          if (ec) return self->end();
                          self->shake();
                        });
  }

 private:
  void shake() {
    if (stalled_) {
      error_code ignored;
      socket_.next_layer().set_option(tcp::socket::receive_buffer_size(4096), ignored);
    }
    socket_.read_message_max(kLongest);
    socket_.async_handshake(fmt::format("{}:{}", settings_.host, settings_.port), "/stream",
                            [self = shared_from_this()](error_code ec) {
                              if (ec) return self->end();
                              if (self->stalled_) return self->seen();
                              if (self->settings_.rate > 0) return self->ask();
                              self->read();
                            });
  }

  void ask() {
    wish_ = fmt::format("{{\"do\":\"view\",\"rate\":{},\"detail\":\"{}\"}}", settings_.rate, settings_.detail);
    socket_.text(true);
    socket_.async_write(asio::buffer(wish_), [self = shared_from_this()](error_code ec, std::size_t) {
      if (ec) return self->end();
      self->read();
    });
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code ec, std::size_t) {
      if (ec) return self->end();
      self->take();
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void take() {
    const auto* bytes = static_cast<const unsigned char*>(buffer_.cdata().data());
    const std::size_t size = buffer_.size();
    tally_.bytes += size + headOf(size);
    if (socket_.got_text()) {
      ++tally_.texts;
      return;
    }
    std::uint32_t serial = 0;
    if (size < kFrameHead) return void(++tally_.bad);
    std::memcpy(&serial, bytes + 8, sizeof serial);
    const bool key = bytes[0] == 1, follows = bytes[0] == 2 && serial == serial_ + 1;
    if (!key && !follows) ++tally_.bad;
    ++(key ? tally_.keys : tally_.deltas);
    serial_ = serial;
    seen();
  }

  void seen() {
    if (auto watching = std::exchange(watching_, {})) watching();
  }
  void end() { tally_.closed = true; }

  const Settings& settings_;
  const bool stalled_;
  websocket::stream<tcp::socket> socket_;
  boost::beast::flat_buffer buffer_;
  std::string wish_;
  std::function<void()> watching_;
  std::uint32_t serial_ = 0;
  Tally tally_;
};

}  // namespace

std::shared_ptr<Spectator> Spectator::make(asio::io_context& io, const Settings& settings, bool stalled) {
  return std::make_shared<Watching>(io, settings, stalled);
}

}  // namespace spectators
