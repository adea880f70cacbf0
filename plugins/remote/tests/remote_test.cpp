#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <catch2/catch.hpp>
#include <functional>
#include <thread>

#include "../messages.h"
#include "../wire.h"
#include "absence.h"
#include "api/phases.h"
#include "api/scene.h"
#include "fake_tape.h"
#include "spark/access.h"
#include "spark/error.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {
constexpr const char* kToken = "0123456789abcdef";

/// A host that serves its tree at a Unix socket or a port, and runs in a thread of its own.
struct Served {
  test::TestHost host;
  Leaf* server = nullptr;
  Leaf* simulation = nullptr;
  std::thread thread;
  std::atomic<bool> ended = false;

  explicit Served(const std::string& address, const char* rate = "max") {
    for (const char* plugin : {"simulation", "remote"}) host.kernel.plugins().use(plugin);
    simulation = &host.kernel.create("Simulation", "/sys/server/simulation");
    setProperty(*simulation, "rate", rate);
    server = &host.kernel.create("RemoteServer", "/sys/server/remote");
    callMethod(*server, "listen", List{address, kToken});
  }
  ~Served() { stop(); }
  std::string address() { return getProperty(*server, "address").toString(); }
  void run() {
    thread = std::thread([this] {
      callMethod(*simulation, "run", {});
      ended = true;
    });
  }
  void stop() {
    host.kernel.requestStop();
    if (thread.joinable()) thread.join();
  }
};

/// A host that mounts another one's tree.
struct Mounting {
  test::TestHost host;
  Leaf* server = nullptr;
  Node* mount = nullptr;
  std::atomic<bool> stopped = false;

  explicit Mounting(const std::string& address, const std::string& of = "/") {
    host.kernel.plugins().use("remote");
    server = &host.kernel.create("RemoteServer", "/sys/server/remote");
    mount = host.kernel.create("RemoteMount", "/usr/other").asNode();
    setProperty(*mount, "address", address);
    setProperty(*mount, "of", of);
    setProperty(*mount, "clientName", "tester");
  }
  void connect(const std::string& token = kToken) { callMethod(*mount, "connect", List{token}); }
  /// Handles what comes until `done`.
  void serve(const std::function<bool()>& done) {
    auto& source = *server->as<IInputSource>();
    while (!done()) source.wait(0.1);
  }
};

}  // namespace

TEST_CASE("A mounted tree has the nodes of the other host, with their properties and methods") {
  Served a("127.0.0.1:0");
  a.host.kernel.create("Node", "/usr/first/second");
  a.run();
  Mounting b(a.address());
  b.connect();
  Leaf& simulation = b.mount->require<Leaf>("sys/server/simulation");
  CHECK(b.mount->find("usr/first/second"));
  CHECK(simulation.classObject()->name() == "Simulation@other");
  CHECK_THAT(simulation.classObject()->doc(), Contains("run loop") && Contains("plugin simulation"));
  const Property* const step = simulation.classObject()->property("step");
  REQUIRE(step);
  CHECK(step->unit == "s");
  CHECK(step->get(simulation) == Value(0.02));
  CHECK(getProperty(simulation, "cycle").toInteger() > 0);
  setProperty(simulation, "step", 0.01);
  CHECK(callMethod(simulation, "getStep", {}) == Value(0.01));
  CHECK_THROWS_WITH(setProperty(simulation, "step", 7.0), Contains("expected 1e-06 to 1"));
  CHECK_THROWS_WITH(setProperty(simulation, "cycle", 1), Contains("read only"));
  CHECK_THROWS_WITH(b.mount->require<Leaf>("usr/second"), Contains("second"));
  const Value all = callMethod(simulation, "values", {});
  REQUIRE(all.at("step"));
  CHECK(*all.at("step") == Value(0.01));
  callMethod(simulation, "stop", {});
  a.thread.join();
  CHECK(a.ended);
}

TEST_CASE("What changes in the other tree changes in the mounted one, before the answer to what changed it") {
  Served a("127.0.0.1:0");
  Kernel& kernel = a.host.kernel;
  kernel.create("Node", "/usr/all/one/inner");
  Node& two = kernel.create<Node>("Node", "/usr/all/two");
  int step = 0;
  kernel.events().channel("rule").add(*a.simulation, [&](Leaf&, const Event&) {
    // Each step of the test sets the duration to its number.
    const auto asked = static_cast<int>(getProperty(*a.simulation, "duration").toNumber()) / 1'000'000;
    if (asked == step) return;
    step = asked;
    if (step == 1) kernel.create("Node", "/usr/all/two/made");
    if (step == 2) two.require<Node>("../one").reparent(two.require<Leaf>("../one/inner"), two);
    if (step == 3) two.setName("three");
    if (step == 4) kernel.root().require<Node>("/usr/all").remove(kernel.root().require<Leaf>("/usr/all/one"));
  });
  a.run();
  Mounting b(a.address(), "/usr/all");
  b.connect();
  Mounting control(a.address());
  control.connect();
  const auto next = [&](int n) {
    setProperty(control.mount->require<Leaf>("sys/server/simulation"), "duration", 1e6 * n);
    // The rule of the next cycle acts, and the tree is told with the next answer.
    const Value before = getProperty(control.mount->require<Leaf>("sys/server/simulation"), "cycle");
    while (getProperty(control.mount->require<Leaf>("sys/server/simulation"), "cycle").toInteger() <
           before.toInteger() + 2) {
    }
    b.server->as<IInputSource>()->poll();
  };
  next(1);
  b.serve([&] { return b.mount->find("two/made") != nullptr; });
  next(2);
  b.serve([&] { return b.mount->find("two/inner") != nullptr; });
  CHECK_FALSE(b.mount->find("one/inner"));
  next(3);
  b.serve([&] { return b.mount->find("three/inner") != nullptr; });
  CHECK_FALSE(b.mount->find("two"));
  next(4);
  b.serve([&] { return b.mount->find("one") == nullptr; });
  callMethod(b.mount->require<Leaf>("three/inner"), "unlinkLeaf", {});
  CHECK_FALSE(b.mount->find("three/inner"));
}

TEST_CASE("A handler on another host acts at the place of one in the house") {
  Served a("127.0.0.1:0");
  std::int64_t agreed = 0, cycles = 0;
  // The remote handler doubles the cycle; this one, which was added later, sees it in the same phase.
  a.run();
  Mounting b(a.address(), "/sys/server");
  b.connect();
  Leaf& simulation = b.mount->require<Leaf>("simulation");
  std::int64_t handled = 0;
  Channel& rule = b.host.kernel.events().channel("rule");
  rule.add(simulation, [&](Leaf& node, const Event& event) {
    ++handled;
    CHECK(event.step == 0.02);
    CHECK(getProperty(node, "cycle") == Value(event.cycle));
    setProperty(node, "duration", 1000.0 + 2.0 * static_cast<double>(event.cycle));
  });
  b.serve([&] { return handled >= 20; });
  callMethod(simulation, "stop", {});
  std::thread drain([&] { b.serve([&] { return a.ended.load(); }); });
  a.thread.join();
  drain.join();
  cycles = getProperty(*a.simulation, "cycle").toInteger();
  agreed = static_cast<std::int64_t>(getProperty(*a.simulation, "duration").toNumber()) - 1000;
  CHECK(agreed == 2 * cycles);
  CHECK(getProperty(*a.server, "lateEvents") == Value(0));
}

TEST_CASE("An event of this host does not reach the handlers of nodes of another one") {
  Served a("127.0.0.1:0", "real");
  a.run();
  Mounting b(a.address());
  b.connect();
  std::vector<std::int64_t> cycles;
  Channel& rule = b.host.kernel.events().channel("rule");
  rule.add(b.mount->require<Leaf>("sys/server/simulation"),
           [&](Leaf&, const Event& event) { cycles.push_back(event.cycle); });
  int own = 0;
  rule.add(*b.server, [&](Leaf&, const Event&) { ++own; });
  b.serve([&] {
    rule.emit({.name = "rule", .cycle = -1});
    return cycles.size() >= 3;
  });
  CHECK(std::count(cycles.begin(), cycles.end(), -1) == 0);
  CHECK(own >= 3);
}

TEST_CASE("A remote host that goes costs one event and one line, and the simulation goes on") {
  Served a("127.0.0.1:0");
  std::atomic<int> lost = 0;
  std::string who;
  a.host.kernel.events().channel("remoteLost").add(*a.server, [&](Leaf&, const Event& event) {
    who = event.data->at(std::size_t{0})->toString();
    ++lost;
  });
  a.run();
  {
    Mounting b(a.address());
    b.connect();
    b.host.kernel.events().channel("rule").add(b.mount->require<Leaf>("sys/server/simulation"),
                                               [](Leaf&, const Event&) {});
  }
  while (lost == 0) std::this_thread::yield();
  a.stop();
  CHECK(lost == 1);
  CHECK(who == "tester");
  CHECK(test::count(a.host.text, "remote host tester") == 2);  // it came, and it went
  CHECK_THAT(a.host.text, Contains("the connection ended"));
}

TEST_CASE("When the other host ends, its nodes stay and say why they cannot be used") {
  auto a = std::make_unique<Served>("127.0.0.1:0");
  a->run();
  Mounting b(a->address());
  b.connect();
  int lost = 0;
  b.host.kernel.events().channel("remoteLost").add(*b.mount, [&](Leaf&, const Event&) { ++lost; });
  Leaf& simulation = b.mount->require<Leaf>("sys/server/simulation");
  a->stop();
  a.reset();
  CHECK_THROWS_WITH(getProperty(simulation, "cycle"), Contains("is lost"));
  CHECK_THROWS_WITH(getProperty(simulation, "cycle"), Contains("is lost"));
  b.server->as<IInputSource>()->poll();
  b.server->as<IInputSource>()->poll();
  CHECK(lost == 1);
  CHECK(test::count(b.host.text, "is lost") == 1);
  CHECK(getProperty(*b.mount, "connected") == Value(false));
}

namespace {
/// A scene with a box at (1, 2, 3), served; and one that mounts it below a transform at (10, 0, 0).
struct Scenes {
  Served a{"127.0.0.1:0"};
  Transform* box = nullptr;
  Mounting b;
  Node* mount = nullptr;

  Scenes() : box(made(a.host.kernel)), b(started()) {
    Kernel& kernel = b.host.kernel;
    kernel.plugins().use("scene");
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("Scene", "/usr/scene");
    kernel.create<Transform>("Transform", "/usr/scene/room").setLocalPos({10, 0, 0});
    mount = kernel.create("RemoteMount", "/usr/scene/room/there").asNode();
    setProperty(*mount, "address", a.address());
    setProperty(*mount, "of", "/usr/scene");
  }
  static Transform* made(Kernel& kernel) {
    kernel.plugins().use("scene");
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("Scene", "/usr/scene");
    auto& box = kernel.create<Transform>("Transform", "/usr/scene/box");
    box.setLocalPos({1, 2, 3});
    callMethod(box.create("Box", "look"), "setExtents", List{0.1, 0.2, 0.3});
    return &box;
  }
  std::string started() {
    const std::string address = a.address();
    a.run();
    return address;
  }
  void connect() { callMethod(*mount, "connect", List{kToken}); }
};
}  // namespace

TEST_CASE("Scene nodes of another host are scene nodes below the mount") {
  Scenes s;
  s.connect();
  auto& box = s.mount->require<Transform>("box");
  s.b.host.kernel.root().require<ISceneServer>().place();
  CHECK(positionOf(box.world()) == Vec3f(11, 2, 3));
  auto& look = s.mount->require<IVisual>("box/look");
  CHECK(look.load() == "StdUnitBox");
  CHECK(look.scale() == Vec3f(0.1f, 0.2f, 0.3f));
  CHECK(look.leaf().classObject()->isA("Box"));
  CHECK(look.leaf().classObject()->name() == "Box@there");

  // What is set is set there, and is here before the answer.
  setProperty(box, "localPos", List{4, 5, 6});
  CHECK(box.localPos() == Vec3f(4, 5, 6));
  callMethod(look.leaf(), "setExtents", List{1, 1, 1});
  CHECK(look.scale() == Vec3f(1, 1, 1));
  CHECK(getProperty(box, "localPos") == Value(List{4.0, 5.0, 6.0}));
  // In this host's own scene it follows what is above.
  s.b.host.kernel.root().require<Transform>("/usr/scene/room").setLocalPos({20, 0, 0});
  s.b.host.kernel.root().require<ISceneServer>().place();
  CHECK(positionOf(box.world()) == Vec3f(24, 5, 6));
}

TEST_CASE("A mounted node that is renamed has its new name at once") {
  Scenes s;
  s.connect();
  auto& box = s.mount->require<Transform>("box");
  setProperty(box, "name", "crate");
  CHECK(box.name() == "crate");
  setProperty(box, "localPos", List{4, 5, 6});
  CHECK(box.localPos() == Vec3f(4, 5, 6));
  CHECK(s.mount->find("crate/look"));
  // Outside of scenes as well.
  s.b.connect();
  Leaf& there = s.b.mount->require<Leaf>("usr/scene/crate");
  setProperty(there, "name", "chest");
  CHECK(there.name() == "chest");
  CHECK(getProperty(there, "localPos") == Value(List{4.0, 5.0, 6.0}));
}

TEST_CASE("Handlers on a scene node of another host run with its events and with its values of that moment") {
  Scenes s;
  std::int64_t moves = 0;
  s.connect();
  auto& box = s.mount->require<Transform>("box");
  std::vector<std::pair<std::int64_t, float>> seen;
  s.b.host.kernel.events().channel("rule").add(box, [&](Leaf& node, const Event& event) {
    seen.emplace_back(event.cycle, node.as<Transform>()->localPos().x());
    setProperty(node, "localPos", List{static_cast<double>(++moves), 0, 0});
  });
  s.b.serve([&] { return seen.size() >= 5; });
  for (std::size_t i = 1; i < seen.size(); ++i) CHECK(seen[i].second == static_cast<float>(i));
}

TEST_CASE("Outside of a scene nodes of another host are none of a scene") {
  Scenes s;
  s.b.connect();
  Leaf& box = s.b.mount->require<Leaf>("usr/scene/box");
  CHECK_FALSE(box.as<Transform>());
  CHECK(box.classObject()->isA("RemoteNode"));
  CHECK(getProperty(box, "localPos") == Value(List{1.0, 2.0, 3.0}));
}

TEST_CASE("When the other host ends, its scene nodes stay where they were, and values that were read stay") {
  auto s = std::make_unique<Scenes>();
  s->connect();
  auto& box = s->mount->require<Transform>("box");
  Leaf& scene = s->mount->require<Leaf>("box/look");
  const Value shadows = getProperty(scene, "castShadows");
  s->a.stop();
  callMethod(*s->mount, "close", {});
  CHECK(box.localPos() == Vec3f(1, 2, 3));
  CHECK(getProperty(box, "localPos") == Value(List{1.0, 2.0, 3.0}));
  CHECK(getProperty(scene, "castShadows") == shadows);
  CHECK_THROWS_WITH(setProperty(box, "localPos", List{0, 0, 0}), Contains("is lost"));
}

TEST_CASE("In real time the simulation does not wait for a remote host that hangs") {
  Served a("127.0.0.1:0", "real");
  setProperty(*a.server, "patience", 0.0);
  a.run();
  Mounting b(a.address());
  b.connect();
  int handled = 0;
  b.host.kernel.events().channel("rule").add(b.mount->require<Leaf>("sys/server/simulation"),
                                             [&](Leaf&, const Event&) { ++handled; });
  // Nothing is handled here, and the other host's cycles go on.
  Mounting watcher(a.address());
  watcher.connect();
  const std::int64_t before = getProperty(watcher.mount->require<Leaf>("sys/server/simulation"), "cycle").toInteger();
  while (getProperty(watcher.mount->require<Leaf>("sys/server/simulation"), "cycle").toInteger() < before + 5) {
  }
  CHECK(getProperty(watcher.mount->require<Leaf>("sys/server/remote"), "lateEvents").toInteger() == 1);
  CHECK(handled == 0);
  // It catches up when it can.
  b.serve([&] { return handled >= 5; });
}

TEST_CASE("As fast as possible the simulation gives up a remote host that hangs") {
  Served a("127.0.0.1:0");
  setProperty(*a.server, "lockstepPatience", 0.05);
  a.run();
  Mounting b(a.address());
  b.connect();
  try {
    b.host.kernel.events().channel("rule").add(b.mount->require<Leaf>("sys/server/simulation"),
                                               [](Leaf&, const Event&) {});
  } catch (const Error&) {  // it may be given up before the answer is read
  }
  Mounting watcher(a.address());
  watcher.connect();
  while (getProperty(watcher.mount->require<Leaf>("sys/server/remote"), "clients").toInteger() > 1) {
  }
  a.stop();
  CHECK_THAT(a.host.text, Contains("its handlers took longer than 0.05 s"));
}

TEST_CASE("A Unix socket is for the user of the host and needs no token") {
  test::TemporaryFolder folder;
  const std::string path = folder.path() / "tree.sock";
  {
    Served a(path);
    a.run();
    Mounting b(path);
    b.connect("");
    CHECK(b.mount->find("sys/server/simulation"));
    CHECK(std::filesystem::exists(path));
  }
  CHECK_FALSE(std::filesystem::exists(path));
  // One that a killed host has left is taken over.
  const int left = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::snprintf(name.sun_path, sizeof name.sun_path, "%s", path.c_str());
  REQUIRE(::bind(left, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0);
  ::close(left);
  Served again(path);
  CHECK(again.address() == path);
}

TEST_CASE("Hosts without the token, and those that are none, lose their own connection only") {
  Served a("127.0.0.1:0");
  a.run();
  Mounting good(a.address());
  good.connect();
  Mounting stranger(a.address());
  CHECK_THROWS_WITH(stranger.connect("0123456789abcdeF"), Contains("its token is wrong"));
  CHECK_THROWS_WITH(Mounting(a.address(), "/usr/nowhere").connect(), Contains("there is no node /usr/nowhere"));

  boost::asio::io_context io;
  const auto port = remote::Address::read(a.address()).port;
  const auto raw = [&](const std::string& bytes) {
    boost::asio::ip::tcp::socket s(io);
    s.connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(std::stoi(port))});
    boost::system::error_code ec;
    s.write_some(boost::asio::buffer(bytes), ec);
    std::array<char, 4096> answer;
    while (!ec) s.read_some(boost::asio::buffer(answer), ec);
    return ec;
  };
  const auto framed = [](const std::string& message) {
    std::string out{0, 0, static_cast<char>(message.size() >> 8), static_cast<char>(message.size())};
    return out + message;
  };
  CHECK(raw("GET / HTTP/1.1\r\n\r\n"));
  CHECK(raw(framed("")));
  CHECK(raw(framed("12345678")));
  CHECK(raw(framed(remote::encode({"get", 1, "/", "name"}))));
  CHECK(raw(framed(remote::encode({"hello"}))));
  CHECK(raw(framed(remote::encode({"hello", 2, kToken, "x", "/"}))));
  CHECK(raw(framed(remote::encode({"hello", 1, "", "x", "/"}))));
  CHECK(raw(framed(remote::encode({"hello", 1, kToken, 5, "/"}))));
  CHECK(getProperty(good.mount->require<Leaf>("sys/server/simulation"), "step") == Value(0.02));
}

TEST_CASE("A number means one subscription: a second one with it is refused, and events come once") {
  Served a("127.0.0.1:0");
  a.host.kernel.create("Node", "/usr/one");
  boost::asio::io_context io;
  remote::Wire::Socket socket(io);
  const auto port = static_cast<unsigned short>(std::stoi(remote::Address::read(a.address()).port));
  socket.connect(boost::asio::ip::tcp::endpoint(boost::asio::ip::make_address("127.0.0.1"), port));
  remote::Wire wire(std::move(socket), "tester");
  auto& source = *a.server->as<IInputSource>();
  // The answers to requests up to `last`, and the subscriptions whose events came before the last one.
  std::vector<List> answers;
  std::vector<std::int64_t> told;
  const auto serve = [&](std::int64_t last) {
    while (answers.empty() || answers.back()[1] != Value(last)) {
      wire.flush();
      source.poll();
      wire.receive();
      while (const auto bytes = wire.take()) {
        const List m = remote::decode(*bytes);
        if (m[0] == Value(remote::kEvent)) told.push_back(m[2].toInteger());
        if (m[0] == Value(remote::kOk) || m[0] == Value(remote::kError)) answers.push_back(m);
      }
    }
  };
  wire.send({remote::kHello, remote::kProtocol, kToken, "tester", "/"});
  wire.send({remote::kListen, 1, 7, "usr/one", "first", false});
  wire.send({remote::kListen, 2, 7, "usr/one", "second", false});
  wire.send({remote::kListen, 3, 8, "usr/one", "second", false});
  serve(3);
  REQUIRE(answers.size() == 3);
  CHECK(answers[0][0] == Value(remote::kOk));
  CHECK(answers[1] == List{remote::kError, 2, "subscription 7 exists"});
  CHECK(answers[2][0] == Value(remote::kOk));
  for (const char* channel : {"first", "second"}) a.host.kernel.events().channel(channel).emit({});
  wire.send({remote::kGet, 4, "usr/one", "name"});
  serve(4);
  CHECK(told == std::vector<std::int64_t>{7, 8});
}

TEST_CASE("What a remote host says is put on the tape, but its token is not") {
  Served a("127.0.0.1:0");
  const test::FakeTape& tape = test::FakeTape::in(a.host.kernel);
  a.run();
  Mounting b(a.address());
  b.connect();
  setProperty(b.mount->require<Leaf>("sys/server/simulation"), "step", 0.01);
  a.stop();
  const auto with = [](const std::vector<std::string>& messages, const std::string& text) {
    return std::count_if(messages.begin(), messages.end(),
                         [&](const std::string& m) { return m.find(text) != std::string::npos; });
  };
  REQUIRE(with({remote::encode({remote::kHello, remote::kProtocol, kToken, "tester", "/"})}, kToken) == 1);
  CHECK(with(tape.messages, "tester") == 1);  // the hello is there
  CHECK(with(tape.messages, "step") >= 1);
  CHECK(with(tape.messages, kToken) == 0);
}

TEST_CASE("Addresses and tokens that cannot be used are refused with a sentence") {
  test::TestHost host;
  host.kernel.plugins().use("remote");
  Leaf& server = host.kernel.create("RemoteServer", "/sys/server/remote");
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"nonsense", kToken}), Contains("expected an address"));
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"127.0.0.1:x1", kToken}), Contains("expected an address"));
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"127.0.0.1:68828", kToken}),
                    Contains("expected a port of at most 65535, found '127.0.0.1:68828'"));
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"127.0.0.1:99999999999", kToken}), Contains("expected a port"));
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"127.0.0.1:0", "short"}), Contains("at least 16 characters"));
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"/nowhere/at/all", ""}), Contains("cannot listen"));
  Served other("127.0.0.1:0");
  CHECK_THROWS_WITH(callMethod(server, "listen", List{other.address(), kToken}),
                    EndsWith("because: Address already in use"));
  callMethod(server, "listen", List{"127.0.0.1:0", ""});
  CHECK(callMethod(server, "token", {}).toString().size() == 32);
  CHECK_THROWS_WITH(callMethod(server, "listen", List{"127.0.0.1:0", kToken}), Contains("listens at 127.0.0.1:"));
  Leaf& mount = host.kernel.create("RemoteMount", "/usr/other");
  setProperty(mount, "address", "127.0.0.1:1");
  CHECK_THROWS_WITH(callMethod(mount, "connect", List{""}),
                    Contains("cannot reach a host at 127.0.0.1:1;") && EndsWith("because: Connection refused"));
}
