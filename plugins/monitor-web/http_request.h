#pragma once
/// \file
/// Parses the head of an HTTP request.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <optional>

#include "site.h"

namespace spark::web {

/// Maximum size of a request's head in bytes.
inline constexpr std::uint32_t kMaxHeaderBytes = 8192;

using HeaderParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

/// Makes a new parser with limits, for the next request.
inline void makeParser(std::optional<HeaderParser>& parser) {
  parser.emplace();
  parser->header_limit(kMaxHeaderBytes);
  parser->body_limit(std::uint64_t{0});
}

/// The request in a parser that has read a head. The texts are views into the parser. A repeated Host field counts as
/// missing, a repeated Origin as "null", so both are refused.
inline HttpRequest requestIn(const HeaderParser& parser) {
  namespace http = boost::beast::http;
  const auto view = [](boost::beast::string_view s) { return std::string_view(s.data(), s.size()); };
  const auto& message = parser.get();
  const auto field = [&](http::field name) {
    return message.count(name) == 1 ? view(message[name]) : std::string_view();
  };
  HttpRequest out;
  out.method = view(message.method_string());
  out.target = view(message.target());
  out.host = field(http::field::host);
  out.origin = message.count(http::field::origin) > 1 ? std::string_view("null") : field(http::field::origin);
  out.upgrade = boost::beast::websocket::is_upgrade(message);
  out.hasBody = parser.chunked() || parser.content_length().value_or(0) > 0;
  return out;
}

/// The reply to bytes that are not a valid request, or that exceed a limit. Empty if `ec` is no HTTP error or the
/// connection has ended.
inline std::optional<HttpReply> errorReply(const boost::beast::error_code& ec) {
  namespace http = boost::beast::http;
  static const auto& category = make_error_code(http::error::end_of_stream).category();
  if (!ec || ec.category() != category || ec == http::error::end_of_stream || ec == http::error::partial_message)
    return std::nullopt;
  HttpReply out;
  out.status = ec == http::error::header_limit || ec == http::error::buffer_overflow ? 431
               : ec == http::error::body_limit                                       ? 413
                                                                                     : 400;
  out.text = "This is no request that is understood here: " + ec.message() + "\n";
  out.close = true;
  return out;
}

}  // namespace spark::web
