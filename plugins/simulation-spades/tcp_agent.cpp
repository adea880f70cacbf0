#include "tcp_agent.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "connected_program.h"
#include "spark/error.h"

namespace spark::spades {

namespace {
/// Listens on this machine for one connection, at any free port.
std::pair<int, int> listenForOne() {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) throw Error(fmt::format("cannot make a socket: {}", std::strerror(errno)));
  sockaddr_in at = {};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  if (::bind(listener, reinterpret_cast<const sockaddr*>(&at), size) != 0 || ::listen(listener, 16) != 0 ||
      ::getsockname(listener, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
    const int error = errno;
    ::close(listener);
    throw Error(fmt::format("cannot listen for an agent: {}", std::strerror(error)));
  }
  return {listener, ntohs(at.sin_port)};
}

/// What a message that waits takes, also an empty one.
std::size_t memoryOf(std::string_view message) { return message.size() + sizeof(std::string); }

std::string replaced(std::string text, std::string_view what, int by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos;) text.replace(at, what.size(), std::to_string(by));
  return text;
}

/// What follows the two times of a sensation.
std::string_view perceptsOf(std::string_view sensation) {
  for (int i = 0; i < 2; ++i) sensation.remove_prefix(std::min(sensation.find(' '), sensation.size() - 1) + 1);
  return sensation;
}
}  // namespace

TcpAgent::TcpAgent(const AgentType& type, int number, const std::string& log) : ends_(type.ends) {
  int port = 0;
  std::tie(listener_, port) = listenForOne();
  std::vector<std::string> command;
  for (const std::string& word : type.command)
    command.push_back(replaced(replaced(word, "{port}", port), "{number}", number));
  try {
    program_ = std::make_unique<AgentProgram>(type, command, log, std::vector<AgentProgram::Descriptor>());
  } catch (...) {
    ::close(listener_);
    throw;
  }
}

TcpAgent::~TcpAgent() {
  if (listener_ >= 0) ::close(listener_);
}

void TcpAgent::send(std::string_view message) {
  if (message == "D") {
    asked_ = true;
  } else if (message == "X") {
    connection_.reset();
    if (lost_.empty()) lost_ = "it was told to end";
  } else if (message.starts_with('K')) {  // which an agent must answer
    cycle_ = Cycle::done;
  } else if (message.starts_with('S')) {
    program_->beginThought();
    const std::string_view percepts = perceptsOf(message);
    const bool first = !std::exchange(begun_, true);
    cycle_ = first ? Cycle::first : percepts.empty() || !connection_ ? Cycle::done : Cycle::open;
    if (cycle_ == Cycle::open) connection_->send(percepts);
  }
  // It requests no times and does not ask for its think time.
}

void TcpAgent::poll() {
  if (!lost_.empty()) return;
  if (!connection_) accept();
  if (connection_) {
    connection_->poll();
    keepMessages();
  } else if (program_->ended()) {
    lost_ = "its program has ended without connecting";
    if (strangers_ > 0) lost_ += fmt::format(" ({} connections of other programs were refused)", strangers_);
  }
}

void TcpAgent::accept() {
  int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  // Any program of the machine can connect, that of an opponent, too.
  while (socket >= 0 && !isConnectedTo(socket, program_->group())) {
    ::close(socket);
    ++strangers_;
    socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  }
  if (socket < 0) return;
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  connection_ = std::make_unique<FrameStream>(socket, socket);
  ::close(std::exchange(listener_, -1));
}

void TcpAgent::keepMessages() {
  while (const auto frame = connection_->receive()) {
    bytes_ += memoryOf(*frame);
    messages_.emplace_back(*frame);
  }
  if (bytes_ > FrameStream::kMost)
    lost_ = fmt::format("it has sent more than {} bytes that no percept asked for", FrameStream::kMost);
}

std::optional<AgentLink::Message> TcpAgent::receive() {
  if (asked_ && !ready_ && !messages_.empty()) {
    ready_ = true;
    return program_->measured("I");
  }
  if (cycle_ == Cycle::done) {
    cycle_ = Cycle::none;
    return program_->measured("D");
  }
  if (cycle_ == Cycle::none || messages_.empty()) return std::nullopt;
  const std::string text = std::move(messages_.front());
  messages_.pop_front();
  bytes_ -= memoryOf(text);
  if (cycle_ == Cycle::first || text.find(ends_) != text.npos) cycle_ = Cycle::done;
  return program_->measured("A" + text);
}

void TcpAgent::addDescriptors(std::vector<pollfd>& out) const {
  if (connection_)
    connection_->addDescriptors(out);
  else if (listener_ >= 0)
    out.push_back({listener_, POLLIN, 0});
}

}  // namespace spark::spades
