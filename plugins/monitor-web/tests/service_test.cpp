#include <atomic>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "api/appearance.h"
#include "api/control.h"
#include "api/monitor.h"
#include "api/phases.h"
#include "fake_scene.h"
#include "fake_tape.h"
#include "frame_reader.h"
#include "temporary_folder.h"
#include "test_support.h"
#include "web_client.h"

// The whole server: the simulation runs in one thread, the server in another, the viewers in this one.

using namespace spark;
using namespace spark::test;
using web::test::FrameReader;
using Json = nlohmann::json;
using Catch::Contains;

namespace {

/// Contributes a score and accepts the command `(push n)`.
class Match : public Node, public IMonitorItem, public ITrainer {
  SPARK_CLASS(Match, Node)
 public:
  static void describe(Description<Match>& d) {
    d.implements<IMonitorItem>();
    d.implements<ITrainer>();
  }
  void contribute(Environment& env) override {
    env.put(EnvPolicy::full, "FieldLength", 30.0);
    env.put(EnvPolicy::change, "score_left", score);
    if (std::exchange(goal, false)) env.open(EnvPolicy::once, "goal").add(score).close();
  }
  bool command(const Element& command, std::string&) override {
    if (command.head() != "push") return false;
    score += static_cast<int>(command.at(1).integer());
    goal = true;
    return true;
  }
  int score = 0;
  bool goal = false;
};

/// A material with a texture.
class Painted : public Leaf, public IMaterial {
  SPARK_CLASS(Painted, Leaf)
 public:
  static void describe(Description<Painted>& d) { d.implements<IMaterial>(); }
  Look look() const override { return {{0.25f, 0, 0, 1}, {0.5f, 0, 0, 1}, {0, 0, 1, 1}, {0, 0.5f, 0, 1}, 64}; }
  const std::string& texture() const override { return name; }
  std::string name = "textures/red.png";
};

/// A simulation whose time does not advance.
class StillClock : public Node, public ISimulation {
  SPARK_CLASS(StillClock, Node)
 public:
  static void describe(Description<StillClock>& d) { d.implements<ISimulation>(); }
  void run() override {}
  void runCycles(std::int64_t) override {}
  void stop() override {}
  double time() const override { return 0; }
  std::int64_t cycle() const override { return 0; }
  double step() const override { return 0.02; }
  bool lockstep() const override { return false; }
  bool paced() const override { return false; }
  void setPaced(bool) override {}
};

/// Answers requests to watch, has another value each time, and counts how often it is asked for those of two paths.
class Values : public Node, public IRequests {
  SPARK_CLASS(Values, Node)
 public:
  static void describe(Description<Values>& d) { d.implements<IRequests>(); }
  std::string answer(std::string_view request, control::Watch& watch, bool) override {
    watch.path = Json::parse(request)["path"].get<std::string>();
    watch.started = true;
    return R"({"ok":true})";
  }
  std::string nextOf(control::Watch& watch, bool&) override {
    ++(watch.path == "/leaver" ? leavers : stayers);
    return Json{{"ok", true}, {"text", watch.path}}.dump();
  }
  std::atomic<int> leavers{0}, stayers{0};
};

/// A simulation with a moving robot; its cycles run in a separate thread until stop().
struct RunningServer : TestHost {
  RunningServer() {
    makeFakeScene(kernel);
    kernel.registerClass<Match>();
    kernel.registerClass<Painted>();
    kernel.plugins().use("monitor");
    kernel.plugins().use("monitor-web");
    kernel.plugins().use("files");
    folder.write("models/thing.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n");
    folder.write("textures/red.png", "\x89PNG\r\n\x1a\n and so on");
    folder.write("secret.png", "\x89PNG\r\n\x1a\n");
    setProperty(kernel.create<Node>("FileServer", "/sys/server/file").create("DirectoryFileSystem", "share"), "path",
                folder.path().string());
    kernel.create<Node>("BaseNode", "/sys/server/material").create("Painted", "naowhite");
    auto& root = kernel.root().require<Node>("/usr/scene");
    robot = &root.create<Transform>("Transform", "robot");
    robot->create<Transform>("Transform", "head").create<FakeVisual>("FakeVisual", "mesh").names = {"matLeft",
                                                                                                    "naowhite"};
    kernel.create<Node>("MonitorServer", "/sys/server/monitor").create("Match", "match");
    Leaf& server = kernel.create<Leaf>("WebServer", "/sys/server/web");
    setProperty(server, "port", std::int64_t{0});
    for (const char* limit : {"requestTimeout", "stallTimeout"}) setProperty(server, limit, 3600.0);
    const Value token("token-of-this-test");
    callMethod(server, "setToken", {&token, 1});
    kernel.create<Leaf>("WebMonitor", "/sys/server/monitor/web");
    callMethod(server, "listen", {});
    port = static_cast<unsigned short>(getProperty(server, "port").toInteger());
    REQUIRE(port != 0);
    loop = std::thread([this] { run(); });
  }
  ~RunningServer() { stop(); }
  void stop() {
    stopped = true;
    if (loop.joinable()) loop.join();
  }
  void run() {
    auto& input = kernel.root().require<IInputSource>("/sys/server/web");
    for (std::int64_t cycle = 1; !stopped; ++cycle) {
      const Event event{"", 0.02 * static_cast<double>(cycle), 0.02, cycle, nullptr};
      input.poll();
      kernel.events().channel(phase::kAct).emit(event);
      robot->setLocalPos({0.001f * static_cast<float>(cycle % 1000), 0, 0});
      if (const int wanted = cycle == 1 ? 0 : parts.exchange(0); wanted > 0) robot->create("Transform", "part");
      kernel.events().channel(phase::kPublish).emit(event);
      time = event.time;
      std::this_thread::yield();
    }
  }
  /// Stops the cycles, calls `first`, then keeps polling so that viewers are served.
  template <class F>
  void pauseAndServe(F first) {
    stop();
    first();
    stopped = false;
    loop = std::thread([this] {
      auto& input = kernel.root().require<IInputSource>("/sys/server/web");
      while (!stopped) {
        input.poll();
        std::this_thread::yield();
      }
    });
  }
  TemporaryFolder folder;
  Transform* robot;
  unsigned short port = 0;
  double time = 0;  ///< s, of the last cycle; valid while the simulation is stopped
  std::atomic<bool> stopped{false};
  std::atomic<int> parts{0};
  std::thread loop;
};

Json jsonWith(WebClient& client, std::string_view part) { return Json::parse(client.textWith(part)); }
}  // namespace

TEST_CASE("Viewers see the scene move and send requests, and a referee changes the score") {
  RunningServer server;
  WebClient viewer(server.port), referee(server.port);
  REQUIRE(viewer.watch() == 101);
  REQUIRE(referee.watch() == 101);
  CHECK(jsonWith(viewer, "\"hello\"")["protocol"] == 2);
  Json scene = jsonWith(viewer, "\"scene\"");
  REQUIRE(scene["nodes"].size() == 3);
  CHECK(scene["nodes"][0]["path"] == "/usr/scene/robot");
  CHECK(scene["nodes"][1]["parent"] == 0);
  scene["nodes"][2].erase("file");
  CHECK(
      scene["nodes"][2] ==
      Json::parse(
          R"({"parent":1,"kind":"mesh","load":"models/thing.obj","scale":[1,1,1],"materials":["matLeft","naowhite"],"visible":true})"));
  CHECK(scene["local"].size() == 32);
  CHECK_THAT(viewer.textWith("\"full\":true"), Contains("[\"FieldLength\",30]") && Contains("[\"score_left\",0]"));

  FrameReader reader(2);
  double last = 0;
  for (int i = 0; i < 10; ++i) {
    reader.take(viewer.binary());
    CHECK(reader.time > last);
    last = reader.time;
    CHECK(reader.isNear(1, Matrix::Identity()));
  }

  viewer.say(R"~({"do":"command","id":1,"text":"(push 3)"})~");
  CHECK(jsonWith(viewer, "\"id\":1")["ok"] == false);
  referee.say(R"({"do":"login","token":"token-of-this-test"})");
  CHECK(jsonWith(referee, "\"referee\"")["ok"] == true);
  referee.say(R"~({"do":"command","id":2,"text":"(push 3)"})~");
  CHECK(jsonWith(referee, "\"id\":2")["ok"] == true);
  CHECK(jsonWith(viewer, "\"event\"")["entry"] == Json::parse(R"(["goal",3])"));
  const Json status = jsonWith(viewer, "\"status\"");
  CHECK(status["agents"].empty());
  viewer.say(R"({"do":"get","id":4,"path":"/usr"})");
  CHECK_THAT(viewer.textWith("\"id\":4"), Contains("no control server"));
}

TEST_CASE("A referee's command is put on the tape, and while one is played it is refused") {
  RunningServer server;
  WebClient referee(server.port);
  REQUIRE(referee.watch() == 101);
  referee.say(R"({"do":"login","token":"token-of-this-test"})");
  CHECK(jsonWith(referee, "\"referee\"")["ok"] == true);
  FakeTape* tape = nullptr;
  server.pauseAndServe([&] { tape = &FakeTape::in(server.kernel); });
  referee.say(R"~({"do":"command","id":1,"text":"(push 3)"})~");
  CHECK(jsonWith(referee, "\"id\":1")["ok"] == true);
  server.pauseAndServe([&] {
    CHECK(tape->noted == std::vector<std::string>{"the web's referee: (push 3)"});
    tape->plays = true;
  });
  referee.say(R"~({"do":"command","id":2,"text":"(push 3)"})~");
  CHECK(jsonWith(referee, "\"id\":2")["error"] == "a recording is played: nothing can be changed in it");
}

TEST_CASE("An event has the time of its frame even if it is sent late, and between frames that of the last frame") {
  RunningServer server;
  WebClient viewer(server.port);
  REQUIRE(viewer.watch() == 101);
  viewer.binary();
  double now = 0;
  server.pauseAndServe([&] {
    now = server.time + 1;
    server.kernel.registerClass<StillClock>();
    server.kernel.create<Leaf>("StillClock", "/sys/server/simulation");
    const auto publish = [&](double after) {
      const auto cycle = static_cast<std::int64_t>(1) << 40;  // a cycle in which a frame is due
      server.kernel.events().channel(phase::kPublish).emit({"", now + after, 0.02, cycle, nullptr});
    };
    publish(0);  // a frame that viewers show for a while
    server.kernel.root().require<Match>("/sys/server/monitor/match").goal = true;
    publish(1);
    publish(2);
    Predicates between;
    between.open("between").close();
    server.kernel.root().require<IFrameTaker>("/sys/server/monitor/web").event(Element(between, 0));
  });
  const Json goal = jsonWith(viewer, "\"goal\""), between = jsonWith(viewer, "\"between\"");
  CHECK(goal["time"].get<double>() == Approx(now + 1).margin(0.01));
  CHECK(between["time"].get<double>() == Approx(now + 2).margin(0.01));
}

TEST_CASE("What a viewer watches is asked for until it leaves, and no more") {
  RunningServer server;
  Values* values = nullptr;
  server.pauseAndServe([&] {
    server.kernel.registerClass<Values>();
    values = &server.kernel.create<Values>("Values", IRequests::kPath);
  });
  std::optional<WebClient> leaver(std::in_place, server.port);
  WebClient stayer(server.port);
  REQUIRE(leaver->watch() == 101);
  REQUIRE(stayer.watch() == 101);
  leaver->say(R"({"do":"watch","id":1,"path":"/leaver","property":"p"})");
  stayer.say(R"({"do":"watch","id":2,"path":"/stayer","property":"p"})");
  // How often the first one was asked for when the other one was asked for `more` times.
  const auto afterLooks = [&](int more) {
    for (const int end = values->stayers + more; values->stayers < end;) std::this_thread::yield();
    return values->leavers.load();
  };
  leaver->textWith("/leaver");
  const int once = afterLooks(2);
  CHECK(afterLooks(3) > once);
  leaver.reset();
  while (Json::parse(WebClient::status(server.port))["spectators"] != 1) std::this_thread::yield();
  const int last = afterLooks(2);
  CHECK(afterLooks(3) == last);
}

TEST_CASE("A changed scene is sent again before its first frame") {
  RunningServer server;
  WebClient viewer(server.port);
  REQUIRE(viewer.watch() == 101);
  viewer.binary();
  for (std::size_t parts = 1; parts <= 3; ++parts) {
    server.parts = 1;
    Json scene;
    do scene = jsonWith(viewer, "\"scene\"");
    while (scene["nodes"].size() < 3 + parts);
    FrameReader reader(2 + parts);
    reader.take(viewer.binary());
    CHECK(reader.shape == scene["shape"]);
  }
}

TEST_CASE("Pages are answered while the match runs") {
  RunningServer server;
  WebClient client(server.port);
  const auto page = client.get("/");
  CHECK(page.status == 200);
  CHECK_THAT(page.head, Contains("Content-Security-Policy: default-src 'self'") && Contains("nosniff"));
  CHECK_THAT(page.body, Contains("The viewer was not built"));
  CHECK(client.get("/plain.js").status == 200);  // over the same connection
  CHECK_THAT(client.get("/", "", "HEAD").head, Contains(fmt::format("Content-Length: {}\r\n", page.body.size())));
  CHECK(client.get("/none").status == 404);
  const Json status = Json::parse(WebClient::status(server.port));
  CHECK(status["type"] == "status");
  CHECK(status["spectators"] == 0);
}

TEST_CASE("A scene has its materials, and viewers fetch its meshes and textures and nothing else") {
  RunningServer server;
  WebClient viewer(server.port), client(server.port);
  REQUIRE(viewer.watch() == 101);
  const Json scene = jsonWith(viewer, "\"scene\"");
  REQUIRE(scene["materials"].size() == 1);
  const Json& material = scene["materials"][0];
  CHECK(material["name"] == "naowhite");
  CHECK(material["diffuse"] == Json::parse("[0.5,0,0,1]"));
  CHECK(material["ambient"] == Json::parse("[0.25,0,0,1]"));
  CHECK(material["specular"] == Json::parse("[0,0,1,1]"));
  CHECK(material["emission"] == Json::parse("[0,0.5,0,1]"));
  CHECK(material["shininess"] == 64);
  CHECK(material["texture"] == "textures/red.png");

  const std::string mesh = "/" + scene["nodes"][2]["file"].get<std::string>(),
                    picture = "/" + material["picture"].get<std::string>();
  const auto triangles = client.get(mesh);
  CHECK(triangles.status == 200);
  CHECK_THAT(triangles.head, Contains("immutable") && Contains("application/octet-stream"));
  CHECK_THAT(triangles.body, Contains(R"({"material":"paint","corners":3})"));
  CHECK(client.get(mesh, "", "HEAD").head.find("Content-Length: " + std::to_string(triangles.body.size())) !=
        std::string::npos);
  const auto texture = client.get(picture);
  CHECK_THAT(texture.head, Contains("image/png") && Contains("nosniff"));
  CHECK(texture.body.size() == 18);
  const std::string folder = picture.substr(0, picture.rfind('/') + 1);
  for (const std::string& other : {folder + "7", folder + "../../secret.png", folder + "secret.png",
                                   std::string("/texture/secret.png"), std::string("/mesh/..%2f..%2fetc%2fpasswd")})
    CHECK(client.get(other).status == 404);
}

TEST_CASE("A server that is removed while a viewer waits for a mesh does not wait for it") {
  RunningServer server;
  WebClient viewer(server.port), client(server.port);
  REQUIRE(viewer.watch() == 101);
  const Json scene = jsonWith(viewer, "\"scene\"");
  server.stop();
  client.sendRaw("GET /" + scene["nodes"][2]["file"].get<std::string>() +
                 " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port) + "\r\n\r\n");
  auto& servers = server.kernel.root().require<Node>("/sys/server");
  servers.remove(*servers.child("web"));
  CHECK(client.waitForClose().empty());
}

TEST_CASE("The server may be removed while viewers watch, and a new one may be created") {
  RunningServer server;
  WebClient viewer(server.port);
  REQUIRE(viewer.watch() == 101);
  viewer.binary();
  server.stop();
  auto& servers = server.kernel.root().require<Node>("/sys/server");
  servers.remove(*servers.child("web"));
  viewer.waitForClose();
  server.kernel.events().channel(phase::kPublish).emit({"", 1, 0.02, 1000, nullptr});
  Leaf& next = server.kernel.create<Leaf>("WebServer", "/sys/server/web");
  setProperty(next, "port", std::int64_t{0});
  callMethod(next, "listen", {});
  CHECK(WebClient(static_cast<unsigned short>(getProperty(next, "port").toInteger())).get("/").status == 200);
}
