#include "api/control.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "api/phases.h"
#include "fake_tape.h"
#include "spark/error.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;
using Json = nlohmann::json;
namespace asio = boost::asio;
namespace fs = std::filesystem;

namespace {
/// A separate folder for the sockets of a test.
struct RuntimeFolder : test::TemporaryFolder {
  RuntimeFolder() { setenv("XDG_RUNTIME_DIR", path().c_str(), 1); }
};

struct Fixture {
  RuntimeFolder folder;
  test::TestHost host;
  Leaf* simulation = nullptr;
  Leaf* control = nullptr;
  asio::io_context io;
  asio::local::stream_protocol::socket client{io};
  asio::streambuf buffer;

  Fixture() {
    host.kernel.plugins().use("simulation");
    host.kernel.plugins().use("control");
    simulation = &host.kernel.create("Simulation", "/sys/server/simulation");
    setProperty(*simulation, "rate", "max");
    control = &host.kernel.create("ControlServer", "/sys/server/control");
  }
  std::string socket() { return getProperty(*control, "socket").toString(); }
  void connect() { client.connect(asio::local::stream_protocol::endpoint(socket())); }
  void cycle() { callMethod(*simulation, "runCycles", std::vector<Value>{1}); }
  void send(const std::string& line) { asio::write(client, asio::buffer(line + "\n")); }
  Json receive() {
    asio::read_until(client, buffer, '\n');
    std::istream in(&buffer);
    std::string line;
    std::getline(in, line);
    return Json::parse(line);
  }
  Json ask(const Json& request) {
    send(request.dump());
    cycle();
    return receive();
  }
};

/// Handles additional requests.
class Weatherman : public Leaf, public IRequestHandler {
  SPARK_CLASS(Weatherman, Leaf)
 public:
  static void describe(Description<Weatherman>& d) {
    d.doc("Reports the weather.");
    d.implements<IRequestHandler>();
  }
  std::span<const std::string_view> requests() const override { return kRequests; }
  std::string answer(std::string_view request) override {
    return Json{{"ok", true}, {"sky", Json::parse(request).value("place", "") + " is grey"}}.dump();
  }
  void poll() override { ++polls; }
  int polls = 0;

 private:
  static constexpr std::array<std::string_view, 2> kRequests{"weather", "forecast"};
};
}  // namespace

TEST_CASE("Only the user can reach the control socket") {
  Fixture f;
  struct stat s = {};
  REQUIRE(stat(f.socket().c_str(), &s) == 0);
  REQUIRE((s.st_mode & 0777) == 0600);
  REQUIRE(stat(fs::path(f.socket()).parent_path().c_str(), &s) == 0);
  REQUIRE((s.st_mode & 0777) == 0700);
}

TEST_CASE("Sockets of ended processes are removed when a control server starts, and others stay") {
  RuntimeFolder folder;
  const fs::path sockets = folder.path() / "spark";
  fs::create_directory(sockets);
  chmod(sockets.c_str(), 0700);
  asio::io_context io;
  const auto bind = [&](const fs::path& file) {
    asio::local::stream_protocol::acceptor acceptor(io);
    acceptor.open();
    acceptor.bind(asio::local::stream_protocol::endpoint(file.string()));
    return acceptor;  // closing it keeps the file
  };
  const int gone = fork();
  if (gone == 0) _exit(0);
  waitpid(gone, nullptr, 0);  // no process has this id any more
  const fs::path dead = sockets / fmt::format("{}.sock", gone), second = sockets / fmt::format("{}-2.sock", gone),
                 starting = sockets / fmt::format("{}.sock", getppid()),
                 container = sockets / fmt::format("{}-3.sock", gone);
  bind(dead), bind(second), bind(starting);
  for (const fs::path& file : {dead, second}) REQUIRE(fs::exists(file));
  auto listening = bind(container);
  listening.listen();
  test::TestHost host;
  host.kernel.plugins().use("control");
  Leaf& control = host.kernel.create("ControlServer", "/sys/server/control");
  CHECK_FALSE(getProperty(control, "socket").toString().empty());
  CHECK_FALSE(fs::exists(dead));
  CHECK_FALSE(fs::exists(second));
  CHECK(fs::exists(starting));
  CHECK(fs::exists(container));
}

TEST_CASE("A socket folder that is open to other users is not used, and the simulation runs without a socket") {
  RuntimeFolder folder;
  fs::create_directory(folder.path() / "spark");
  chmod((folder.path() / "spark").c_str(), 0755);
  test::TestHost host;
  host.kernel.plugins().use("control");
  Leaf& control = host.kernel.create("ControlServer", "/sys/server/control");
  REQUIRE(getProperty(control, "socket").toString().empty());
  REQUIRE(host.text.find("open to other users") != std::string::npos);
}

TEST_CASE("Two simulations in one process have a socket each, and remove it when they end") {
  RuntimeFolder folder;
  test::TestHost a, b;
  a.kernel.plugins().use("control");
  b.kernel.plugins().use("control");
  const std::string first = getProperty(a.kernel.create("ControlServer", "/sys/server/control"), "socket").toString();
  Leaf& other = b.kernel.create("ControlServer", "/sys/server/control");
  REQUIRE(getProperty(other, "socket").toString() != first);
  REQUIRE(fs::exists(first));
  a.kernel.root().require<Node>("/sys/server").removeChildren();
  REQUIRE_FALSE(fs::exists(first));
}

TEST_CASE("A property is read with its value, unit and documentation") {
  Fixture f;
  f.connect();
  const Json a = f.ask({{"do", "get"}, {"path", "/sys/server/simulation"}, {"property", "step"}});
  REQUIRE(a["ok"] == true);
  const Json p = a["properties"][0];
  REQUIRE(p["value"] == 0.02);
  REQUIRE(p["unit"] == "s");
  REQUIRE(p["doc"] == "Simulated time of one cycle.");
}

TEST_CASE("A request without a property lists all properties of the node") {
  Fixture f;
  f.connect();
  const Json a = f.ask({{"do", "get"}, {"path", "/sys/server/simulation"}});
  REQUIRE(a["properties"].size() >= 8);
}

TEST_CASE("set changes a property, also from text, and wrong values are refused with the reason") {
  Fixture f;
  f.connect();
  REQUIRE(f.ask({{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "step"}, {"value", "0.01"}})["ok"] ==
          true);
  REQUIRE(getProperty(*f.simulation, "step").toNumber() == 0.01);
  const Json bad = f.ask({{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "step"}, {"value", -1}});
  REQUIRE(bad["ok"] == false);
  REQUIRE(getProperty(*f.simulation, "step").toNumber() == 0.01);
  const Json unknown = f.ask({{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "stepp"}, {"value", 1}});
  REQUIRE(unknown["error"].get<std::string>().find("'step'") != std::string::npos);
}

TEST_CASE("Requests that change something are put on the tape, and while one is played they are refused") {
  Fixture f;
  f.connect();
  test::FakeTape& tape = test::FakeTape::in(f.host.kernel);
  const Json set{{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "step"}, {"value", 0.01}};
  CHECK(f.ask(set)["ok"] == true);
  CHECK(f.ask({{"do", "get"}, {"path", "/sys/server/simulation"}})["ok"] == true);
  CHECK(tape.noted == std::vector<std::string>{": " + set.dump()});
  tape.plays = true;
  const Json other{{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "step"}, {"value", 0.005}};
  CHECK(f.ask(other)["error"] == "a recording is played: nothing can be changed in it");
  CHECK(f.ask({{"do", "get"}, {"path", "/sys/server/simulation"}})["ok"] == true);
  CHECK(getProperty(*f.simulation, "step").toNumber() == 0.01);
}

TEST_CASE("call runs a method between cycles, and the run loop can be neither nested nor removed") {
  Fixture f;
  f.connect();
  REQUIRE(f.ask({{"do", "call"}, {"path", "/sys/server/simulation"}, {"method", "getStep"}})["value"] == 0.02);
  const Json nested = f.ask({{"do", "call"}, {"path", "/sys/server/simulation"}, {"method", "run"}});
  REQUIRE(nested["error"].get<std::string>().find("runs already") != std::string::npos);
  for (const char* path : {"/", "/sys", "/sys/server", "/sys/server/control", "/sys/server/simulation"}) {
    for (const char* method : {"unlinkLeaf", "unlinkChildren"}) {
      const Json a = f.ask({{"do", "call"}, {"path", path}, {"method", method}});
      CAPTURE(path, method, a.dump());
      REQUIRE(a["ok"] == false);
    }
  }
}

TEST_CASE("The tree has classes and documentation down to the requested depth") {
  Fixture f;
  f.connect();
  const Json whole = f.ask({{"do", "tree"}, {"path", "/sys"}});
  const Json servers = whole["tree"]["children"][0];
  REQUIRE(servers["name"] == "server");
  REQUIRE(servers["children"][0]["class"] == "Simulation");
  REQUIRE_FALSE(servers["children"][0]["doc"].get<std::string>().empty());
  const Json flat = f.ask({{"do", "tree"}, {"path", "/sys"}, {"depth", 1}});
  REQUIRE(flat["tree"]["children"][0]["more"] == 2);
}

TEST_CASE("A client without rights gets a large tree in parts, but every node on request") {
  Fixture f;
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < 100; ++k) f.host.kernel.create("Node", fmt::format("/usr/wide{}/leaf{}", i, k));
  const auto tree = [&](const char* path, bool mayChange) {
    control::Watch watch;
    const Json request{{"do", "tree"}, {"path", path}};
    return Json::parse(f.control->as<IRequests>()->answer(request.dump(), watch, mayChange))["tree"]["children"];
  };
  const Json looked = tree("/usr", false), whole = tree("/usr", true);
  REQUIRE(looked.size() == whole.size());
  REQUIRE(looked.front()["children"].size() == 100);
  REQUIRE(looked.back()["more"] == 100);
  REQUIRE(whole.back()["children"].size() == 100);
  REQUIRE(tree("/usr/wide59", false).size() == 100);
}

TEST_CASE("A watch reports every change and nothing else, and ends with its node") {
  Fixture f;
  f.host.kernel.create("Node", "/usr/box");
  f.connect();
  REQUIRE(f.ask({{"do", "watch"}, {"path", "/usr/box"}, {"property", "name"}})["value"] == "box");
  f.cycle();
  Leaf* box = f.host.kernel.root().find("/usr/box");
  box->setName("crate");
  f.cycle();
  REQUIRE(f.receive()["value"] == "crate");
  box->parent()->remove(*box);
  f.cycle();
  REQUIRE(f.receive()["ok"] == false);
}

TEST_CASE("Clients of other servers may get and watch, and need rights to set or call") {
  Fixture f;
  auto& requests = *f.control->as<IRequests>();
  control::Watch watch;
  const auto ask = [&](const Json& request, bool mayChange) {
    return Json::parse(requests.answer(request.dump(), watch, mayChange));
  };
  const Json set = {{"do", "set"}, {"path", "/sys/server/simulation"}, {"property", "step"}, {"value", 0.01}};
  const Json call = {{"do", "call"}, {"path", "/sys/server/simulation"}, {"method", "setStep"}, {"arguments", {0.03}}};
  const Json load = {{"do", "load"}, {"name", "scene"}}, unload = {{"do", "unload"}, {"name", "simulation"}};
  for (const Json& request : {set, call, load, unload}) {
    CAPTURE(request.dump());
    const Json refused = ask(request, false);
    REQUIRE(refused["ok"] == false);
    REQUIRE(refused["error"].get<std::string>().find("only the referee may") != std::string::npos);
  }
  REQUIRE(getProperty(*f.simulation, "step").toNumber() == 0.02);
  REQUIRE(ask({{"do", "watch"}, {"path", "/sys/server/simulation"}, {"property", "step"}}, false)["value"] == 0.02);
  REQUIRE(ask(set, true)["ok"] == true);
  bool done = false;
  REQUIRE(Json::parse(requests.nextOf(watch, done))["value"] == 0.01);
  REQUIRE(requests.nextOf(watch, done).empty());
  REQUIRE_FALSE(done);
  REQUIRE(ask({{"do", "tree"}, {"path", "/sys"}}, false)["ok"] == true);
}

TEST_CASE("Each request is either for all who watch, or for the referee alone") {
  Fixture f;
  f.host.kernel.registerClass<Weatherman>();
  f.host.kernel.create<Weatherman>("Weatherman", "/sys/server/control/weather");
  auto& requests = *f.control->as<IRequests>();
  control::Watch watch;
  const auto errorOf = [&](const std::string& what) {
    return Json::parse(requests.answer(Json{{"do", what}}.dump(), watch, false)).value("error", "");
  };
  // Whether it changes something. A request that the server knows has a row here.
  const std::map<std::string, bool> table{{"tree", false}, {"get", false},   {"set", true},      {"call", true},
                                          {"make", true},  {"attach", true}, {"watch", false},   {"plugins", false},
                                          {"load", true},  {"unload", true}, {"weather", false}, {"forecast", false}};
  std::string known = errorOf("nothing");
  known = known.substr(known.find(' ') + 1, known.rfind(", found ") - known.find(' ') - 1);
  known.erase(known.find("or "), 3);
  std::istringstream words(known);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    if (word.ends_with(',')) word.pop_back();
    CAPTURE(word);
    REQUIRE(table.contains(word));
    CHECK((errorOf(word).find("only the referee may") != std::string::npos) == table.at(word));
  }
  CHECK(count == table.size());
}

TEST_CASE("Children of the control server can handle additional requests for all clients") {
  Fixture f;
  f.connect();
  REQUIRE(f.ask({{"do", "weather"}})["error"] ==
          "expected tree, get, set, call, make, attach, watch, plugins, load, or unload, found 'weather'");
  f.host.kernel.registerClass<Weatherman>();
  auto& handler = f.host.kernel.create<Weatherman>("Weatherman", "/sys/server/control/weather");
  REQUIRE(f.ask({{"do", "weather"}, {"place", "Leipzig"}})["sky"] == "Leipzig is grey");
  REQUIRE(handler.polls == 1);
  control::Watch watch;
  REQUIRE(f.control->as<IRequests>()->answer(R"({"do":"forecast"})", watch, false) ==
          R"({"ok":true,"sky":" is grey"})");
  REQUIRE(f.ask({{"do", "wether"}})["error"] ==
          "expected tree, get, set, call, make, attach, watch, plugins, load, unload, weather, or forecast, found "
          "'wether'");
}

TEST_CASE("Plugins are listed with their classes") {
  Fixture f;
  f.connect();
  const Json a = f.ask({{"do", "plugins"}});
  bool found = false;
  for (const Json& p : a["plugins"])
    found |= p["name"] == "simulation" && p["registered"] == true && p["classes"][0] == "Simulation";
  REQUIRE(found);
}

TEST_CASE("Invalid requests get an error and cause no harm") {
  Fixture f;
  f.connect();
  for (const char* line : {"garbage", "[]", "{}", R"({"do":"dance"})", R"({"do":"get"})",
                           R"({"do":"get","path":"/nowhere"})", R"({"do":"get","path":7})", "\xff\xfe"}) {
    f.send(line);
    f.cycle();
    CAPTURE(line);
    REQUIRE(f.receive()["ok"] == false);
  }
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  f.send(R"({"do":"set","path":"/sys/server/simulation","property":"duration","value":)" + deep + "}");
  for (int i = 0; i < 20; ++i) f.cycle();  // every cycle reads a part of it
  REQUIRE(f.receive()["error"].get<std::string>().find("nested at most") != std::string::npos);
  REQUIRE(f.ask({{"do", "plugins"}})["ok"] == true);
}

TEST_CASE("A client that never ends its line is disconnected") {
  Fixture f;
  f.connect();
  f.cycle();
  REQUIRE(getProperty(*f.control, "clients").toInteger() == 1);
  const std::string endless(4096, 'x');
  boost::system::error_code ec;
  for (int i = 0; i < 40 && !ec; ++i) {
    asio::write(f.client, asio::buffer(endless), ec);
    f.cycle();
  }
  REQUIRE(getProperty(*f.control, "clients").toInteger() == 0);
}

TEST_CASE("A line of 64 KiB is a request, a longer one disconnects its client") {
  for (const std::size_t bytes : {65536, 65537}) {
    Fixture f;
    f.connect();
    std::string request = R"({"do":"plugins"})";
    request.resize(bytes - 1, ' ');  // send() adds the end of the line
    f.send(request);
    for (int i = 0; i < 20; ++i) f.cycle();  // every cycle reads a part of it
    CAPTURE(bytes);
    REQUIRE(getProperty(*f.control, "clients").toInteger() == (bytes == 65536 ? 1 : 0));
    if (bytes == 65536) REQUIRE(f.receive()["ok"] == true);
  }
}
