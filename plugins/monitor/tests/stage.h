#pragma once
/// \file
/// A monitor server with a small scene. The test runs its cycles.

#include <memory>

#include "api/agents.h"
#include "fake_scene.h"
#include "replica.h"
#include "test_support.h"

namespace spark::test {

/// Contributes a score and, on request, events with a running number.
class TestItem : public Node, public IMonitorItem {
  SPARK_CLASS(TestItem, Node)
 public:
  static void describe(Description<TestItem>& d) { d.implements<IMonitorItem>(); }
  void contribute(Environment& env) override {
    env.put(EnvPolicy::full, "FieldLength", 30.0);
    env.put(EnvPolicy::always, "time", time);
    env.put(EnvPolicy::change, "score", score);
    for (; waiting > 0; --waiting) env.open(EnvPolicy::once, "foul").add(++fouls).close();
  }
  double time = 0;
  int score = 0, fouls = 0, waiting = 0;
};

/// Accepts `(push n)`.
class TestTrainer : public Node, public ITrainer {
  SPARK_CLASS(TestTrainer, Node)
 public:
  static void describe(Description<TestTrainer>& d) { d.implements<ITrainer>(); }
  bool command(const Element& command, std::string& why) override {
    if (command.head() != "push") return false;
    if (command.size() < 2)
      why = "expected a number, found none";
    else
      pushed.push_back(command.at(1).integer());
    return true;
  }
  std::vector<std::int64_t> pushed;
};

/// Accepts `(pull n)`, and lists it among its commands.
class ListingTrainer : public Node, public ITrainer {
  SPARK_CLASS(ListingTrainer, Node)
 public:
  static void describe(Description<ListingTrainer>& d) {
    d.implements<ITrainer>();
    d.property("commands", &ListingTrainer::commands);
  }
  bool command(const Element& command, std::string&) override { return command.head() == "pull"; }
  std::vector<std::string> commands() const { return {"pull"}; }
};

/// A message format of its own: every word is a push of its length.
class WordParser : public Node, public IParser {
  SPARK_CLASS(WordParser, Node)
 public:
  static void describe(Description<WordParser>& d) { d.implements<IParser>(); }
  ReadResult parse(std::string_view message, Predicates& out) override {
    out.pair("push", static_cast<std::int64_t>(message.size()));
    return {};
  }
  void write(const Predicates&, std::string&) override {}
};

/// A monitor server with a small scene: a light, a robot of two parts, a box.
struct Stage : TestHost {
  Stage() : scene(makeFakeScene(kernel)) {
    kernel.log().setLevel(Level::debug);
    kernel.registerClass<TestItem>();
    kernel.registerClass<TestTrainer>();
    kernel.plugins().use("monitor");
    kernel.plugins().use("monitor-sexp");
    auto& root = kernel.root().require<Node>("/usr/scene");
    root.create<FakeVisual>("FakeVisual", "light").kindIs = IVisual::Kind::light;
    auto& space = root.create<Node>("BaseNode", "space");  // transparent
    for (const char* name : {"robot", "box"}) parts.push_back(&space.create<Transform>("Transform", name));
    parts.push_back(&parts[0]->create<Transform>("Transform", "head"));
    head = &parts[2]->create<FakeVisual>("FakeVisual", "mesh");
    parts[1]->create<FakeVisual>("FakeVisual", "mesh").kindIs = IVisual::Kind::singleMaterial;
    port = &kernel.create<Node>("Node", "/sys/server/net/monitors");
    monitor = &kernel.create<IConnectionConsumer>("MonitorServer", "/sys/server/monitor");
    server = &kernel.root().require<IMonitorServer>("/sys/server/monitor");
    node().create("SexpMonitor", "encoder");
    item = &node().create<TestItem>("TestItem", "item");
    trainer = &node().create<TestTrainer>("TestTrainer", "trainer");
  }
  Node& node() { return kernel.root().require<Node>("/sys/server/monitor"); }
  FakeConnection& connect() {
    connections.push_back(std::make_unique<FakeConnection>(*port, connections.size() + 1));
    monitor->connected(*connections.back());
    return *connections.back();
  }
  /// Runs one cycle, whether a frame is due or not.
  void cycle() {
    ++cycles;
    const Event event{"", 0.02 * cycles, 0.02, cycles, nullptr};
    kernel.events().channel("act").emit(event);
    item->time = event.time;
    for (std::size_t i = 0; i < parts.size(); ++i)
      parts[i]->setLocalPos({0.004f * (cycles % 7), 0.01f * i * cycles, -1.f / cycles});
    kernel.events().channel("publish").emit(event);
  }
  void nextFrame() {
    do cycle();
    while (cycles % 2);
  }
  FakeSceneServer& scene;
  std::vector<Transform*> parts;
  FakeVisual* head;
  Node* port;
  IConnectionConsumer* monitor;
  IMonitorServer* server;
  TestItem* item;
  TestTrainer* trainer;
  std::vector<std::unique_ptr<FakeConnection>> connections;
  std::int64_t cycles = 0;
};

/// The full message of a new client.
inline Replica freshReplica(Stage& stage) {
  Replica replica;
  FakeConnection& connection = stage.connect();
  replica.take(connection.read());
  stage.monitor->disconnected(connection);
  return replica;
}

/// True if both show the same scene, with matrices equal to within `precision`.
inline bool same(const Replica& a, const Replica& b, double precision) {
  if (a.nodes.size() != b.nodes.size() || a.score != b.score) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const auto &x = a.nodes[i], &y = b.nodes[i];
    if (x.depth != y.depth || x.type != y.type || x.visible != y.visible || x.rest != y.rest ||
        x.matrix.size() != y.matrix.size())
      return false;
    for (std::size_t k = 0; k < x.matrix.size(); ++k)
      if (std::abs(x.matrix[k] - y.matrix[k]) > precision) return false;
  }
  return true;
}

}  // namespace spark::test
