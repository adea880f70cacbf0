#include <boost/asio/buffer.hpp>
#include <filesystem>
#include <stdexcept>

#include "../../plugins/monitor-web/http_request.h"

// Requests as they arrive from a socket, in pieces of the size that the first byte gives. The reply is an error, a page
// of the server, or a file below the served folders.

using namespace spark::web;

namespace {
const Site& site() {
  static const Site served({"/served/viewer", "", "/served/logs", {}});
  return served;
}

void check(const HttpReply& reply) {
  const bool known = reply.status == 200 || (reply.status >= 400 && reply.status < 500);
  if (!known || reply.type.empty()) throw std::logic_error("an invalid reply");
  if (reply.file.empty()) return;
  const std::string path = reply.file.lexically_normal().string();
  if (path != reply.file.string() || !path.starts_with("/served/"))
    throw std::logic_error("a file outside the served folders: " + path);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0] % 64;
  std::string bytes;
  std::size_t at = 1;
  for (int requests = 0; requests < 8; ++requests) {
    std::optional<HeaderParser> parser;
    makeParser(parser);
    boost::beast::error_code ec;
    while (!parser->is_header_done()) {
      const std::size_t used = parser->put(boost::asio::buffer(bytes), ec);
      bytes.erase(0, used);
      if (ec && ec != boost::beast::http::error::need_more) break;
      if (parser->is_header_done()) break;
      if (at >= size) return 0;
      const std::size_t n = std::min(piece, size - at);
      bytes.append(reinterpret_cast<const char*>(data) + at, n);
      at += n;
    }
    if (const auto reply = errorReply(ec)) return check(*reply), 0;
    const HttpRequest request = requestIn(*parser);
    const HttpReply reply = site().answer(request);
    check(reply);
    // Path components are plain names, so they cannot lead out of a folder.
    const auto names = plainComponents(request.target.substr(std::min<std::size_t>(1, request.target.size())));
    for (const std::string& name : names)
      if (name == ".." || name == "." || name.find('/') != name.npos)
        throw std::logic_error("an invalid name: " + name);
    if (reply.close || reply.stream) return 0;
  }
  return 0;
}
