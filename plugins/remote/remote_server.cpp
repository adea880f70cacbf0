#include "remote_server.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "api/credentials.h"
#include "api/descriptors.h"
#include "api/unix_socket.h"
#include "spark/error.h"

namespace spark {

namespace asio = boost::asio;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Local = asio::local::stream_protocol;

namespace {
constexpr std::size_t kMostClients = 64;
constexpr std::size_t kShortestToken = 16;

std::string textOf(const Tcp::endpoint& e) { return fmt::format("{}:{}", e.address().to_string(), e.port()); }
}  // namespace

void RemoteServer::describe(Description<RemoteServer>& d) {
  using R = RemoteServer;
  d.doc("Lets other hosts mount parts of this one's tree, and serves the mounts in it.");
  d.implements<IInputSource>();
  d.implements<IInputGate>();
  d.implements<IConnectionConsumer>();
  d.link(&R::tape_, At<IInputTape>()).doc("Records what remote hosts change, or plays it.");
  d.link(&R::simulation_, At<ISimulation>()).doc("In lockstep it waits longer for remote handlers.");
  d.link(&R::mounts_, At<Node>("/").below<IRemoteLink>());
  d.on<&R::beginCycle>(phase::kAct);
  d.on<&R::endCycle>(phase::kPublish);
  d.property("address", &R::address_).readOnly().ofProcess().doc("Where it listens; empty if it does not.");
  d.property("clients", &R::clients).ofProcess().doc("Number of hosts that are connected.");
  d.property("expect", &R::expect_)
      .range(0, 64)
      .doc("Number of hosts that must have mounted the tree, with all their handlers, before the first cycle.");
  d.property("patience", &R::patience_)
      .unit("s")
      .range(0, 60)
      .doc("How long it waits in real time for the handlers of an event on a remote host; then it goes on without.");
  d.property("lockstepPatience", &R::lockstepPatience_)
      .unit("s")
      .range(0, 3600)
      .doc("How long it waits in lockstep or as fast as possible; then the remote host is disconnected.");
  d.property("lateEvents", &R::lateEvents).ofProcess().doc("Number of events whose remote handlers were too late.");
  d.method("listen", &R::listen)
      .parameters({"address", "token"})
      .doc("Listens at host:port, or at a Unix socket, whose path has a '/'. An empty token is made up.");
  d.method("token", &R::token).doc("The token that hosts must know which connect over TCP.");
}

void RemoteServer::onLink() {
  Events& events = kernel().events();
  lost_ = &events.define(kRemoteLost, Order::parentsFirst, "A remote host has gone; data: its name, and why.");
  joined_ = &events.define(kRemoteJoined, Order::parentsFirst,
                           "A remote host has mounted a part of the tree; data: its name.");
  setPatience();
}

void RemoteServer::onUnlink() {
  sessions_.clear();
  tcp_.reset();
  if (local_) ::unlink(address_.c_str());
  local_.reset();
  address_.clear();
}

void RemoteServer::listen(const std::string& address, const Secret& secret) {
  const std::string& token = secret.text;
  if (!address_.empty()) throw Error(fmt::format("{} listens at {} already", path(), address_));
  if (!token.empty() && token.size() < kShortestToken)
    throw Error(fmt::format("expected a token of at least {} characters, found {}", kShortestToken, token.size()));
  if (tape_ && tape_->playing()) return;
  const remote::Address at = remote::Address::read(address);
  try {
    if (!at.path.empty()) return listenAt(at.path);
    token_ = token.empty() ? makeToken() : token;
    listenAt(*Tcp::resolver(io_).resolve(at.host, at.port, Tcp::resolver::passive).begin());
  } catch (const boost::system::system_error& e) {
    throw Error(fmt::format("cannot listen for remote hosts at {}", address), Error(e.code().message()));
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot listen for remote hosts at {}", address), e);
  }
}

void RemoteServer::listenAt(const Tcp::endpoint& endpoint) {
  Tcp::acceptor acceptor(io_, endpoint.protocol());
  closeOnExec(acceptor.native_handle());
  acceptor.set_option(Tcp::acceptor::reuse_address(true));
  acceptor.bind(endpoint);
  acceptor.listen();
  acceptor.non_blocking(true);
  address_ = textOf(acceptor.local_endpoint());
  tcp_.emplace(std::move(acceptor));
}

void RemoteServer::listenAt(const std::string& path) {
  Local::acceptor acceptor(io_, Local(), listenAtUnixSocket(path));
  acceptor.non_blocking(true);
  address_ = std::filesystem::absolute(path).string();
  local_.emplace(std::move(acceptor));
}

/// True if there is a place for another client. If all are taken, the one that has waited for longest without saying
/// what it wants is given up: it must not keep others out.
bool RemoteServer::makeRoom() {
  if (sessions_.size() < kMostClients) return true;
  for (const auto& session : sessions_)
    if (!session->isOpen() && !session->isLost()) {
      session->lose("it did not say what it wants, and its place is needed");
      break;
    }
  dismiss();
  return sessions_.size() < kMostClients;
}

template <class Acceptor>
void RemoteServer::acceptFrom(std::optional<Acceptor>& acceptor) {
  for (std::size_t n = 0; acceptor && n < kMostClients && acceptOne(*acceptor); ++n) {
  }
}

/// False if no client waits, or there is no place for one.
template <class Acceptor>
bool RemoteServer::acceptOne(Acceptor& acceptor) {
  // accept() creates a socket object even if no client waits; poll() costs a tenth of that.
  pollfd waiting{acceptor.native_handle(), POLLIN, 0};
  if (::poll(&waiting, 1, 0) <= 0 || !makeRoom()) return false;
  error_code ec;
  typename Acceptor::protocol_type::socket socket(io_);
  acceptor.accept(socket, ec);
  if (ec) return false;
  closeOnExec(socket.native_handle());
  std::string peer;
  if constexpr (std::is_same_v<Acceptor, Tcp::acceptor>) {
    const Tcp::endpoint from = socket.remote_endpoint(ec);
    if (ec) return true;
    peer = textOf(from);
    socket.set_option(Tcp::no_delay(true), ec);
  } else {
    peer = "this machine";
    if (!isSameUser(socket.native_handle())) {
      kernel().log().warning("a program of another user tried to open {} and was turned away", address_);
      return true;
    }
  }
  auto wire = std::make_unique<remote::Wire>(remote::Wire::Socket(std::move(socket)), peer);
  sessions_.push_back(std::make_unique<remote::Session>(host_, ++lastKey_, std::move(wire), std::move(peer)));
  return true;
}

void RemoteServer::setPatience() {
  const bool waits = simulation_ && (simulation_->lockstep() || !simulation_->paced());
  host_.patience = {waits ? lockstepPatience_ : patience_, waits};
}

void RemoteServer::poll() {
  inCycle_ = false;
  setPatience();
  acceptFrom(tcp_);
  acceptFrom(local_);
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    remote::Session& session = *sessions_[i];
    const bool wasOpen = session.isOpen();
    session.poll(local_ ? std::string() : token_);
    if (session.isOpen() && !wasOpen) {
      kernel().log().info("remote host {} ({}) has mounted a part of the tree", session.name(), session.peer());
      const Value name = session.name();
      joined_->emitAt(*this, {.name = joined_->name(), .data = &name});
    }
  }
  dismiss();
  for (std::size_t i = 0; i < mounts_.size(); ++i) mounts_.all()[i]->poll();
}

bool RemoteServer::ready(bool) {
  if (released_ || expect_ == 0 || (tape_ && tape_->playing())) return true;
  const auto n = std::count_if(sessions_.begin(), sessions_.end(), [](const auto& s) { return s->isReady(); });
  released_ = n >= expect_;
  return released_;
}

/// Says goodbye to those that were lost.
void RemoteServer::dismiss() {
  for (std::size_t i = 0; i < sessions_.size();) {
    if (!sessions_[i]->isLost()) {
      ++i;
      continue;
    }
    const std::unique_ptr<remote::Session> gone = std::move(sessions_[i]);
    sessions_.erase(sessions_.begin() + static_cast<std::ptrdiff_t>(i));
    lateEvents_ += gone->lateEvents();
    const std::string who = gone->isOpen() ? fmt::format("{} ({})", gone->name(), gone->peer()) : gone->peer();
    kernel().log().warning("remote host {} is gone: {}", who, gone->why());
    if (!gone->isOpen()) continue;
    const Value data = List{gone->name(), gone->why()};
    lost_->emitAt(*this, {.name = lost_->name(), .data = &data});
  }
}

bool RemoteServer::wait(double seconds) {
  for (const auto& mount : mounts_)
    if (mount->isPending()) return poll(), true;
  std::vector<pollfd> waited;
  const auto add = [&](int descriptor) {
    if (descriptor >= 0) waited.push_back({descriptor, POLLIN, 0});
  };
  for (const auto& mount : mounts_) add(mount->descriptor());
  for (const auto& session : sessions_) add(session->descriptor());
  if (tcp_) add(tcp_->native_handle());
  if (local_) add(local_->native_handle());
  const int ready = ::poll(waited.data(), waited.size(), static_cast<int>(std::ceil(1000 * std::max(seconds, 0.0))));
  if (ready > 0) poll();
  return ready > 0;
}

std::int64_t RemoteServer::lateEvents() const {
  std::int64_t all = lateEvents_;
  for (const auto& session : sessions_) all += session->lateEvents();
  return all;
}

remote::Session* RemoteServer::sessionOf(std::uint64_t key) {
  for (const auto& session : sessions_)
    if (session->key() == key && !session->isLost()) return session.get();
  return nullptr;
}

void RemoteServer::connected(IConnection& connection) {
  sessions_.push_back(std::make_unique<remote::Session>(host_, connection.id(), nullptr, connection.peer()));
}

void RemoteServer::received(IConnection& connection, std::string_view message) {
  if (auto* const session = sessionOf(connection.id())) session->replay(message);
}

void RemoteServer::disconnected(IConnection& connection) {
  if (auto* const session = sessionOf(connection.id())) session->lose("it left in the recorded run");
}

}  // namespace spark
