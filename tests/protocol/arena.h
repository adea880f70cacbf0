#pragma once
/// \file
/// A simulation with network, parsers and game control, robots made of test doubles, and TCP clients, all in one
/// thread. A client that waits for bytes polls the server meanwhile, so no test sleeps or depends on timing.

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <optional>

#include "api/agents.h"
#include "api/match.h"
#include "api/unix_socket.h"
#include "test_support.h"

namespace spark::test {

/// The actions of the robots, in order: "3 he1 1.5".
inline std::vector<std::string>& actionLog() {
  static std::vector<std::string> list;
  return list;
}

/// `(time (now t))`, which every robot has.
class TestClock : public Perceptor {
  SPARK_CLASS(TestClock, Perceptor)
 public:
  static void describe(Description<TestClock>& d) { d.doc("Tells the time."); }
  void sense(Predicates& out, const Event& event) override {
    out.open("time").open("now").add(event.time).close().close();
  }
};

/// `(cnt n)` in every third cycle.
class TestVision : public Perceptor {
  SPARK_CLASS(TestVision, Perceptor)
 public:
  TestVision() { interval_ = 3; }
  static void describe(Description<TestVision>& d) { d.doc("Senses in every third cycle."); }
  void sense(Predicates& out, const Event&) override { out.open("vision").close(); }
};

/// A long text, for clients that do not read.
class TestNoise : public Perceptor {
  SPARK_CLASS(TestNoise, Perceptor)
 public:
  static void describe(Description<TestNoise>& d) { d.doc("Writes 60 KB."); }
  void sense(Predicates& out, const Event&) override { out.open("noise").add(std::string(60000, 'x')).close(); }
};

/// Logs the values that it receives.
class TestMotor : public Effector {
  SPARK_CLASS(TestMotor, Effector)
 public:
  static void describe(Description<TestMotor>& d) { d.doc("Notes its commands."); }
  std::string act(const Element& action) override {
    if (!action.at(1)) return "expected a number, found none";
    actionLog().push_back(fmt::format("{} {} {}", agent()->outermost().number(), name(), action.at(1).number()));
    return {};
  }
};

/// `(init (unum n)(teamname t))`.
class TestInit : public Effector {
  SPARK_CLASS(TestInit, Effector)
 public:
  static void describe(Description<TestInit>& d) { d.doc("Records the team and number of the agent."); }
  std::string predicate() const override { return "init"; }
  std::string act(const Element& action) override {
    const Element team = action.named("teamname"), unum = action.named("unum");
    actionLog().push_back(fmt::format("{} init {} {}", agent()->outermost().number(), team ? team.at(1).text() : "",
                                      unum ? unum.at(1).integer() : 0));
    return {};
  }
};

/// Reads the team and number from `(init ...)`.
class TestNames : public Node, public IJoinPolicy {
  SPARK_CLASS(TestNames, Node)
 public:
  static void describe(Description<TestNames>& d) {
    d.doc("Reads team and number.");
    d.implements<IJoinPolicy>();
  }
  std::string_view predicate() const override { return "init"; }
  Name read(const Element& action) const override {
    const Element team = action.named("teamname"), unum = action.named("unum");
    return {team ? team.at(1).text() : std::string_view(), unum ? unum.at(1).integer() : 0};
  }
};

/// `(syn)`.
class TestSync : public Effector, public ISyncEffector {
  SPARK_CLASS(TestSync, Effector)
 public:
  static void describe(Description<TestSync>& d) {
    d.doc("Answers in lockstep.");
    d.implements<ISyncEffector>();
  }
  std::string predicate() const override { return "syn"; }
  std::string act(const Element&) override { return {}; }
};

/// A scene server with built-in files: "robot", "mute" (no syn effector), "loud" (large percepts). All other names are
/// errors.
class TestScenes : public Node, public ISceneServer {
  SPARK_CLASS(TestScenes, Node)
 public:
  static void describe(Description<TestScenes>& d) {
    d.doc("Builds test robots.");
    d.implements<ISceneServer>();
  }
  Leaf& leaf() override { return *this; }
  Node* activeScene() override { return kernel().root().find<Node>("/usr/scene"); }
  Node& scene() override { return kernel().root().require<Node>("/usr/scene"); }
  void importScene(std::string_view file, Node& root, const List& arguments) override {
    root.create("TestClock", "clock");
    if (file == "broken") throw Error("broken:3:1: expected ')', found the end of the file");
    if (file != "robot" && file != "mute" && file != "loud")
      throw Error("The scene '" + std::string(file) + "' does not exist.");
    root.create("TestVision", "vision");
    if (file == "loud") root.create("TestNoise", "noise");
    root.create("TestMotor", "he1");
    root.create("TestMotor", "he2");
    root.create("TestInit", "init");
    if (file != "mute") root.create("TestSync", "syn");
    for (const Value& v : arguments) actionLog().push_back("argument " + v.text());
  }
  void markModified() override { ++modified_; }
  std::uint64_t modifiedCount() const override { return modified_; }
  void place() override {}
  void placeScene(Node&) override {}
  const std::vector<Import>& imports() const override { return imports_; }

 private:
  std::uint64_t modified_ = 0;
  std::vector<Import> imports_;
};

class Arena;

/// A client of one port.
class Client {
 public:
  Client(Arena& arena, int port);
  /// Connects to a Unix socket.
  Client(Arena& arena, const std::string& file);
  Client(Client&& other) noexcept
      : arena_(other.arena_), fd_(std::exchange(other.fd_, -1)), in_(std::move(other.in_)) {}
  ~Client() { leave(); }
  void leave() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  /// Sends a message with its length prefix.
  void send(std::string_view message) {
    const auto n = htonl(static_cast<std::uint32_t>(message.size()));
    std::string bytes(reinterpret_cast<const char*>(&n), 4);
    bytes += message;
    raw(bytes);
  }
  /// Sends a message in two writes: its length prefix, then the rest.
  void sendInTwoWrites(std::string_view message) {
    const auto n = htonl(static_cast<std::uint32_t>(message.size()));
    raw({reinterpret_cast<const char*>(&n), 4});
    raw(message);
  }
  /// Sends raw bytes. Polls the server when it has to make room. Stops when the server has closed the connection.
  void raw(std::string_view bytes);
  /// Switches Nagle's algorithm on, as it is for sockets by default: while sent bytes are not acknowledged, small
  /// writes wait in the client.
  void useNagle() const {
    const int off = 0;
    ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &off, sizeof off);
  }
  /// Returns when all sent bytes have arrived, so that the server's next poll reads them.
  void arrive() const;
  /// The next message; polls the server until it arrives. Empty if the connection was closed.
  std::optional<std::string> receive();
  /// All bytes that have arrived, at least `n` unless the connection was closed; polls the server meanwhile.
  std::string receiveBytes(std::size_t n);
  /// The messages that have arrived, without waiting.
  std::vector<std::string> drain();
  /// Waits until the server closes the connection; returns true when it has.
  bool closed();
  /// The local address, by which the log names this client.
  std::string name() const;

 private:
  bool take();
  std::optional<std::string> pop();
  Arena& arena_;
  int fd_ = -1;
  std::string in_;
  bool ended_ = false;
};

/// The simulation. The test drives its phases.
class Arena {
 public:
  TestHost host;
  Kernel& kernel = host.kernel;
  IInputSource* net = nullptr;
  IInputGate* gate = nullptr;
  IGameControl* control = nullptr;
  const bool lockstep;

  explicit Arena(bool waitsForAgents = false) : lockstep(waitsForAgents) {
    actionLog().clear();
    kernel.registerClass<SceneNode>();
    kernel.registerClass<Transform>();
    for (const char* plugin : {"net-tcp", "gamecontrol", "parser-sexp", "parser-json"}) kernel.plugins().use(plugin);
    kernel.registerClass<TestClock>();
    kernel.registerClass<TestVision>();
    kernel.registerClass<TestNoise>();
    kernel.registerClass<TestMotor>();
    kernel.registerClass<TestInit>();
    kernel.registerClass<TestNames>();
    kernel.registerClass<TestSync>();
    kernel.registerClass<TestScenes>();
    auto& events = kernel.events();
    events.define(phase::kAct, Order::parentsFirst, "act");
    events.define(phase::kPrepare, Order::childrenFirst, "prepare");
    events.define(phase::kSense, Order::parentsFirst, "sense");
    events.define(phase::kPublish, Order::parentsFirst, "publish");
    kernel.create("TestScenes", "/sys/server/scene");
    kernel.create("Node", "/usr/scene");
    Leaf& server = kernel.create("GameControl", "/sys/server/gamecontrol");
    setProperty(server, "robotFolder", "");
    // Wall-clock limits are off, unless a test sets them.
    for (const char* limit : {"syncTimeout", "joinWait", "idleLimit"}) setProperty(server, limit, 0);
    gate = server.as<IInputGate>();
    control = server.as<IGameControl>();
    kernel.create("SexpParser", "/sys/server/gamecontrol/parser");
    kernel.create("TestNames", "/sys/server/gamecontrol/names");
    net = &kernel.create<IInputSource>("NetServer", "/sys/server/net");
    addPort("agents");
  }
  /// Adds a port of game control on a free port number.
  void addPort(const std::string& name, const std::string& parser = {}) {
    kernel.create("TcpPort", "/sys/server/net/" + name);
    kernel.create("LengthPrefixFraming", "/sys/server/net/" + name + "/framing");
    if (!parser.empty()) kernel.create(parser, "/sys/server/net/" + name + "/parser");
  }
  Leaf& port(const std::string& name = "agents") { return *kernel.root().find("/sys/server/net/" + name); }
  int portNumber(const std::string& name = "agents") {
    callMethod(port(name), "listen", {});
    return static_cast<int>(getProperty(port(name), "port").toInteger());
  }
  Client client(const std::string& name = "agents") { return Client(*this, portNumber(name)); }
  void set(const char* name, Value v) { setProperty(*kernel.root().find("/sys/server/gamecontrol"), name, v); }
  /// Sets a property of the agents' timing, which is created if there is none.
  void setTiming(const char* name, Value v) {
    constexpr const char* kTiming = "/sys/server/gamecontrol/timing";
    Leaf* const timing = kernel.root().find(kTiming);
    setProperty(timing ? *timing : kernel.create("AgentTiming", kTiming), name, std::move(v));
  }
  Value get(const char* name) { return getProperty(*kernel.root().find("/sys/server/gamecontrol"), name); }
  std::size_t agents() const { return control->agents().size(); }

  /// Reads input and runs one cycle, even if the gate is closed.
  void cycle() {
    net->poll();
    run();
  }
  /// Like a run loop: reads input, then runs one cycle if the gate is open.
  bool step() {
    net->poll();
    if (!gate->ready(lockstep)) return false;
    net->poll();
    run();
    return true;
  }
  /// Polls and runs cycles until `done`; fails after kPatience.
  void until(const std::function<bool()>& done, bool cycles = true) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!done()) {
      if (cycles)
        step();
      else
        net->poll();
      if (std::chrono::steady_clock::now() > end) throw Error("The test waited in vain. The log:\n" + host.text);
      net->wait(0.0005);
    }
  }
  bool logged(std::string_view text) const { return host.text.find(text) != std::string::npos; }
  std::int64_t cycles() const { return cycle_; }

 private:
  void run() {
    Event event;
    event.step = 0.02;
    event.cycle = ++cycle_;
    event.time = static_cast<double>(cycle_ - 1) * 0.02;
    emit(phase::kAct, event);
    emit(phase::kPrepare, event);
    event.time += event.step;
    emit(phase::kSense, event);
    emit(phase::kPublish, event);
  }
  void emit(ChannelName channel, Event& event) {
    event.name = channel;
    kernel.events().channel(channel).emit(event);
  }
  std::int64_t cycle_ = 0;
};

inline Client::Client(Arena& arena, int port) : arena_(arena), fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
    throw Error(std::string("connect: ") + std::strerror(errno));
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

inline Client::Client(Arena& arena, const std::string& file) : arena_(arena), fd_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
  const sockaddr_un to = unix_socket::addressOf(file);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    throw Error(std::string("connect: ") + std::strerror(errno));
}

inline std::string Client::name() const {
  sockaddr_in self{};
  socklen_t n = sizeof self;
  ::getsockname(fd_, reinterpret_cast<sockaddr*>(&self), &n);
  return "127.0.0.1:" + std::to_string(ntohs(self.sin_port));
}

inline void Client::raw(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (errno == EAGAIN)
      arena_.net->poll();
    else
      return;
  }
}

inline void Client::arrive() const {
  arena_.until(
      [this] {
        int unacknowledged = 0;
        ::ioctl(fd_, SIOCOUTQ, &unacknowledged);
        return unacknowledged == 0;
      },
      false);
}

inline bool Client::take() {
  char buffer[65536];
  const auto n = ::recv(fd_, buffer, sizeof buffer, MSG_DONTWAIT);
  if (n > 0)
    in_.append(buffer, static_cast<std::size_t>(n));
  else if (n == 0 || errno != EAGAIN)
    ended_ = true;
  return n > 0;
}

inline std::optional<std::string> Client::pop() {
  std::uint32_t n = 0;
  if (in_.size() < 4) return {};
  std::memcpy(&n, in_.data(), 4);
  n = ntohl(n);
  if (in_.size() < 4 + n) return {};
  std::string message = in_.substr(4, n);
  in_.erase(0, 4 + n);
  return message;
}

inline std::optional<std::string> Client::receive() {
  std::optional<std::string> message;
  arena_.until([&] { return (message = pop()) || (!take() && ended_); }, false);
  return message;
}

inline std::string Client::receiveBytes(std::size_t n) {
  arena_.until([&] { return in_.size() >= n || (!take() && ended_); }, false);
  return std::exchange(in_, {});
}

inline std::vector<std::string> Client::drain() {
  while (take()) {
  }
  std::vector<std::string> all;
  while (auto m = pop()) all.push_back(*m);
  return all;
}

inline bool Client::closed() {
  arena_.until([&] { return !take() && ended_; }, false);
  return ended_;
}

}  // namespace spark::test
