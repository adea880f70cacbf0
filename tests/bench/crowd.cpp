#include "crowd.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <optional>
#include <sstream>

#include "spark/error.h"

namespace spark::bench {

/// The connection of an agent, or of a monitor, which sends nothing.
struct Crowd::Client {
  Client(int port, std::optional<Dialogue> messages)
      : socket(::socket(AF_INET, SOCK_STREAM, 0)), dialogue(std::move(messages)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
      throw Error(fmt::format("cannot connect to port {}", port));
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    sendNext();
  }
  ~Client() { close(socket); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void sendNext() {
    if (!dialogue) return;
    const std::string_view text = dialogue->say(received++);
    const std::uint32_t size = htonl(static_cast<std::uint32_t>(text.size()));
    out.assign(reinterpret_cast<const char*>(&size), sizeof size).append(text);
    if (::send(socket, out.data(), out.size(), MSG_NOSIGNAL) < 0)
      return;  // the host has ended, which the next read detects
  }
  /// Processes `n` received bytes; true if they complete a message.
  bool take(const char* bytes, std::size_t n) {
    bool whole = false;
    while (n > 0) {
      const std::size_t part = headed < sizeof head ? 1 : std::min(n, missing);
      if (headed < sizeof head) {
        head[headed++] = *bytes;
        std::uint32_t size = 0;
        std::memcpy(&size, head, sizeof size);
        missing = ntohl(size);
      } else {
        missing -= part;
      }
      bytes += part, n -= part;
      if (headed == sizeof head && missing == 0) headed = 0, whole = true;
    }
    return whole;
  }

  int socket;
  std::optional<Dialogue> dialogue;
  std::int64_t received = 0;
  char head[4] = {};
  std::size_t headed = 0, missing = 0;
  std::string out;
};

namespace {
void watch(int events, int fd, void* data) {
  epoll_event e{};
  e.events = EPOLLIN;
  e.data.ptr = data;
  epoll_ctl(events, EPOLL_CTL_ADD, fd, &e);
}
}  // namespace

Crowd::Crowd(const World& world, int line) : world_(world), line_(line), events_(epoll_create1(0)) {
  watch(events_, line_, nullptr);
}

Crowd::~Crowd() { close(events_); }

void Crowd::add(std::unique_ptr<Client> client) {
  watch(events_, client->socket, client.get());
  clients_.push_back(std::move(client));
}

void Crowd::execute(const std::string& command) {
  std::istringstream in(command);
  std::string word;
  in >> word;
  if (word == "open") in >> agentPort_ >> monitorPort_;
  if (word == "admit") add(std::make_unique<Client>(agentPort_, Dialogue(world_, agents_++)));
  if (word == "watch") add(std::make_unique<Client>(monitorPort_, std::nullopt));
  if (write(line_, "+", 1) != 1) over_ = true;
}

void Crowd::readCommands() {
  char buffer[256];
  const ssize_t n = read(line_, buffer, sizeof buffer);
  if (n <= 0)
    over_ = true;
  else
    commands_.append(buffer, static_cast<std::size_t>(n));
  for (std::size_t end; !over_ && (end = commands_.find('\n')) != std::string::npos; commands_.erase(0, end + 1))
    execute(commands_.substr(0, end));
}

void Crowd::receive(Client& client) {
  static char buffer[65536];
  const ssize_t n = recv(client.socket, buffer, sizeof buffer, MSG_DONTWAIT);
  if (n <= 0)
    epoll_ctl(events_, EPOLL_CTL_DEL, client.socket, nullptr);
  else if (client.take(buffer, static_cast<std::size_t>(n)))
    client.sendNext();
}

void Crowd::serve() {
  epoll_event ready[64];
  while (!over_) {
    const int n = epoll_wait(events_, ready, 64, -1);
    for (int i = 0; i < n; ++i)
      if (auto* client = static_cast<Client*>(ready[i].data.ptr))
        receive(*client);
      else
        readCommands();
  }
}

}  // namespace spark::bench
