#pragma once
/// \file
/// A scene without meshes and a connection without a network, for tests of monitors.

#include <deque>
#include <string>
#include <vector>

#include "api/monitor.h"
#include "api/net.h"

namespace spark::test {

/// A visual node whose properties a test sets.
class FakeVisual : public SceneNode, public IVisual {
  SPARK_CLASS(FakeVisual, SceneNode)
 public:
  static void describe(Description<FakeVisual>& d) { d.implements<IVisual>(); }
  Leaf& leaf() override { return *this; }
  Kind kind() const override { return kindIs; }
  const std::string& load() const override { return loads; }
  Vec3f scale() const override { return size; }
  bool visible() const override { return shown; }
  void setVisible(bool on) override { shown = on; }
  bool transparent() const override { return glass; }
  const std::vector<std::string>& materials() const override { return names; }
  void setMaterialName(std::size_t i, std::string name) override { names.at(i) = std::move(name); }
  std::array<Color, 3> lightColors() const override { return colors; }

  Kind kindIs = Kind::mesh;
  std::string loads = "models/thing.obj";
  Vec3f size{1, 1, 1};
  bool shown = true, glass = false;
  std::vector<std::string> names;
  std::array<Color, 3> colors{};
};

/// The scene server of a scene at /usr/scene.
class FakeSceneServer : public Node, public ISceneServer {
  SPARK_CLASS(FakeSceneServer, Node)
 public:
  static void describe(Description<FakeSceneServer>& d) { d.implements<ISceneServer>(); }
  Leaf& leaf() override { return *this; }
  Node* activeScene() override { return kernel().root().find<Node>("/usr/scene"); }
  Node& scene() override { return kernel().root().require<Node>("/usr/scene"); }
  void importScene(std::string_view, Node&, const List&) override {}
  void markModified() override { ++modified; }
  std::uint64_t modifiedCount() const override { return modified; }
  void placeScene(Node&) override {}
  void place() override {}
  const std::vector<Import>& imports() const override { return imported; }
  std::uint64_t modified = 0;
  std::vector<Import> imported;
};

/// The connection of a client. It holds one message in flight and is not idle until the client has read it.
class FakeConnection : public IConnection {
 public:
  FakeConnection(Node& port, std::uint64_t id) : port_(port), id_(id), peer_("client" + std::to_string(id)) {}
  std::uint64_t id() const override { return id_; }
  const std::string& peer() const override { return peer_; }
  Node& port() override { return port_; }
  bool send(std::string_view message) override {
    if (!idle()) return false;
    inFlight.emplace_back(message);
    ++sent;
    return true;
  }
  bool idle() const override { return inFlight.empty(); }
  double stalledSeconds() const override { return stalled; }
  void close(std::string_view reason) override { closed = reason, ++closes; }
  /// The client reads the message in flight; "" when there is none.
  std::string read() {
    if (inFlight.empty()) return {};
    std::string message = std::move(inFlight.front());
    inFlight.pop_front();
    return message;
  }

  std::deque<std::string> inFlight;
  double stalled = 0;
  std::string closed;
  int closes = 0, sent = 0;

 private:
  Node& port_;
  std::uint64_t id_;
  std::string peer_;
};

/// Registers the fakes, and makes a scene and its server.
inline FakeSceneServer& makeFakeScene(Kernel& kernel) {
  kernel.registerClass<SceneNode>();
  kernel.registerClass<Transform>();
  kernel.registerClass<FakeVisual>();
  kernel.registerClass<FakeSceneServer>();
  kernel.create("BaseNode", "/usr/scene");
  return kernel.create<FakeSceneServer>("FakeSceneServer", "/sys/server/scene");
}

}  // namespace spark::test
