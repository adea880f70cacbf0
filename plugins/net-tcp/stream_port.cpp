#include "net-tcp/stream_port.h"

#include <algorithm>
#include <utility>

#include "api/descriptors.h"
#include "net-tcp/net_server.h"
#include "spark/error.h"

namespace spark {

namespace {
using boost::system::error_code;
using net::Clock;
using net::StreamConnection;

constexpr std::size_t kReadSize = 65536;  // bytes
constexpr int kReadsPerPoll = 4;          // per connection, so that a flooding client cannot starve others
constexpr int kAcceptsPerPoll = 64;
constexpr auto kAcceptRetryDelay = std::chrono::seconds(1);  // after an error, such as too many open files
constexpr auto kTimeoutCheckInterval = std::chrono::milliseconds(500);
}  // namespace

void StreamPort::describe(Description<StreamPort>& d) {
  d.doc(
      "Base of listening ports: splits input into messages with the framing below it and delivers them to its "
      "consumer.");
  d.abstract();
  d.link(&StreamPort::framing_, Child<IFraming>());
  d.link(&StreamPort::tape_, At<IInputTape>());
  d.link(&StreamPort::named_, At<IConnectionConsumer>(&StreamPort::consumerPath_));
  d.property("consumer", &StreamPort::consumer, &StreamPort::setConsumer)
      .doc("Path of the node that gets connections and messages.");
  d.property("maxMessage", &StreamPort::maxMessage_)
      .unit("bytes")
      .range(1, 1 << 30)
      .doc("A client that announces a longer message is closed.");
  d.property("maxConnections", &StreamPort::maxConnections_)
      .range(1, 65536)
      .doc("Further clients are disconnected at once.");
  d.property("makeRoom", &StreamPort::makeRoom_)
      .doc("When there are maxConnections clients, a new one replaces the oldest that never sent a message.");
  d.property("makeRoomAfter", &StreamPort::makeRoomAfter_)
      .unit("s")
      .min(0)
      .doc(
          "When it is full, a client that neither reads nor sends for longer than this (wall time) is closed to make "
          "room; 0: none is.");
  d.property("messageTimeout", &StreamPort::messageTimeout_)
      .unit("s")
      .min(0.001)
      .doc("A client that takes longer to finish a message it began is closed (wall clock).");
  d.property("sendBuffer", &StreamPort::sendBuffer_)
      .unit("bytes")
      .range(4096, 1 << 28)
      .doc("Send buffer of the system, which fills for a client that does not read.");
  d.property("connections", &StreamPort::connectionCount).doc("Number of clients now.");
  d.property("connectionsSeen", &StreamPort::connectionsSeen).doc("Number of clients that were ever accepted.");
  d.property("messagesDropped", &StreamPort::messagesDropped)
      .doc("Messages that were not sent because an earlier one was still unsent.");
  d.method("listen", &StreamPort::listen).doc("Opens the port; otherwise the first poll does.");
}

void StreamPort::onLink() {
  auto* server = ancestor<NetServer>();
  if (!server)
    throw Error(fmt::format("A {} lives below a NetServer, found '{}'. Create it as /sys/server/net/<name>.",
                            classObject()->name(), parent()->path()));
  io_ = server->io();
  scratch_.resize(kReadSize);
}

void StreamPort::onUnlink() {
  closeAll();
  if (acceptor_) closed();
  acceptor_.reset();
  if (!io_) return;
  io_->restart();
  io_->poll();  // runs the cancelled waits, which own connections
  io_.reset();
}

void StreamPort::closeAll() {
  for (auto& c : connections_) c->shut();
  removeClosed();
}

void StreamPort::setConsumer(std::string path) {
  consumerPath_ = std::move(path);
  named_.lookAgain();
}

void StreamPort::logLimited(Level level, std::string_view what) {
  auto& log = kernel().log();
  if (log.enabled(level)) log_.write(log, level, fmt::format("Port {} ({}): {}", name(), where(), what));
}

void StreamPort::updateConsumer() {
  const Found<IConnectionConsumer> now = named_.found();
  const bool orphaned = !consumer_ && !connections_.empty();  // their consumer was removed
  if (now.object == consumer_.get() && !orphaned) return;
  if (!connections_.empty()) {
    logLimited(Level::warning, orphaned ? fmt::format("{} was removed, all clients are closed.", consumerPath_)
                                        : std::string("its consumer changed, all clients are closed."));
    closeAll();
  }
  consumer_ = now;
}

void StreamPort::listen() {
  if (listening()) return;
  updateConsumer();
  if (!framing_)
    throw Error(fmt::format("{} has no framing below it. Add one, e.g. new(\"LengthPrefixFraming\", \"{}/framing\").",
                            path(), path()));
  if (!consumer_) {
    require<IConnectionConsumer>(consumerPath_);  // throws with the reason if there is no such node
    throw Error(fmt::format("{}.consumer = '{}' takes no connections.", path(), consumerPath_));
  }
  Acceptor acceptor(*io_);
  open(acceptor);
  acceptor_.emplace(std::move(acceptor));
  *acceptReady_ = true;
  kernel().log().info("Port {}: listening on {}.", name(), where());
}

void StreamPort::watchAccept() {
  *acceptReady_ = false;
  acceptor_->async_wait(Acceptor::wait_read,
                        net::MemoryHandler(acceptMemory_, [ready = acceptReady_](const error_code& ec) {
                          if (!ec) *ready = true;
                        }));
}

bool StreamPort::poll() {
  updateConsumer();
  bool any = false;
  for (std::size_t i = 0; i < connections_.size(); ++i) any |= readFrom(*connections_[i]);
  any |= removeClosed();
  const std::size_t old = connections_.size();
  any |= acceptAll();
  for (std::size_t i = old; i < connections_.size(); ++i) any |= readFrom(*connections_[i]);

  const auto now = Clock::now();
  if (now - timeoutsChecked_ >= kTimeoutCheckInterval) {
    timeoutsChecked_ = now;
    for (auto& c : connections_)
      if (c->partialSeconds(now) > messageTimeout_)
        c->close(fmt::format("it began a message and did not finish it within {} s", messageTimeout_));
  }
  return removeClosed() || any;
}

void StreamPort::acknowledge() {
  for (auto& c : connections_) c->acknowledge();
}

bool StreamPort::acceptAll() {
  if (!acceptor_ || !*acceptReady_ || Clock::now() < acceptAgain_) return false;
  for (int i = 0; i < kAcceptsPerPoll; ++i) {
    error_code ec;
    net::Stream::socket socket(*io_);
    acceptor_->accept(socket, ec);
    if (!ec) {
      closeOnExec(socket.native_handle());
      addConnection(std::move(socket));
    } else if (ec == boost::asio::error::would_block) {
      watchAccept();
      return i > 0;
    } else if (ec != boost::asio::error::connection_aborted && ec != boost::asio::error::interrupted) {
      logLimited(Level::error, fmt::format("cannot take a client: {}. Tried again in a second.", ec.message()));
      acceptAgain_ = Clock::now() + kAcceptRetryDelay;
      return i > 0;
    }
  }
  return true;
}

void StreamPort::addConnection(net::Stream::socket socket) {
  error_code ignored;
  socket.set_option(net::Stream::socket::send_buffer_size(sendBuffer_), ignored);
  auto connection = std::make_shared<StreamConnection>(accepted(std::move(socket)),
                                                       static_cast<std::uint64_t>(connectionsSeen_ + 1), *this);
  if (!consumer_) {
    connection->close(fmt::format("nothing at '{}' takes connections", consumerPath_));
  } else if (full()) {
    connection->close(fmt::format("{} clients are connected already (maxConnections)", maxConnections_));
  } else {
    ++connectionsSeen_;
    logLimited(Level::debug, fmt::format("{} connected.", connection->peer()));
    connections_.push_back(connection);
    put(Input::Kind::connect, *connection, connection->peer());
    consumer_->connected(*connection);
  }
}

/// True if no further client can be accepted. Closes one to make room if the properties allow it.
bool StreamPort::full() {
  const auto open = [](const Connection& c) { return !c->closing(); };
  if (std::count_if(connections_.begin(), connections_.end(), open) < maxConnections_) return false;
  StreamConnection* const evicted = connectionToEvict();
  if (!evicted) return true;
  evicted->close(evicted->spoken() ? "it neither reads nor sends, and its place is needed"
                                   : "it said nothing, and its place is needed");
  return false;
}

/// The connection to close if the port is full, or nullptr. With `makeRoom`: the oldest that never sent a message. With
/// `makeRoomAfter`: of those that do not read, one that never sent a message, then the one that was quiet for longest.
StreamConnection* StreamPort::connectionToEvict() const {
  const auto now = Clock::now();
  StreamConnection* best = nullptr;
  for (const Connection& c : connections_) {
    if (c->closing()) continue;
    if (makeRoom_ && !c->spoken()) return c.get();
    if (makeRoomAfter_ <= 0 || c->quietSeconds(now) <= makeRoomAfter_) continue;
    const auto rank = [now](const StreamConnection& x) { return std::pair(x.spoken(), -x.quietSeconds(now)); };
    if (!best || rank(*c) < rank(*best)) best = c.get();
  }
  return best;
}

/// Reads what has arrived and delivers its complete messages; true if there were any.
bool StreamPort::readFrom(StreamConnection& connection) {
  bool any = false;
  for (int i = 0; i < kReadsPerPoll && connection.readable() && !connection.closing(); ++i) {
    const auto result = connection.read(scratch_);
    if (result == StreamConnection::Read::nothing) break;
    if (result == StreamConnection::Read::ended) {
      if (connection.input().empty())
        logLimited(Level::debug, fmt::format("{} left.", connection.peer()));
      else
        logLimited(Level::info, fmt::format("{} left in the middle of a message.", connection.peer()));
      connection.shut();
      break;
    }
    const bool delivered = deliverMessages(connection);
    any |= delivered;
    // The connection stays readable: by the next poll its next message has usually arrived, and is read without a wait
    // in between. Only a connection without input is watched.
    if (delivered && result == StreamConnection::Read::all) break;
  }
  return any;
}

/// Splits the input into messages and delivers them; true if there were any.
bool StreamPort::deliverMessages(StreamConnection& connection) {
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
    if (frame.message.empty()) continue;
    if (!consumer_) {
      connection.close(fmt::format("nothing at '{}' takes messages", consumerPath_));
      break;
    }
    put(Input::Kind::message, connection, frame.message);
    consumer_->received(connection, frame.message);
  }
  if (at > 0) connection.markPartial(false);
  connection.consume(at);
  connection.markPartial(!connection.input().empty());
  return at > 0;
}

/// Writes an input to the tape. While one is played, the network server keeps ports closed.
void StreamPort::put(Input::Kind kind, const StreamConnection& connection, std::string_view text) {
  if (tape_) tape_->put({.kind = kind, .place = path(), .key = connection.id(), .text = text});
}

/// Removes closed connections and notifies the consumer; true if there were any.
bool StreamPort::removeClosed() {
  for (auto& c : connections_)
    if (c->closing()) closed_.push_back(c);
  if (closed_.empty()) return false;
  std::erase_if(connections_, [](const Connection& c) { return c->closing(); });
  for (auto& c : closed_) {
    if (!consumer_) continue;
    put(Input::Kind::leave, *c);
    consumer_->disconnected(*c);
  }
  closed_.clear();
  return true;
}

}  // namespace spark
