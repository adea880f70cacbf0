#include "control_server.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>

#include "api/credentials.h"
#include "api/descriptors.h"
#include "api/unix_socket.h"
#include "socket_path.h"
#include "spark/error.h"
#include "spark/plugin.h"

// Only the user that runs the simulation may connect: the socket (0600) is in a folder that only the user can enter
// (0700), and the peer's user id of each connection is checked. If no socket can be opened, the simulation runs without
// one and logs a warning.

namespace spark {

namespace {
constexpr std::size_t kMaxClients = 16;
}  // namespace

void ControlServer::describe(Description<ControlServer>& d) {
  d.doc("The local socket of sparkctl; only the user of the host can open it.");
  d.implements<IInputSource>();
  d.implements<IRequests>();
  d.property("socket", &ControlServer::socket).doc("Path of the socket; empty if there is none.");
  d.property("clients", &ControlServer::clients).doc("Number of connected programs.");
}

void ControlServer::onLink() {
  try {
    open();
  } catch (const std::exception& e) {
    kernel().log().warning("no control socket, sparkctl cannot reach this simulation: {}", e.what());
  }
}

void ControlServer::open() {
  const auto folder = control::socketFolder();
  control::removeStale(folder);
  const auto file = control::freeSocket(folder);
  Protocol::acceptor acceptor(io_, Protocol(), listenAtUnixSocket(file.string()));
  acceptor.non_blocking(true);
  acceptor_.emplace(std::move(acceptor));
  socket_ = file.string();
}

void ControlServer::onUnlink() {
  clients_.clear();
  acceptor_.reset();
  if (!socket_.empty()) ::unlink(socket_.c_str());
  socket_.clear();
}

void ControlServer::accept() {
  if (!acceptor_) return;
  // accept() creates a socket object even if no client waits; poll() costs a tenth of that.
  pollfd waiting{acceptor_->native_handle(), POLLIN, 0};
  if (::poll(&waiting, 1, 0) <= 0) return;
  if (clients_.size() >= kMaxClients) {
    // One that asks nothing must not keep others out.
    const auto silent = std::find_if(clients_.begin(), clients_.end(), [](const auto& c) { return !c->hasAsked(); });
    if (silent == clients_.end()) return;
    clients_.erase(silent);
  }
  boost::system::error_code ec;
  Protocol::socket socket(io_);
  acceptor_->accept(socket, ec);
  if (ec) return;
  closeOnExec(socket.native_handle());
  if (isSameUser(socket.native_handle()))
    clients_.push_back(std::make_unique<control::ControlClient>(std::move(socket)));
  else
    kernel().log().warning("a program of another user tried to open {} and was turned away", socket_);
}

void ControlServer::poll() {
  for (const auto& child : children())
    if (auto handler = child->as<IRequestHandler>()) handler->poll();
  accept();
  std::erase_if(clients_, [this](const auto& client) { return !client->serve(kernel(), *this); });
}

std::string ControlServer::answer(std::string_view request, control::Watch& watch, bool mayChange) {
  return control::answer(kernel(), *this, request, watch, mayChange);
}

std::string ControlServer::nextOf(control::Watch& watch, bool& done) { return control::nextOf(kernel(), watch, done); }

}  // namespace spark

SPARK_PLUGIN("control", "1.0", "The local control socket for sparkctl.", spark::ControlServer)
