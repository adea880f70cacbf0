#include "comm_port.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>

#include "api/credentials.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::spades {

namespace {
using Clock = std::chrono::steady_clock;
constexpr std::size_t kMostNewcomers = 64;
constexpr std::chrono::seconds kHelloTime{5};  // within which a newcomer has to say hello
}  // namespace

/// An agent that a communication server runs.
class RemoteAgent final : public AgentLink {
 public:
  RemoteAgent(CommPort::Server& server, int id) : server_(server), id_(static_cast<std::uint64_t>(id)) {
    server_.agents_[id_] = this;
  }
  ~RemoteAgent() override { server_.agents_.erase(id_); }
  void send(std::string_view message) override { server_.channel_.send(fmt::format("to {} {}", id_, message)); }
  void poll() override {}  // the port does
  std::optional<Message> receive() override {
    if (messages_.empty()) return std::nullopt;
    Message m = std::move(messages_.front());
    messages_.pop_front();
    return m;
  }
  std::string countInstructions() override {
    return "communication servers measure CPU time, not instructions; use CpuThinkTime, or the timer 'jiffies', "
           "instead";
  }
  const std::string& lost() const override { return lost_; }
  bool reachable() const override { return server_.connected(); }
  void addEnd(std::vector<pollfd>&) const override {}  // its server ends it
  void addDescriptors(std::vector<pollfd>&) const override {}

  void put(Message message) { messages_.push_back(std::move(message)); }
  void lose(std::string why) {
    if (lost_.empty()) lost_ = std::move(why);
  }

 private:
  CommPort::Server& server_;
  const std::uint64_t id_;
  std::deque<Message> messages_;
  std::string lost_;
};

const std::string* CommPort::Server::timerOf(const std::string& type) const {
  for (const auto& [name, timer] : hello_.types)
    if (name == type) return &timer;
  return nullptr;
}

CommPort::CommPort(const std::string& address, int port, std::string token, Log& log)
    : token_(std::move(token)), log_(log) {
  sockaddr_in at = {};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    throw Error(fmt::format("expected an IPv4 address for communication servers such as 0.0.0.0, found '{}'", address));
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  socklen_t size = sizeof at;
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&at), size) != 0 || ::listen(listener_, SOMAXCONN) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
    const int error = errno;
    ::close(listener_);
    throw Error(
        fmt::format("cannot listen for communication servers at {}:{}: {}", address, port, std::strerror(error)));
  }
  port_ = ntohs(at.sin_port);
}

CommPort::~CommPort() { ::close(listener_); }

void CommPort::poll(double patience, bool open) {
  accept();
  greet(open);
  for (const auto& [session, server] : servers_) {
    const bool was = server->connected();
    try {
      server->channel_.poll();
      dispatch(*server);
    } catch (const std::exception& e) {
      server->channel_.close(e.what());
    }
    if (was && !server->connected() && !over_) {
      server->goneAt_ = Clock::now();
      log_.warning("Communication server {} is away: {}.", server->name(), server->channel_.lost());
    }
    checkAway(*server, patience);
  }
}

void CommPort::accept() {
  for (std::size_t n = 0; n < kMostNewcomers; ++n) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    // One that says nothing must not keep others out.
    if (newcomers_.size() == kMostNewcomers) newcomers_.erase(newcomers_.begin());
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    newcomers_.push_back({std::make_unique<FrameStream>(socket, socket), Clock::now()});
  }
}

void CommPort::greet(bool open) {
  for (auto& [stream, since] : newcomers_) {
    stream->poll();
    if (const auto frame = stream->receive()) {
      try {
        welcome(stream, *frame, open);
      } catch (const std::exception& e) {
        log_.warning("A communication server is refused: {}", e.what());
        stream->send(std::string(1, kRefused) + e.what());
        stream.reset();
      }
    } else if (!stream->lost().empty() || Clock::now() - since > kHelloTime) {
      stream.reset();
    }
  }
  std::erase_if(newcomers_, [](const Newcomer& n) { return !n.stream; });
}

void CommPort::welcome(std::unique_ptr<FrameStream>& stream, std::string_view frame, bool open) {
  const CommHello hello = CommHello::read(frame);
  if (!token_.empty() && !isToken(token_, hello.token)) throw Error("its token is wrong");
  const auto known = servers_.find(hello.session);
  if (known == servers_.end() && !open) throw Error("the agents are started already");
  if (known != servers_.end() && known->second->given_) throw Error("it was away for too long, its agents are lost");
  if (known == servers_.end()) expectNewName(hello.name);
  Server& server =
      known != servers_.end() ? *known->second : *(servers_[hello.session] = std::make_unique<Server>(hello));
  log_.info("Communication server {} {}.", server.name(), known == servers_.end() ? "is there" : "is back");
  stream->send(fmt::format("{}{}", kWelcome, server.channel_.received()));
  server.channel_.attach(std::move(stream), hello.received);
}

/// Names decide which server starts which agent. One that went away before the start may come again.
void CommPort::expectNewName(const std::string& name) {
  const auto same =
      std::find_if(servers_.begin(), servers_.end(), [&](const auto& s) { return s.second->name() == name; });
  if (same == servers_.end()) return;
  if (same->second->connected())
    throw Error(fmt::format("there is a server '{}' already: give this one another --name", name));
  servers_.erase(same);
}

/// Passes what a server says about its agents on.
void CommPort::dispatch(Server& server) {
  while (const auto message = server.channel_.receive()) {
    const auto [word, rest] = splitWord(*message);
    const auto [id, text] = splitWord(rest);
    const auto agent = server.agents_.find(numberOf(id));
    if (agent == server.agents_.end()) continue;  // it is removed
    if (word == "from") {
      const auto [time, words] = splitWord(text);
      agent->second->put({std::string(words), 1e-6 * static_cast<double>(numberOf(time))});
    } else if (word == "lost") {
      agent->second->lose(std::string(text));
    }
  }
}

void CommPort::checkAway(Server& server, double patience) {
  if (server.connected() || server.given_) return;
  if (std::chrono::duration<double>(Clock::now() - server.goneAt_).count() < patience) return;
  server.given_ = true;
  for (const auto& [id, agent] : server.agents_)
    agent->lose(fmt::format("its communication server {} is away for more than {} s", server.name(), patience));
}

std::vector<CommPort::Server*> CommPort::servers() const {
  std::vector<Server*> out;
  for (const auto& [session, server] : servers_) out.push_back(server.get());
  std::sort(out.begin(), out.end(), [](const Server* a, const Server* b) { return a->name() < b->name(); });
  return out;
}

std::unique_ptr<AgentLink> CommPort::start(Server& server, int id, const std::string& type, int number) {
  auto agent = std::make_unique<RemoteAgent>(server, id);
  server.channel_.send(fmt::format("start {} {} {}", id, number, type));
  return agent;
}

bool CommPort::hasServers() const {
  return std::any_of(servers_.begin(), servers_.end(), [](const auto& s) { return s.second->connected(); });
}

void CommPort::end() {
  over_ = true;
  for (const auto& [session, server] : servers_) {
    server->channel_.send("end");
    server->channel_.poll();
  }
}

void CommPort::addDescriptors(std::vector<pollfd>& out) const {
  out.push_back({listener_, POLLIN, 0});
  for (const Newcomer& n : newcomers_) n.stream->addDescriptors(out);
  for (const auto& [session, server] : servers_)
    if (const FrameStream* const s = server->channel_.stream()) s->addDescriptors(out);
}

}  // namespace spark::spades
