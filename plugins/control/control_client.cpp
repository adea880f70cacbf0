#include "control_client.h"

#include <array>
#include <boost/asio/buffer.hpp>

namespace spark::control {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr std::size_t kMaxRequestBytes = 65536;
}

ControlClient::ControlClient(Socket socket) : socket_(std::move(socket)) { socket_.non_blocking(true); }

bool ControlClient::flush() {
  while (!out_.empty()) {
    error_code ec;
    const std::size_t n = socket_.write_some(asio::buffer(out_), ec);
    if (ec == asio::error::would_block) return true;
    if (ec) return false;
    out_.erase(0, n);
  }
  return true;
}

bool ControlClient::read() {
  std::array<char, 4096> bytes;
  error_code ec;
  const std::size_t n = socket_.read_some(asio::buffer(bytes), ec);
  if (ec == asio::error::would_block) return true;
  if (ec) return false;
  in_.append(bytes.data(), n);
  return in_.size() <= kMaxRequestBytes;
}

void ControlClient::writeLine(const std::string& line) { out_ += line + "\n"; }

bool ControlClient::serve(Kernel& kernel, const Node& self) {
  if (!flush()) return false;
  if (!out_.empty()) return true;  // the client does not read
  if (!read()) return false;
  if (const std::size_t end = in_.find('\n'); end != std::string::npos) {
    const std::string line = in_.substr(0, end);
    in_.erase(0, end + 1);
    asked_ = true;
    writeLine(answer(kernel, self, line, watch_));
  } else if (watch_.started) {
    bool done = false;
    if (const std::string line = nextOf(kernel, watch_, done); !line.empty()) writeLine(line);
    watch_.started = !done;
  }
  return flush();
}

}  // namespace spark::control
