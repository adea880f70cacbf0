#include <boost/asio/io_context.hpp>
#include <boost/beast/_experimental/test/stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <stdexcept>

#include "../../plugins/monitor-web/viewer_socket.h"
#include "spark/error.h"

// Bytes after the handshake of a WebSocket. Frames and messages are read as from a viewer. A message that is too long
// or invalid ends the connection.

using namespace spark::web;
namespace beast = boost::beast;

namespace {
constexpr const char* kHandshake =
    "GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: "
    "dGhlIHNhbXBsZSBub25jZQ==\r\n"
    "Sec-WebSocket-Version: 13\r\n\r\n";

void check(std::string_view text) {
  if (text.size() > kMaxMessageBytes) throw std::logic_error("a message that is too long");
  try {
    const ViewerMessage message = readViewerMessage(text);
    if (message.rate != 0 && (message.rate < kMinRate || message.rate > kMaxRate))
      throw std::logic_error("a rate out of range");
  } catch (const spark::Error&) {
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check(bytes.substr(0, kMaxMessageBytes));  // also directly as a message

  boost::asio::io_context io;
  beast::test::stream browser(io);
  beast::websocket::stream<beast::test::stream> socket(io);
  socket.next_layer().connect(browser);
  configureSocket(socket);
  socket.next_layer().append(kHandshake);
  beast::error_code ec;
  socket.accept(ec);
  if (ec) throw std::logic_error("the handshake failed: " + ec.message());
  socket.next_layer().append(beast::string_view(bytes.data(), bytes.size()));
  browser.close();
  beast::flat_buffer buffer(kMaxMessageBytes);
  while (!ec) {
    socket.read(buffer, ec);
    if (ec) break;
    if (socket.got_text()) check({static_cast<const char*>(buffer.cdata().data()), buffer.size()});
    buffer.consume(buffer.size());
  }
  return 0;
}
