#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <catch2/catch.hpp>

#include "api/agents.h"
#include "api/drawing.h"
#include "api/phases.h"
#include "packets.h"
#include "spark/script_server.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;
using Udp = boost::asio::ip::udp;

namespace {
/// A simulation with a drawing server.
struct Studio : TestHost {
  Studio() {
    for (const char* plugin : {"scene", "gamecontrol", "drawing"}) kernel.plugins().use(plugin);
    node = &kernel.create("DrawingServer", "/sys/server/drawing");
    server = node->as<IDrawings>();
  }
  void poll() { node->as<IInputSource>()->poll(); }
  /// Polls until this number of packets has been read: one poll may end before it has read all.
  void pollUntil(std::int64_t packets) {
    while (get("packets") < packets) poll();
  }
  std::int64_t get(const char* property) { return getProperty(*node, property).toInteger(); }
  std::size_t shapesIn(std::string_view set) {
    for (const auto& s : server->sets())
      if (s.name == set) return s.shapes.size();
    return 0;
  }
  /// Opens the port. The next poll receives what was sent, because loopback delivers at once.
  void open() {
    setProperty(*node, "port", 0);
    poll();
    REQUIRE(get("port") > 0);
    sender.emplace(io, Udp::v4());
    sender->connect({boost::asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(get("port"))});
  }
  void send(const std::string& bytes) { sender->send(boost::asio::buffer(bytes)); }

  Leaf* node;
  IDrawings* server;
  boost::asio::io_context io;
  std::optional<Udp::socket> sender;
};

/// An agent that can draw.
struct Artist : Studio {
  Artist() {
    auto& aspect = kernel.create<AgentAspect>("AgentAspect", "/usr/scene/agent");
    aspect.setNumber(5);
    effector = &aspect.create<Effector>("DrawEffector", "draw");
  }
  std::string draw(const std::string& text) {
    Predicates p;
    readSexp(text, p);
    return effector->act(*p.begin());
  }
  Effector* effector;
};
}  // namespace

TEST_CASE("no packets are received unless a port is set") {
  Studio studio;
  studio.poll();
  CHECK(studio.get("port") == -1);
  CHECK(studio.server->version() == 0);
}

TEST_CASE("received packets are shown") {
  Studio studio;
  studio.open();
  studio.send(sphere("red.1") + sphere("red.1"));
  studio.send(sphere("red.2"));
  studio.pollUntil(2);
  CHECK(studio.server->version() == 0);
  studio.send(swap("red"));
  studio.pollUntil(3);
  CHECK(studio.shapesIn("red.1") == 2);
  CHECK(studio.shapesIn("red.2") == 1);
  CHECK(studio.get("packets") == 3);
  CHECK(studio.get("refused") == 0);
  studio.send(sphere("red.1") + "\x07nonsense");
  studio.send(std::string(5000, '\1'));
  studio.send("");
  while (studio.get("refused") < 2) studio.poll();
  studio.poll();
  CHECK(studio.get("refused") == 2);
  callMethod(*studio.node, "clear", {});
  CHECK(studio.shapesIn("red.1") == 0);
}

TEST_CASE("a poll reads a bounded number of packets") {
  Studio studio;
  studio.open();
  for (int i = 0; i < 200; ++i) studio.send(swap("x"));
  studio.poll();
  const auto once = studio.get("packets");
  CHECK(once <= 64);
  studio.pollUntil(once + 1);
}

TEST_CASE("packets from the port and from agents are forwarded to another viewer") {
  Artist studio;
  Udp::socket viewer(studio.io, Udp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0));
  setProperty(*studio.node, "forward", "127.0.0.1:" + std::to_string(viewer.local_endpoint().port()));
  studio.open();
  const auto received = [&] {
    REQUIRE(viewer.available() > 0);
    std::string bytes(2048, ' ');
    bytes.resize(viewer.receive(boost::asio::buffer(bytes)));
    return bytes;
  };
  studio.send(sphere("a"));
  studio.pollUntil(1);
  CHECK(received() == sphere("a"));
  CHECK(studio.draw("(draw (set b) (sphere (at 1 2 3) (radius 0.5) (color 255 0 0)))").empty());
  CHECK(received() == sphere("b") + swap("b"));
  CHECK(viewer.available() == 0);
}

TEST_CASE("packets that are forwarded to the server itself do not loop") {
  Artist studio;
  studio.open();
  setProperty(*studio.node, "forward", "127.0.0.1:" + std::to_string(studio.get("port")));
  studio.poll();
  studio.send(sphere("a"));
  studio.pollUntil(1);
  for (int i = 0; i < 5; ++i) studio.poll();
  CHECK(studio.get("packets") == 1);
}

TEST_CASE("a port or a viewer that is unavailable is reported, and the simulation continues") {
  Studio first, second;
  first.open();
  setProperty(*second.node, "port", first.get("port"));
  setProperty(*second.node, "forward", "nowhere");
  second.poll();
  CHECK_THAT(second.text, Catch::Contains("drawings cannot come in at 127.0.0.1:") &&
                              Catch::Contains("cannot be forwarded to 'nowhere'"));
  const auto said = second.text.size();
  second.poll();
  CHECK(second.text.size() == said);
  setProperty(*second.node, "port", 0);
  second.poll();
  CHECK(second.get("port") > 0);
}

TEST_CASE("an agent's effector shows its shapes at once and replaces the previous ones") {
  Artist artist;
  CHECK(artist.effector->predicate() == "draw");
  CHECK(artist.draw("(draw (set plan) (line (from 0 0 0) (to 1 2 0)) (text (at 1 2 0) (say \"there\")))").empty());
  CHECK(artist.shapesIn("plan") == 2);
  CHECK(artist.draw("(draw (set planner) (point (at 1 2 0)))").empty());
  CHECK(artist.draw("(draw (set plan) (point (at 1 2 0)))").empty());
  CHECK(artist.shapesIn("plan") == 1);
  CHECK(artist.shapesIn("planner") == 1);
  CHECK(artist.draw("(draw (point (at 1 2 0)) (agent (side left) (unum 5) (say hello)))").empty());
  CHECK(artist.shapesIn("agent5") == 1);
  CHECK(artist.shapesIn("agents") == 1);
  CHECK(artist.draw("(draw (set plan))").empty());
  CHECK(artist.shapesIn("plan") == 0);
  const auto version = artist.server->version();
  CHECK_THAT(artist.draw("(draw (set plan) (point (at 1 2 0)) (cube))"),
             Catch::Contains("expected a circle") && Catch::Contains("found 'cube'"));
  CHECK(artist.server->version() == version);
}

TEST_CASE("drawing() in a config opens a port only if one is set, and in a batch it only provides the effector") {
  const auto configure = [](TestHost& host, const char* parameters,
                            std::initializer_list<std::pair<const char*, Value>> settings) {
    ScriptServer& lua = scripts(host.kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    for (const auto& [name, value] : settings) lua.addOverride(name, value);
    lua.run(std::string("host = { share = '', scenePaths = {}") + parameters + " } include 'house.lua' drawing()",
            "test");
    return host.kernel.root().find("/sys/server/drawing");
  };
  TestHost quiet, open, alone;
  Leaf* server = configure(quiet, "", {});
  REQUIRE(server);
  server->as<IInputSource>()->poll();
  CHECK(getProperty(*server, "port") == Value(-1));
  server = configure(open, "", {{"drawings", 0}, {"forwardDrawings", "127.0.0.1:9"}});
  REQUIRE(server);
  server->as<IInputSource>()->poll();
  CHECK(getProperty(*server, "port").toInteger() > 0);
  CHECK(getProperty(*server, "forward").toString() == "127.0.0.1:9");
  CHECK(configure(alone, ", alone = true", {}) == nullptr);
  CHECK(alone.kernel.findClass("DrawEffector") != nullptr);
}

TEST_CASE("an agent may draw without a drawing server") {
  Artist artist;
  artist.kernel.root().require<Node>("/sys/server").remove(*artist.node);
  CHECK(artist.draw("(draw (point (at 1 2 0)))") == "expected a DrawingServer, found none: nothing is drawn");
}

TEST_CASE("what an agent draws wrong is reported, and nothing of it is drawn") {
  Artist artist;
  const auto [action, expected] = GENERATE(table<std::string, std::string>(
      {{"(draw (point (at 1 2)))", "expected (at x y z) with numbers"},
       {"(draw (point (at 1 2 z)))", "expected (at x y z) with numbers"},
       {"(draw (circle (at 1 2)(radius big)))", "expected (radius number), not below 0"},
       {"(draw (set a)(cube (at 1 2 3)))",
        "expected a circle, line, point, sphere, polygon, text or agent, found 'cube'"},
       {"(draw (set))", "expected (set name), found a set without a name"},
       {"(draw something)", "expected (set name) or a shape, found 'something'"}}));
  CHECK_THAT(artist.draw(action), Catch::StartsWith(expected));
  CHECK(artist.server->sets().empty());
  CHECK(artist.draw("(draw (point (at 1 2 0)))") == "");
  CHECK_FALSE(artist.server->sets().empty());
}
