#include "drawing_server.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <chrono>

#include "draw_packet.h"
#include "spark/error.h"

// Any program that can reach the port may send packets, so these must not affect the match: a poll reads a limited
// number for a limited time (the system drops what arrives faster), packets are validated, and the number of drawings
// is limited.

namespace spark {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {
constexpr int kPacketsPerPoll = 64;
constexpr std::chrono::microseconds kTimePerPoll(500);
constexpr std::size_t kMaxPacketBytes = 2048;  // received; RoboViz accepts 512
constexpr std::size_t kMaxForwardedBytes = 512;
}  // namespace

void DrawingServer::describe(Description<DrawingServer>& d) {
  using S = DrawingServer;
  d.doc("Keeps agents' drawings for viewers; they come from a UDP port, from draw effectors and from plugins.");
  d.implements<IDrawings>();
  d.implements<IInputSource>();
  d.property("port", &S::port, &S::setPort)
      .range(-1, 65535)
      .ofProcess()
      .doc("UDP port; -1: none; 0 picks a free one, which can be read once it is open.");
  d.property("address", &S::address, &S::setAddress).doc("Address of this machine to listen on; 0.0.0.0: all.");
  d.property("forward", &S::forwardTo, &S::setForwardTo)
      .doc("host:port of another viewer that also gets all packets; empty: none.");
  d.property("packets", &S::packets).doc("Number of packets received at the port.");
  d.property("refused", &S::refused).doc("Number of packets with errors, and of shapes that exceeded a limit.");
  d.property("sets", &S::names).doc("Names of the sets that have shapes.");
  d.method("clear", &S::clear).doc("Removes all drawings.");
}

void DrawingServer::setPort(int port) {
  port_ = port;
  opened_ = false;
}

void DrawingServer::setAddress(std::string address) {
  address_ = std::move(address);
  opened_ = false;
}

void DrawingServer::setForwardTo(std::string to) {
  forwardTo_ = std::move(to);
  opened_ = false;
}

std::vector<std::string> DrawingServer::names() const {
  std::vector<std::string> names;
  for (const Set& set : sets())
    if (!set.shapes.empty()) names.push_back(set.name);
  return names;
}

void DrawingServer::onUnlink() {
  in_.reset();
  out_.reset();
  opened_ = false;
}

void DrawingServer::open() {
  opened_ = true;
  in_.reset();
  out_.reset();
  try {
    openPort();
  } catch (const std::exception& e) {
    in_.reset();
    kernel().log().warning("{}: drawings cannot come in at {}:{}: {}. Choose another port, or -1 for none.", path(),
                           address_, port_, e.what());
  }
  try {
    openForward();
  } catch (const std::exception& e) {
    out_.reset();
    kernel().log().warning("{}: drawings cannot be forwarded to '{}': {}. Expected host:port, as in 127.0.0.1:32769.",
                           path(), forwardTo_, e.what());
  }
}

void DrawingServer::openPort() {
  if (port_ < 0) return;
  const Udp::endpoint at(asio::ip::make_address(address_), static_cast<std::uint16_t>(port_));
  in_.emplace(io_, at);
  in_->non_blocking(true);
  port_ = in_->local_endpoint().port();
  kernel().log().info("Drawings of agents come in at UDP port {}.", port_);
}

void DrawingServer::openForward() {
  forwardedFrom_ = {};
  if (forwardTo_.empty()) return;
  const std::size_t colon = forwardTo_.rfind(':');
  if (colon == std::string::npos) throw Error("there is no port");
  const auto found = Udp::resolver(io_).resolve(forwardTo_.substr(0, colon), forwardTo_.substr(colon + 1));
  out_.emplace(io_);
  out_->connect(*found.begin());
  forwardedFrom_ = out_->local_endpoint();
  out_->non_blocking(true);
}

void DrawingServer::poll() {
  if (!opened_) open();
  if (!in_) return;
  std::array<char, kMaxPacketBytes> bytes;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kPacketsPerPoll && std::chrono::steady_clock::now() - begin < kTimePerPoll; ++i) {
    Udp::endpoint from;
    error_code ec;
    const std::size_t n = in_->receive_from(asio::buffer(bytes), from, 0, ec);
    if (ec) return;                        // no packet is left
    if (from == forwardedFrom_) continue;  // `forward` leads back to this port: an endless loop
    ++packets_;
    draw(std::as_bytes(std::span(bytes.data(), n)));
  }
}

void DrawingServer::draw(std::span<const std::byte> packet) {
  drawing::PacketReader reader(packet);
  drawing::Command command;
  using Kind = drawing::Command::Kind;
  while (reader.next(command)) {
    if (command.kind == Kind::swap) board_.swap(command.set);
    if (command.kind == Kind::agentText) board_.setAgentText(command.drawing);
    if (command.kind == Kind::draw && !board_.add(command.set, std::move(command.drawing))) ++refused_;
  }
  refused_ += reader.failed();
  forward({reinterpret_cast<const char*>(packet.data()), packet.size()});
}

void DrawingServer::show(std::string_view set, std::vector<Drawing> shapes) {
  // Forward them as packets of at most kMaxForwardedBytes.
  if (out_) {
    std::string packet, command;
    const auto add = [&](const auto& write) {
      command.clear();
      write();
      if (packet.size() + command.size() > kMaxForwardedBytes) forward(std::exchange(packet, {}));
      packet += command;
    };
    for (const Drawing& d : shapes) add([&] { drawing::writeDrawing(d, set, command); });
    add([&] { drawing::writeSwap(set, command); });
    forward(packet);
  }
  for (const Drawing& d : shapes)
    if (d.kind == Drawing::Kind::agentText) board_.setAgentText(d);
  std::erase_if(shapes, [](const Drawing& d) { return d.kind == Drawing::Kind::agentText; });
  refused_ += static_cast<std::int64_t>(board_.show(set, std::move(shapes)));
}

/// Errors are ignored: the other viewer may not be running.
void DrawingServer::forward(std::string_view packet) {
  if (!out_ || packet.empty()) return;
  error_code ec;
  out_->send(asio::buffer(packet.data(), packet.size()), 0, ec);
}

}  // namespace spark
