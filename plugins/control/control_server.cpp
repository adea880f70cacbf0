#include "control_server.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "socket_place.h"
#include "spark/error.h"
#include "spark/plugin.h"

// Who may talk to a house: its own user. The socket lies in a folder that only the user can enter (0700), is itself
// 0600, and the peer's uid is asked of the system for every connection. A house that cannot have a socket runs without
// one and says so.

namespace spark {

namespace {
constexpr std::size_t kMaxClients = 16;

bool sameUser(int descriptor) {
  struct ucred peer = {};
  socklen_t size = sizeof peer;
  return getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}
}  // namespace

void ControlServer::describe(Description<ControlServer>& d) {
  d.doc("The local socket of sparkctl; only the host's own user can open it.");
  d.implements<IInputSource>();
  d.implements<IRequests>();
  d.property("socket", &ControlServer::socket).doc("The socket's file; empty when there is none.");
  d.property("clients", &ControlServer::clients).doc("Programs connected now.");
}

void ControlServer::onLink() {
  try {
    open();
  } catch (const std::exception& e) {
    kernel().log().warning("no control socket, sparkctl cannot reach this house: {}", e.what());
  }
}

void ControlServer::open() {
  const auto folder = control::socketFolder();
  control::sweep(folder);
  const auto file = control::freeSocket(folder);
  Protocol::acceptor acceptor(io_);
  acceptor.open();
  acceptor.bind(Protocol::endpoint(file.string()));
  chmod(file.c_str(), 0600);
  acceptor.listen();
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
  if (!acceptor_ || clients_.size() >= kMaxClients) return;
  // Accepting makes a socket before it finds that nobody is there; asking first costs a tenth.
  pollfd door{acceptor_->native_handle(), POLLIN, 0};
  if (::poll(&door, 1, 0) <= 0) return;
  boost::system::error_code ec;
  Protocol::socket socket(io_);
  acceptor_->accept(socket, ec);
  if (ec) return;
  if (sameUser(socket.native_handle()))
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
