#include "house.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <filesystem>
#include <istream>
#include <stdexcept>

namespace sparkctl {

namespace asio = boost::asio;
namespace fs = std::filesystem;

namespace {
/// Where houses put their sockets: see plugins/control.
std::vector<fs::path> folders() {
  std::vector<fs::path> out;
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime) out.push_back(fs::path(runtime) / "spark");
  out.emplace_back(fmt::format("/tmp/spark-{}", geteuid()));
  return out;
}

bool answers(const fs::path& file) {
  asio::io_context io;
  asio::local::stream_protocol::socket socket(io);
  boost::system::error_code ec;
  socket.connect(file.string(), ec);
  return !ec;
}
}  // namespace

std::vector<std::string> houses() {
  std::vector<std::string> out;
  for (const fs::path& folder : folders()) {
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder, ec))
      if (entry.path().extension() == ".sock" && answers(entry.path())) out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

House::House(const std::string& socket) {
  boost::system::error_code ec;
  socket_.connect(socket, ec);
  if (ec) throw std::runtime_error(fmt::format("no house answers at {}: {}", socket, ec.message()));
}

Json House::ask(const Json& request) {
  boost::system::error_code ec;
  asio::write(socket_, asio::buffer(request.dump() + "\n"), ec);
  if (ec) throw std::runtime_error("the house has ended: " + ec.message());
  return next();
}

Json House::next() {
  boost::system::error_code ec;
  asio::read_until(socket_, buffer_, '\n', ec);
  if (ec) throw std::runtime_error("the house has ended");
  std::istream in(&buffer_);
  std::string line;
  std::getline(in, line);
  Json answer = Json::parse(line);
  if (!answer.value("ok", false)) throw std::runtime_error(answer.value("error", "the house refused without a reason"));
  return answer;
}

}  // namespace sparkctl
