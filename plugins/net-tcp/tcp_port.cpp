#include "net-tcp/tcp_port.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <utility>

#include "net-tcp/net_server.h"
#include "spark/error.h"

namespace spark {

namespace {
using boost::system::error_code;
using net::Clock;
using net::tcp;
using net::TcpConnection;

constexpr std::size_t kReadSize = 65536;  // bytes a read
constexpr int kReadsPerPoll = 4;          // per connection: nobody starves behind a client that floods
constexpr int kAcceptsPerPoll = 64;
constexpr auto kAcceptPause = std::chrono::seconds(1);  // after the system refused, e.g. out of descriptors
constexpr auto kTimeoutCheck = std::chrono::milliseconds(500);
}  // namespace

void TcpPort::describe(Description<TcpPort>& d) {
  d.doc("A listening TCP port; delivers messages to its consumer, cut by the framing below it.");
  d.property("port", &TcpPort::port, &TcpPort::setPort)
      .range(0, 65535)
      .doc("Port number; 0 picks a free one, which is read back once it listens.");
  d.property("address", &TcpPort::address_).doc("Address to listen on.");
  d.link(&TcpPort::framing_, Child<IFraming>());
  d.link(&TcpPort::named_, At<IConnectionConsumer>(&TcpPort::consumerPath_));
  d.property("consumer", &TcpPort::consumer, &TcpPort::setConsumer)
      .doc("Path of the node that gets connections and messages.");
  d.property("maxMessage", &TcpPort::maxMessage_)
      .unit("bytes")
      .range(1, 1 << 30)
      .doc("A client that announces a longer message is closed.");
  d.property("maxConnections", &TcpPort::maxConnections_).range(1, 65536).doc("Further clients are closed at once.");
  d.property("makeRoom", &TcpPort::makeRoom_)
      .doc("When there are maxConnections clients, a new one takes the place of the oldest that never sent a message.");
  d.property("makeRoomAfter", &TcpPort::makeRoomAfter_)
      .unit("s")
      .min(0)
      .doc(
          "When it is full, a client that does not read and was not heard for longer than this (wall clock) makes "
          "room; 0: none does.");
  d.property("messageTimeout", &TcpPort::messageTimeout_)
      .unit("s")
      .min(0.001)
      .doc("A client that takes longer to finish a message it began is closed (wall clock).");
  d.property("sendBuffer", &TcpPort::sendBuffer_)
      .unit("bytes")
      .range(4096, 1 << 28)
      .doc("What the system may hold back for a client that does not read.");
  d.property("connections", &TcpPort::connectionCount).doc("Clients now.");
  d.property("connectionsSeen", &TcpPort::connectionsSeen).doc("Clients that were ever taken.");
  d.property("messagesDropped", &TcpPort::messagesDropped)
      .doc("Messages not sent because their client had not taken an earlier one.");
  d.method("listen", &TcpPort::listen).doc("Opens the port; otherwise the first poll does.");
}

void TcpPort::onLink() {
  auto* server = ancestor<NetServer>();
  if (!server)
    throw Error(fmt::format("A TcpPort lives below a NetServer, found '{}'. Create it as /sys/server/net/<name>.",
                            parent()->path()));
  io_ = server->io();
  scratch_.resize(kReadSize);
}

void TcpPort::onUnlink() {
  closeSilent();
  acceptor_.reset();
  if (!io_) return;
  io_->restart();
  io_->poll();  // lets go of the cancelled waits, which hold connections
  io_.reset();
}

void TcpPort::closeSilent() {
  for (auto& c : connections_) c->shut();
  reap();
}

void TcpPort::setPort(int port) {
  if (listening() && port != port_)
    throw Error(fmt::format("{}.port: it listens on {} already. Set the port before listen().", path(), port_));
  port_ = port;
}

void TcpPort::setConsumer(std::string path) {
  consumerPath_ = std::move(path);
  named_.lookAgain();
}

void TcpPort::complain(Level level, std::string_view what) {
  auto& log = kernel().log();
  if (log.enabled(level)) complaints_.write(log, level, fmt::format("Port {} ({}): {}", name(), port_, what));
}

void TcpPort::followConsumer() {
  const Found<IConnectionConsumer> now = named_.found();
  if (now.object == consumer_.get()) return;
  if (!connections_.empty()) {
    complain(Level::warning, "its consumer changed, all clients are closed.");
    closeSilent();
  }
  consumer_ = now;
}

void TcpPort::listen() {
  if (listening()) return;
  followConsumer();
  if (!framing_)
    throw Error(fmt::format("{} has no framing below it. Add one, e.g. new(\"LengthPrefixFraming\", \"{}/framing\").",
                            path(), path()));
  if (!consumer_) {
    require<IConnectionConsumer>(consumerPath_);  // says what is missing
    throw Error(fmt::format("{}.consumer = '{}' takes no connections.", path(), consumerPath_));
  }
  error_code ec;
  const auto address = boost::asio::ip::make_address(address_, ec);
  if (ec)
    throw Error(
        fmt::format("{}.address: expected an IP address such as 0.0.0.0 or ::1, found '{}'.", path(), address_));
  tcp::acceptor acceptor(*io_);
  const tcp::endpoint end(address, static_cast<unsigned short>(port_));
  const char* step = "open";
  const auto failed = [&] { return static_cast<bool>(ec); };
  acceptor.open(end.protocol(), ec);
  if (!failed()) step = "configure", acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!failed()) acceptor.non_blocking(true, ec);
  if (!failed()) step = "bind", acceptor.bind(end, ec);
  if (!failed()) step = "listen on", acceptor.listen(boost::asio::socket_base::max_listen_connections, ec);
  if (failed())
    throw Error(fmt::format("{}: cannot {} {}:{}: {}. Choose another port; 0 picks a free one.", path(), step, address_,
                            port_, ec.message()));
  port_ = acceptor.local_endpoint().port();
  acceptor_.emplace(std::move(acceptor));
  *acceptReady_ = true;
  kernel().log().info("Port {}: listening on {}:{}.", name(), address_, port_);
}

void TcpPort::watchAccept() {
  *acceptReady_ = false;
  acceptor_->async_wait(tcp::acceptor::wait_read,
                        net::MemoryHandler(acceptMemory_, [ready = acceptReady_](const error_code& ec) {
                          if (!ec) *ready = true;
                        }));
}

bool TcpPort::poll() {
  followConsumer();
  bool any = false;
  for (std::size_t i = 0; i < connections_.size(); ++i) any |= serve(*connections_[i]);
  any |= reap();
  const std::size_t old = connections_.size();
  any |= acceptAll();
  for (std::size_t i = old; i < connections_.size(); ++i) any |= serve(*connections_[i]);

  const auto now = Clock::now();
  if (now - timeoutsChecked_ >= kTimeoutCheck) {
    timeoutsChecked_ = now;
    for (auto& c : connections_)
      if (c->partialSeconds(now) > messageTimeout_)
        c->close(fmt::format("it began a message and did not finish it within {} s", messageTimeout_));
  }
  return reap() || any;
}

bool TcpPort::acceptAll() {
  if (!acceptor_ || !*acceptReady_ || Clock::now() < acceptAgain_) return false;
  for (int i = 0; i < kAcceptsPerPoll; ++i) {
    error_code ec;
    tcp::socket socket(*io_);
    acceptor_->accept(socket, ec);
    if (!ec) {
      take(std::move(socket));
    } else if (ec == boost::asio::error::would_block) {
      watchAccept();
      return i > 0;
    } else if (ec != boost::asio::error::connection_aborted && ec != boost::asio::error::interrupted) {
      complain(Level::error, fmt::format("cannot take a client: {}. Tried again in a second.", ec.message()));
      acceptAgain_ = Clock::now() + kAcceptPause;
      return i > 0;
    }
  }
  return true;
}

void TcpPort::take(tcp::socket socket) {
  error_code ignored;
  socket.set_option(tcp::socket::send_buffer_size(sendBuffer_), ignored);
  auto connection =
      std::make_shared<TcpConnection>(std::move(socket), static_cast<std::uint64_t>(connectionsSeen_ + 1), *this);
  if (!consumer_) {
    connection->close(fmt::format("nothing at '{}' takes connections", consumerPath_));
  } else if (full()) {
    connection->close(fmt::format("{} clients are connected already (maxConnections)", maxConnections_));
  } else {
    ++connectionsSeen_;
    complain(Level::debug, fmt::format("{} connected.", connection->peer()));
    connections_.push_back(connection);
    consumer_->connected(*connection);
  }
}

/// Clients that are closing give their place away already.
bool TcpPort::full() {
  const auto stays = [](const Connection& c) { return !c->closing(); };
  if (std::count_if(connections_.begin(), connections_.end(), stays) < maxConnections_) return false;
  TcpConnection* const leaves = givesWay();
  if (!leaves) return true;
  leaves->close(leaves->spoken() ? "it neither reads nor sends, and its place is needed"
                                 : "it said nothing, and its place is needed");
  return false;
}

/// Who is the least loss when the port is full, or nullptr: the oldest that never said anything where clients speak
/// first; else of those that do not read the one that has been quiet for the longest, and who never said anything
/// before all others.
TcpConnection* TcpPort::givesWay() const {
  const auto now = Clock::now();
  TcpConnection* found = nullptr;
  for (const Connection& c : connections_) {
    if (c->closing()) continue;
    if (makeRoom_ && !c->spoken()) return c.get();
    if (makeRoomAfter_ <= 0 || c->quietSeconds(now) <= makeRoomAfter_) continue;
    const auto loss = [now](const TcpConnection& x) { return std::pair(x.spoken(), -x.quietSeconds(now)); };
    if (!found || loss(*c) < loss(*found)) found = c.get();
  }
  return found;
}

bool TcpPort::serve(TcpConnection& connection) {
  bool any = false;
  for (int i = 0; i < kReadsPerPoll && connection.readable() && !connection.closing(); ++i) {
    const auto result = connection.read(scratch_);
    if (result == TcpConnection::Read::nothing) break;
    if (result == TcpConnection::Read::ended) {
      if (connection.input().empty())
        complain(Level::debug, fmt::format("{} left.", connection.peer()));
      else
        complain(Level::info, fmt::format("{} left in the middle of a message.", connection.peer()));
      connection.shut();
      break;
    }
    const bool delivered = cut(connection);
    any |= delivered;
    // It stays readable: until the next poll its next message is mostly there, and is read without asking the system
    // before. Only who waits without a message is watched.
    if (delivered && result == TcpConnection::Read::all) break;
  }
  return any;
}

bool TcpPort::cut(TcpConnection& connection) {
  const std::string_view all = connection.input();
  std::size_t at = 0;
  if (!framing_) {
    connection.close("its port has no framing below it");
    return false;
  }
  while (!connection.closing()) {
    const auto frame = framing_->take(all.substr(at), static_cast<std::size_t>(maxMessage_));
    if (frame.status == IFraming::Frame::Status::bad) connection.close("it " + frame.why);
    if (frame.status != IFraming::Frame::Status::message) break;
    at += frame.consumed;
    connection.markSpoken();
    if (!frame.message.empty()) consumer_->received(connection, frame.message);
  }
  if (at > 0) connection.markPartial(false);
  connection.consume(at);
  connection.markPartial(!connection.input().empty());
  return at > 0;
}

bool TcpPort::reap() {
  for (auto& c : connections_)
    if (c->closing()) leaving_.push_back(c);
  if (leaving_.empty()) return false;
  std::erase_if(connections_, [](const Connection& c) { return c->closing(); });
  for (auto& c : leaving_)
    if (consumer_) consumer_->disconnected(*c);
  leaving_.clear();
  return true;
}

}  // namespace spark
