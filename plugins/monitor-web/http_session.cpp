#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <optional>
#include <variant>

#include "http_request.h"
#include "server_state.h"

namespace spark::web {

namespace {

using beast::error_code;

constexpr int kMaxRequests = 200;  // per connection

// Limits of what is read and discarded after the last response.
constexpr auto kDrainTimeout = std::chrono::seconds(2);
constexpr std::size_t kMaxDrainedBytes = 1 << 20;

constexpr const char* kContentSecurityPolicy =
    "default-src 'self'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src "
    "'self' ws: wss: blob: data:; "
    "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; frame-ancestors 'none'";

/// One HTTP connection: reads a request, writes the response, repeats. The pending asynchronous operation owns it.
class HttpSession : public Connection, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ServerState& state, beast::tcp_stream stream)
      : state_(state), stream_(std::move(stream)), buffer_(kMaxHeaderBytes) {
    state_.connections.push_back(this);
    position = std::prev(state_.connections.end());
  }
  ~HttpSession() override { state_.connections.erase(position); }

  void drop() override { stream_.close(); }

  /// Waits for the next request.
  void read() {
    answering = false;
    state_.connections.splice(state_.connections.end(), state_.connections, position);
    makeParser(parser_);
    startTimeout();
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code ec, std::size_t) { self->onRead(ec); });
  }

 private:
  using Empty = http::response<http::empty_body>;
  using Text = http::response<http::string_body>;
  using File = http::response<http::file_body>;

  void startTimeout() {
    stream_.expires_after(std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(state_.settings.requestTimeout)));
  }

  void onRead(error_code ec) {
    if (const auto reply = errorReply(ec)) return answer(*reply);
    if (ec) return;  // the peer closed the connection, or the timeout expired
    answering = true;
    HttpReply reply = state_.site.answer(requestIn(*parser_));
    if (reply.stream) return becomeViewer();
    if (reply.isAsset) return loadAsset(std::move(reply));
    if (!reply.isStatus) return answer(reply);
    state_.hub.requestStatus(Clock::now(), [self = shared_from_this(), reply](const std::string& status) mutable {
      reply.text = status;
      self->answer(reply);
    });
    state_.update();
  }

  /// Sends the asset of path `reply.text` when it is loaded. One that cannot be shown is no error: it has no content.
  void loadAsset(HttpReply reply) {
    const std::string path = std::exchange(reply.text, {});
    if (state_.loadAsset(path, [self = shared_from_this(), reply](const LoadedAsset& asset) mutable {
          reply.status = asset.bytes ? 200 : 204;
          reply.type = asset.type;
          reply.immutable = asset.bytes != nullptr;
          reply.shared = asset.bytes;
          self->answer(reply);
        }))
      return;
    reply.status = 404;
    reply.text = "There is no such mesh or texture.\n";
    answer(reply);
  }

  void becomeViewer() {
    if (state_.viewers < state_.settings.maxViewers) {
      stream_.expires_never();
      return serveViewer(state_, std::move(stream_), parser_->get());
    }
    HttpReply full;
    full.status = 503;
    full.text = "All places are taken.\n";
    full.close = true;
    answer(full);
  }

  template <class Body>
  http::response<Body> responseHead(const HttpReply& reply) {
    http::response<Body> out;
    out.version(11);
    out.result(reply.status);
    out.keep_alive(keepAlive_);
    out.set(http::field::content_type, reply.type);
    out.set(http::field::cache_control, reply.immutable ? "public, max-age=31536000, immutable" : "no-cache");
    out.set("Content-Security-Policy", kContentSecurityPolicy);
    out.set("X-Content-Type-Options", "nosniff");
    out.set("Referrer-Policy", "no-referrer");
    if (reply.status == 426) out.set(http::field::upgrade, "websocket");
    return out;
  }

  void answer(const HttpReply& reply) {
    keepAlive_ = !reply.close && parser_->get().keep_alive() && ++requests_ < kMaxRequests;
    const bool bodyless = parser_->get().method() == http::verb::head;
    if (!reply.file.empty()) return answerFile(reply, bodyless);
    if (bodyless || reply.status == 204) {
      auto out = responseHead<http::empty_body>(reply);
      if (reply.status != 204) out.content_length(reply.shared ? reply.shared->size() : reply.text.size());
      return write(std::move(out));
    }
    if (reply.shared) {
      auto out = responseHead<http::span_body<const char>>(reply);
      out.body() = {reply.shared->data(), reply.shared->size()};
      out.prepare_payload();
      return write(std::move(out), reply.shared);
    }
    auto out = responseHead<http::string_body>(reply);
    out.body() = reply.text;
    out.prepare_payload();
    write(std::move(out));
  }

  void answerFile(const HttpReply& reply, bool bodyless) {
    auto out = responseHead<http::file_body>(reply);
    error_code ec;
    out.body().open(reply.file.c_str(), beast::file_mode::scan, ec);
    if (ec) {
      HttpReply unreadable;
      unreadable.status = 404;
      unreadable.text = "This file cannot be read.\n";
      return answer(unreadable);
    }
    if (bodyless) {
      auto headOnly = responseHead<http::empty_body>(reply);
      headOnly.content_length(out.body().size());
      return write(std::move(headOnly));
    }
    out.prepare_payload();
    write(std::move(out));
  }

  /// A response and the state of its transmission.
  template <class Body>
  struct Outgoing {
    Outgoing(http::response<Body> r, std::shared_ptr<const std::string> b)
        : bytes(std::move(b)), response(std::move(r)), serializer(response) {}
    std::shared_ptr<const std::string> bytes;  ///< what `response` refers to, if anything
    http::response<Body> response;
    http::response_serializer<Body> serializer;
  };

  template <class Body>
  void write(http::response<Body> response, std::shared_ptr<const std::string> bytes = {}) {
    writeSome(std::make_shared<Outgoing<Body>>(std::move(response), std::move(bytes)));
  }
  /// Writes part by part, each with its own timeout.
  template <class Body>
  void writeSome(std::shared_ptr<Outgoing<Body>> out) {
    startTimeout();
    http::async_write_some(stream_, out->serializer, [self = shared_from_this(), out](error_code ec, std::size_t) {
      if (ec) return;
      if (!out->serializer.is_done()) return self->writeSome(out);
      if (self->keepAlive_)
        self->read();
      else
        self->end();
    });
  }

  /// Closes our direction, then reads and discards what the peer still sends: closing a socket with unread bytes resets
  /// the connection, and the peer could lose the response.
  void end() {
    answering = false;
    error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kDrainTimeout);
    drain(kMaxDrainedBytes);
  }
  void drain(std::size_t maxBytes) {
    stream_.async_read_some(boost::asio::buffer(discarded_),
                            [self = shared_from_this(), maxBytes](error_code ec, std::size_t n) {
                              if (!ec && n < maxBytes) self->drain(maxBytes - n);
                            });
  }

  ServerState& state_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<HeaderParser> parser_;
  std::array<char, 4096> discarded_;
  int requests_ = 0;  ///< answered on this connection
  bool keepAlive_ = true;
};

}  // namespace

void serveHttp(ServerState& state, beast::tcp_stream stream) {
  std::make_shared<HttpSession>(state, std::move(stream))->read();
}

}  // namespace spark::web
