#include "comm_server.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

#include "api/credentials.h"
#include "spark/error.h"
#include "spark/printable.h"

namespace spark::spades {

namespace {
constexpr auto kRetry = std::chrono::milliseconds(100);
constexpr int kMostWait = 25;                   // ms, so that the end of an agent is noticed
constexpr double kAnswer = 5;                   // s: how long the simulator may take to answer a hello
constexpr auto kEnd = std::chrono::seconds(2);  // that agents get to end

void say(const std::string& line) {
  // Does not throw if stderr is gone. It may quote the simulator.
  std::fputs(fmt::format("sparkcomm: {}\n", printable(line)).c_str(), stderr);
  std::fflush(stderr);
}
}  // namespace

CommServer::CommServer(Options options) : options_(std::move(options)), types_(readAgentDatabase(options_.database)) {
  hello_.session = makeToken();
  hello_.token = options_.token;
  hello_.name = options_.name;
  for (const auto& [name, type] : types_) hello_.types.emplace_back(name, type.timer);
  if (!options_.logs.empty()) std::filesystem::create_directories(options_.logs);
}

bool CommServer::run() {
  while (!over_ && stopped_ == 0) {
    if (!channel_.connected()) connect();
    if (!channel_.connected()) break;
    channel_.poll();
    obey();
    report();
    channel_.poll();
    if (!channel_.connected() && !over_) say(fmt::format("the simulator is away: {}", channel_.lost()));
    wait();
  }
  endAgents();
  if (!refused_.empty()) say("refused: " + refused_);
  return over_;
}

std::unique_ptr<FrameStream> CommServer::open() const {
  addrinfo hints = {}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  if (::getaddrinfo(options_.host.c_str(), std::to_string(options_.port).c_str(), &hints, &found) != 0) return nullptr;
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool reached = ::connect(socket, found->ai_addr, found->ai_addrlen) == 0;
  ::freeaddrinfo(found);
  if (!reached) {
    ::close(socket);
    return nullptr;
  }
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return std::make_unique<FrameStream>(socket, socket);
}

/// Tries until the simulator welcomes or refuses it, or patience ends.
void CommServer::connect() {
  const auto since = Clock::now();
  const auto seconds = [&since] { return std::chrono::duration<double>(Clock::now() - since).count(); };
  while (seconds() < options_.patience && stopped_ == 0) {
    std::unique_ptr<FrameStream> stream = open();
    if (!stream) {
      std::this_thread::sleep_for(kRetry);
      continue;
    }
    hello_.received = channel_.received();
    stream->send(hello_.write());
    for (const auto sent = Clock::now();
         Clock::now() - sent < std::chrono::duration<double>(kAnswer) && stopped_ == 0;) {
      pollfd waiting{stream->input(), POLLIN, 0};
      ::poll(&waiting, 1, kMostWait);
      stream->poll();
      const auto frame = stream->receive();
      if (frame && frame->starts_with(kRefused)) {
        refused_ = frame->substr(1);
        return;
      }
      if (frame && frame->starts_with(kWelcome)) {
        const std::uint64_t received = numberOf(frame->substr(1));
        channel_.attach(std::move(stream), received);
        return;
      }
      if (!stream->lost().empty()) break;
    }
  }
  if (stopped_ == 0)
    say(fmt::format("no simulator at {}:{} for {} s", options_.host, options_.port, options_.patience));
}

/// Does what the simulator says. What makes no sense is passed over: it must not cost the agents that play.
void CommServer::obey() {
  while (const auto message = channel_.receive()) {
    try {
      obey(*message);
    } catch (const Error& e) {
      if (!std::exchange(confused_, true)) say(fmt::format("the simulator says what makes no sense: {}", e.what()));
    }
    if (over_) return;
  }
}

void CommServer::obey(std::string_view message) {
  const auto [word, rest] = splitWord(message);
  if (word == "end") {
    over_ = true;
    return;
  }
  const auto [id, text] = splitWord(rest);
  if (word == "start") {
    start(numberOf(id), text);
  } else if (word == "to") {
    const auto agent = agents_.find(numberOf(id));
    if (agent != agents_.end()) agent->second->send(text);
  }
}

/// Starts an agent; `what`: the number of it among those of its type, and the type.
void CommServer::start(std::uint64_t id, std::string_view what) {
  try {
    const auto [number, name] = splitWord(what);
    const std::string type(name);
    const auto known = types_.find(type);
    if (known == types_.end()) throw Error(fmt::format("there is no agent type '{}'", type));
    if (agents_.size() >= static_cast<std::size_t>(options_.most))
      throw Error(fmt::format("this communication server runs {} agents already (--most)", options_.most));
    const std::string log = options_.logs.empty() ? std::string() : fmt::format("{}/agent{}", options_.logs, id);
    agents_[id] = startAgent(known->second, static_cast<int>(numberOf(number)), log);
  } catch (const std::exception& e) {
    channel_.send(fmt::format("lost {} {}", id, e.what()));
  }
}

/// Tells the simulator what agents say, with the CPU time that they used in their cycle.
void CommServer::report() {
  for (auto a = agents_.begin(); a != agents_.end();) {
    AgentLink& agent = *a->second;
    agent.poll();
    while (const auto message = agent.receive())
      channel_.send(fmt::format("from {} {} {}", a->first, std::llround(std::max(0.0, message->cpuSeconds) * 1e6),
                                message->text));
    if (agent.lost().empty()) {
      ++a;
      continue;
    }
    channel_.send(fmt::format("lost {} {}", a->first, agent.lost()));
    a = agents_.erase(a);
  }
}

void CommServer::wait() const {
  std::vector<pollfd> waiting;
  for (const auto& [id, agent] : agents_) agent->addDescriptors(waiting);
  if (const FrameStream* const s = channel_.stream()) {
    s->addDescriptors(waiting);
  }
  ::poll(waiting.data(), waiting.size(), kMostWait);
}

void CommServer::endAgents() {
  for (const auto& [id, agent] : agents_) agent->send("X");
  const auto end = Clock::now() + kEnd;
  while (true) {
    std::vector<pollfd> running;
    for (const auto& [id, agent] : agents_) agent->addEnd(running);
    if (running.empty() || !waitUntil(end, running)) break;
  }
  agents_.clear();
}

}  // namespace spark::spades
