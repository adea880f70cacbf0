#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "server_state.h"
#include "viewer_socket.h"

namespace spark::web {

namespace {

using beast::error_code;

/// A viewer behind a WebSocket. Pending asynchronous operations own it; the hub owns it too, from the handshake until
/// reading ends.
class SocketViewer : public Viewer, public std::enable_shared_from_this<SocketViewer> {
 public:
  SocketViewer(ServerState& state, beast::tcp_stream stream, std::string peer)
      : Viewer(++state.lastViewerId, std::move(peer)),
        state_(state),
        socket_(std::move(stream)),
        buffer_(kMaxMessageBytes) {
    configureSocket(socket_);
    ++state_.viewers;
  }
  ~SocketViewer() override { --state_.viewers; }

  void accept(const http::request<http::empty_body>& request) {
    socket_.async_accept(request, [self = shared_from_this()](error_code ec) {
      if (ec) return;
      self->socket_.control_callback(
          [s = self.get()](beast::websocket::frame_type, beast::string_view) { s->onPing(); });
      self->state_.log.debug("Web: {} watches.", self->peer());
      self->state_.hub.onConnect(self, Clock::now());
      self->state_.update();
      self->read();
    });
  }

 private:
  void read() {
    if (!mayRead() && !closing()) {
      paused_ = true;
      return;
    }
    socket_.async_read(buffer_, [self = shared_from_this()](error_code ec, std::size_t) { self->onRead(ec); });
  }

  void onRead(error_code ec) {
    if (ec) return onEnd(ec);
    if (socket_.got_text()) {
      const auto bytes = buffer_.cdata();
      state_.hub.onMessage(*this, {static_cast<const char*>(bytes.data()), bytes.size()}, Clock::now());
      state_.update();
    } else {
      close("expected text messages");
    }
    buffer_.consume(buffer_.size());
    read();
  }

  /// Called by Beast for a ping, pong or close frame, from within a read: the socket must not be closed in this call.
  void onPing() {
    if (state_.hub.onPing(*this, Clock::now())) return;
    boost::asio::post(socket_.get_executor(), [self = shared_from_this()] { self->close("too many messages"); });
  }

  void onEnd(error_code ec) {
    state_.log.debug("Web: {} left: {}.", peer(), ec.message());
    state_.hub.onDisconnect(*this);
    beast::get_lowest_layer(socket_).close();
  }

  void transmit(const Message& message) override {
    socket_.binary(message.binary());
    socket_.async_write(boost::asio::buffer(*message.bytes),
                        [self = shared_from_this(), bytes = message.bytes](error_code ec, std::size_t) {
                          if (ec)
                            beast::get_lowest_layer(self->socket_).close();  // ends reading as well
                          else
                            self->sent();
                        });
  }

  void disconnect(std::string_view reason) override {
    state_.log.info("Web: {} was closed: {}.", peer(), reason);
    if (idle()) {
      socket_.async_close(
          {beast::websocket::close_code::policy_error, beast::string_view(reason.data(), reason.size())},
          [self = shared_from_this()](error_code) {});
    } else {
      // A close frame would wait behind the queue, and the system would keep that for a peer that does not read.
      auto& connection = beast::get_lowest_layer(socket_);
      error_code ec;
      connection.socket().set_option(boost::asio::socket_base::linger(true, 0), ec);
      connection.close();
    }
    resume();
  }

  void resume() override {
    if (!paused_ || (!mayRead() && !closing())) return;
    paused_ = false;
    read();
  }

  ServerState& state_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  bool paused_ = false;  ///< reading waits for resume()
};

std::string describePeer(const beast::tcp_stream& stream) {
  error_code ec;
  const auto end = stream.socket().remote_endpoint(ec);
  return ec ? std::string("(gone)") : fmt::format("{}:{}", end.address().to_string(), end.port());
}

}  // namespace

void serveViewer(ServerState& state, beast::tcp_stream stream, const http::request<http::empty_body>& request) {
  std::string peer = describePeer(stream);
  std::make_shared<SocketViewer>(state, std::move(stream), std::move(peer))->accept(request);
}

}  // namespace spark::web
