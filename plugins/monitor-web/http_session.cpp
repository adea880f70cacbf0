#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <optional>
#include <variant>

#include "connections.h"
#include "http_request.h"

namespace spark::web {

namespace {

using beast::error_code;

constexpr int kMostRequests = 200;  // of one connection

constexpr auto kLinger = std::chrono::seconds(2);
constexpr std::size_t kMostDrained = 1 << 20;

constexpr const char* kPolicy =
    "default-src 'self'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src "
    "'self' ws: wss: blob: data:; "
    "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; frame-ancestors 'none'";

class HttpSession : public Connection, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(Hall& hall, beast::tcp_stream stream) : hall_(hall), stream_(std::move(stream)), buffer_(kLongestHeader) {
    hall_.visitors.push_back(this);
    place = std::prev(hall_.visitors.end());
  }
  ~HttpSession() override { hall_.visitors.erase(place); }

  void drop() override { stream_.close(); }

  void read() {
    answering = false;
    hall_.visitors.splice(hall_.visitors.end(), hall_.visitors, place);
    makeParser(parser_);
    expire();
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code ec, std::size_t) { self->heard(ec); });
  }

 private:
  using Empty = http::response<http::empty_body>;
  using Text = http::response<http::string_body>;
  using File = http::response<http::file_body>;

  void expire() {
    stream_.expires_after(std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(hall_.settings.requestTimeout)));
  }

  void heard(error_code ec) {
    if (const auto complaint = complaintAbout(ec)) return answer(*complaint);
    if (ec) return;  // it left, or took too long
    answering = true;
    Reply reply = hall_.site.answer(requestIn(*parser_));
    if (reply.stream) return becomeViewer();
    if (!reply.isStatus) return answer(reply);
    hall_.audience.whenStatus(Clock::now(), [self = shared_from_this(), reply](const std::string& status) mutable {
      reply.text = status;
      self->answer(reply);
    });
    hall_.pump();
  }

  void becomeViewer() {
    if (hall_.viewers < static_cast<std::size_t>(hall_.settings.maxViewers)) {
      stream_.expires_never();
      return serveViewer(hall_, std::move(stream_), parser_->get());
    }
    Reply full;
    full.status = 503;
    full.text = "All places are taken.\n";
    full.close = true;
    answer(full);
  }

  template <class Body>
  http::response<Body> head(const Reply& reply) {
    http::response<Body> out;
    out.version(11);
    out.result(reply.status);
    out.keep_alive(stays_);
    out.set(http::field::content_type, reply.type);
    out.set(http::field::cache_control, reply.keep ? "public, max-age=31536000, immutable" : "no-cache");
    out.set("Content-Security-Policy", kPolicy);
    out.set("X-Content-Type-Options", "nosniff");
    out.set("Referrer-Policy", "no-referrer");
    if (reply.status == 426) out.set(http::field::upgrade, "websocket");
    return out;
  }

  void answer(const Reply& reply) {
    stays_ = !reply.close && parser_->get().keep_alive() && ++requests_ < kMostRequests;
    const bool bodyless = parser_->get().method() == http::verb::head;
    if (!reply.file.empty()) return answerFile(reply, bodyless);
    if (bodyless) {
      auto out = head<http::empty_body>(reply);
      out.content_length(reply.text.size());
      return write(std::move(out));
    }
    auto out = head<http::string_body>(reply);
    out.body() = reply.text;
    out.prepare_payload();
    write(std::move(out));
  }

  void answerFile(const Reply& reply, bool bodyless) {
    auto out = head<http::file_body>(reply);
    error_code ec;
    out.body().open(reply.file.c_str(), beast::file_mode::scan, ec);
    if (ec) {
      Reply gone;
      gone.status = 404;
      gone.text = "This file cannot be read.\n";
      return answer(gone);
    }
    if (bodyless) {
      auto headOnly = head<http::empty_body>(reply);
      headOnly.content_length(out.body().size());
      return write(std::move(headOnly));
    }
    out.prepare_payload();
    write(std::move(out));
  }

  /// An answer and how much of it has left.
  template <class Body>
  struct Outgoing {
    explicit Outgoing(http::response<Body> r) : response(std::move(r)), serializer(response) {}
    http::response<Body> response;
    http::response_serializer<Body> serializer;
  };

  template <class Body>
  void write(http::response<Body> response) {
    writeSome(std::make_shared<Outgoing<Body>>(std::move(response)));
  }
  /// Piece by piece: each has its own time.
  template <class Body>
  void writeSome(std::shared_ptr<Outgoing<Body>> out) {
    expire();
    http::async_write_some(stream_, out->serializer, [self = shared_from_this(), out](error_code ec, std::size_t) {
      if (ec) return;
      if (!out->serializer.is_done()) return self->writeSome(out);
      if (self->stays_)
        self->read();
      else
        self->end();
    });
  }

  /// Says that nothing more comes. What the other still sends is taken for a moment: a connection that is closed with
  /// unread bytes takes the answer with it.
  void end() {
    answering = false;
    error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kLinger);
    drain(kMostDrained);
  }
  void drain(std::size_t left) {
    stream_.async_read_some(boost::asio::buffer(waste_),
                            [self = shared_from_this(), left](error_code ec, std::size_t n) {
                              if (!ec && n < left) self->drain(left - n);
                            });
  }

  Hall& hall_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<HeaderParser> parser_;
  std::array<char, 4096> waste_;
  int requests_ = 0;
  bool stays_ = true;
};

}  // namespace

void serveHttp(Hall& hall, beast::tcp_stream stream) { std::make_shared<HttpSession>(hall, std::move(stream))->read(); }

}  // namespace spark::web
