#include <catch2/catch.hpp>

#include "api/monitor.h"
#include "api/phases.h"
#include "api/physics.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

Value call(Leaf& node, const char* method, const std::vector<Value>& arguments) {
  return callMethod(node, method, arguments);
}

/// A ball above the ground, and the events that monitors receive.
struct Yard {
  TestHost host;
  Kernel& kernel = host.kernel;
  IMonitorItem* sounds = nullptr;
  double time = 0;

  explicit Yard(double height) {
    for (const char* plugin : {"scene", "physics", "physics-ode", "monitor", "sounds"}) kernel.plugins().use(plugin);
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("Scene", "/usr/scene");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("World", "/usr/scene/world");
    kernel.create("Space", "/usr/scene/space");
    setProperty(at("/usr/scene/world"), "gravity", List{0.0, 0.0, -9.81});
    kernel.create("MonitorServer", "/sys/server/monitor");
    sounds = kernel.create<Leaf>("Sounds", "/sys/server/monitor/sounds").as<IMonitorItem>();
    kernel.create("PlaneCollider", "/usr/scene/ground");
    call(at("/usr/scene/ground"), "setParams", {0.0, 0.0, 1.0, 0.0});
    kernel.create("ContactJointHandler", "/usr/scene/ground/contact");
    setProperty(at("/usr/scene/ground/contact"), "contactBounceMode", false);
    kernel.create("Transform", "/usr/scene/ball");
    setProperty(at("/usr/scene/ball"), "localPos", List{0.5, 0.0, height});
    kernel.create("RigidBody", "/usr/scene/ball/body");
    call(at("/usr/scene/ball/body"), "setSphereTotal", {1.0, 0.1});
    kernel.create("SphereCollider", "/usr/scene/ball/geometry");
    setProperty(at("/usr/scene/ball/geometry"), "radius", 0.1);
    kernel.create("ContactJointHandler", "/usr/scene/ball/geometry/contact");
    setProperty(at("/usr/scene/ball/geometry/contact"), "contactBounceMode", false);
    kernel.create("SoundHandler", "/usr/scene/ball/geometry/sound");
  }
  Leaf& at(const char* path) { return kernel.root().require<Leaf>(path); }
  /// Runs cycles; the sounds as text.
  std::vector<std::string> run(int cycles) {
    std::vector<std::string> out;
    for (int i = 0; i < cycles; ++i, time += 0.02) {
      for (const auto& name : {phase::kPrepare, phase::kPhysics, phase::kPlace})
        kernel.events().channel(name).emit(Event{name, time, 0.02, i});
      Environment env;
      sounds->contribute(env);
      for (const Environment::Entry& e : env.entries) {
        REQUIRE(e.policy == EnvPolicy::once);
        out.push_back(text(Element(env.predicates, e.token)));
      }
    }
    return out;
  }
  static std::string text(const Element& event) {
    std::string out;
    for (const Element part : event)
      out += (out.empty() ? "" : " ") +
             (part.isNumber() ? fmt::format("{:.2f}", part.number()) : std::string(part.text()));
    return out;
  }
};

}  // namespace

TEST_CASE("a ball that falls makes one sound, as loud as it is fast, and none while it rests") {
  Yard yard(1.1);
  const auto heard = yard.run(200);
  REQUIRE(heard.size() == 1);
  REQUIRE_THAT(heard[0], Catch::StartsWith("sound bump 0.9"));  // 4.5 m/s of 5
  REQUIRE_THAT(heard[0], Catch::Contains(" 0.50 0.00 "));
}

TEST_CASE("a ball that is kicked from the ground makes a sound, and one that is put down gently none") {
  Yard yard(0.1);
  REQUIRE(yard.run(50).empty());
  yard.at("/usr/scene/ball/body").as<IRigidBody>()->setVelocity({0, 0, -2});
  REQUIRE(yard.run(50).size() == 1);
}

TEST_CASE("scripts play sounds; wrong arguments are refused, and more than a frame holds are counted") {
  Yard yard(5);
  Leaf& sounds = yard.at("/sys/server/monitor/sounds");
  call(sounds, "play", {"whistle", 0.5, List{1.0, 2.0, 3.0}});
  REQUIRE(yard.run(1) == std::vector<std::string>{"sound whistle 0.50 1.00 2.00 3.00"});
  REQUIRE_THROWS_WITH(call(sounds, "play", {"two words", 0.5, List{1.0, 2.0, 3.0}}), Catch::Contains("one word"));
  REQUIRE_THROWS_WITH(call(sounds, "play", {"whistle", 1.5, List{1.0, 2.0, 3.0}}), Catch::Contains("0 to 1"));
  REQUIRE_THROWS_WITH(call(sounds, "play", {"whistle", 1.0, List{NAN, 2.0, 3.0}}), Catch::Contains("finite"));
  for (int i = 0; i < 70; ++i) call(sounds, "play", {"whistle", 1.0, List{0.0, 0.0, 0.0}});
  REQUIRE(yard.run(1).size() == 64);
  REQUIRE(getProperty(sounds, "dropped").toInteger() == 6);
}
