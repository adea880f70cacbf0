#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "connections.h"
#include "viewer_socket.h"

namespace spark::web {

namespace {

using beast::error_code;

/// A viewer behind a WebSocket. Lives as long as something is on its way; the audience knows it from the handshake to
/// the end of reading.
class SocketViewer : public Viewer, public std::enable_shared_from_this<SocketViewer> {
 public:
  SocketViewer(Hall& hall, beast::tcp_stream stream, std::string peer)
      : Viewer(++hall.lastId, std::move(peer)), hall_(hall), socket_(std::move(stream)), buffer_(kLongestMessage) {
    configureSocket(socket_);
    ++hall_.viewers;
  }
  ~SocketViewer() override { --hall_.viewers; }

  void accept(const http::request<http::empty_body>& request) {
    socket_.async_accept(request, [self = shared_from_this()](error_code ec) {
      if (ec) return;
      self->socket_.control_callback(
          [s = self.get()](beast::websocket::frame_type, beast::string_view) { s->knocked(); });
      self->hall_.log.debug("Web: {} watches.", self->peer());
      self->hall_.audience.arrived(self, Clock::now());
      self->hall_.pump();
      self->read();
    });
  }

 private:
  void read() {
    if (!mayRead() && !closing()) {
      paused_ = true;
      return;
    }
    socket_.async_read(buffer_, [self = shared_from_this()](error_code ec, std::size_t) { self->heard(ec); });
  }

  void heard(error_code ec) {
    if (ec) return leave(ec);
    if (socket_.got_text()) {
      const auto bytes = buffer_.cdata();
      hall_.audience.said(*this, {static_cast<const char*>(bytes.data()), bytes.size()}, Clock::now());
      hall_.pump();
    } else {
      close("expected text messages");
    }
    buffer_.consume(buffer_.size());
    read();
  }

  /// A ping, pong or close came; nothing may be closed within the call that tells so.
  void knocked() {
    if (hall_.audience.knocked(*this, Clock::now())) return;
    boost::asio::post(socket_.get_executor(), [self = shared_from_this()] { self->close("too many messages"); });
  }

  void leave(error_code ec) {
    hall_.log.debug("Web: {} left: {}.", peer(), ec.message());
    hall_.audience.left(*this);
    beast::get_lowest_layer(socket_).close();
  }

  void transmit(const Message& message) override {
    socket_.binary(message.binary());
    socket_.async_write(boost::asio::buffer(*message.bytes),
                        [self = shared_from_this(), bytes = message.bytes](error_code ec, std::size_t) {
                          if (ec)
                            beast::get_lowest_layer(self->socket_).close();  // reading ends as well
                          else
                            self->sent();
                        });
  }

  void hangUp(std::string_view reason) override {
    hall_.log.info("Web: {} was closed: {}.", peer(), reason);
    if (idle()) {
      socket_.async_close(
          {beast::websocket::close_code::policy_error, beast::string_view(reason.data(), reason.size())},
          [self = shared_from_this()](error_code) {});
    } else {
      beast::get_lowest_layer(socket_).close();  // it would not hear it before what waits
    }
    resume();
  }

  void resume() override {
    if (!paused_ || (!mayRead() && !closing())) return;
    paused_ = false;
    read();
  }

  Hall& hall_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  bool paused_ = false;
};

std::string describePeer(const beast::tcp_stream& stream) {
  error_code ec;
  const auto end = stream.socket().remote_endpoint(ec);
  return ec ? std::string("(gone)") : fmt::format("{}:{}", end.address().to_string(), end.port());
}

}  // namespace

void serveViewer(Hall& hall, beast::tcp_stream stream, const http::request<http::empty_body>& request) {
  std::string peer = describePeer(stream);
  std::make_shared<SocketViewer>(hall, std::move(stream), std::move(peer))->accept(request);
}

}  // namespace spark::web
