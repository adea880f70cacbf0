#pragma once
/// \file
/// A simulation that can load the installed base's scene files, and an inventory of a loaded subtree.

#include <map>

#include "api/agents.h"
#include "api/physics.h"
#include "test_support.h"

namespace spark::test {

/// Numbers of the nodes below a node, by kind.
struct Inventory {
  int nodes = 0, transforms = 0, bodies = 0, colliders = 0, joints = 0, angularMotors = 0, perceptors = 0,
      effectors = 0;
  double mass = 0;
  std::map<std::string, int> classes;

  void add(const Node& root) {
    for (const auto& child : root.children()) {
      if (child->classObject()->name() == "World" ||
          (child->classObject()->name() == "Space" && child->name() == "space"))
        continue;
      ++nodes;
      ++classes[child->classObject()->name()];
      transforms += child->as<Transform>() != nullptr;
      perceptors += child->as<Perceptor>() != nullptr;
      effectors += child->as<Effector>() != nullptr;
      colliders += child->as<ICollider>() != nullptr;
      if (auto body = child->as<IRigidBody>()) ++bodies, mass += body->mass();
      if (auto joint = child->as<IJoint>())
        ++(joint->jointType() == engine::JointType::angularMotor ? angularMotors : joints);
      if (const Node* inner = child->asNode()) add(*inner);
    }
  }
};

/// A kernel with all servers and variables that scenes of the humanoid league need.
struct ReferenceHost {
  TestHost host;
  Kernel& kernel = host.kernel;
  Node* scene = nullptr;
  Leaf* importer = nullptr;

  explicit ReferenceHost(const std::filesystem::path& reference) {
    for (const char* plugin :
         {"files", "scene", "scene-rsg", "physics", "physics-ode", "gamecontrol", "sensors", "effectors", "soccer"})
      kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/reference"), "path",
                (reference / "scenes-reference").string());
    kernel.create("SceneServer", "/sys/server/scene");
    importer = &kernel.create("RsgImporter", "/sys/server/scene/rsg");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    scene = &kernel.create<Node>("Scene", "/usr/scene");
    scene->create("World", "world");
    scene->create("Space", "space");
    variables("Soccer", {{"FieldLength", 30.0},
                         {"FieldWidth", 20.0},
                         {"FieldHeight", 40.0},
                         {"GoalWidth", 2.1},
                         {"GoalDepth", 0.6},
                         {"GoalHeight", 0.8},
                         {"PenaltyLength", 1.8},
                         {"PenaltyWidth", 3.9},
                         {"FreeKickDistance", 2.0},
                         {"BorderSize", 0.0},
                         {"BallRadius", 0.042},
                         {"BallMass", 0.026}});
    variables("Nao", {{"UseTexture", "true"}});
    const double thigh[] = {-0.04, -0.05832, -0.04, -0.067868424, -0.04},
                 ankle[] = {-0.055, -0.07332, -0.055, -0.082868424, -0.055};
    const double elbow[] = {0.07, 0.10664, 0.07, 0.125736848, 0.07};
    List types;
    for (int i = 0; i < 5; ++i) {
      List type{List{"Hip1RelTorso_X", i == 3 ? 0.072954143 : 0.055},
                List{"Hip1RelTorso_Z", -0.115},
                List{"ThighRelHip2_Z", thigh[i]},
                List{"AnkleRelShank_Z", ankle[i]},
                List{"lj5_max_abs_speed", i == 2 ? 8.80667 : 6.1395},
                List{"lj6_max_abs_speed", i == 2 ? 3.47234 : 6.1395},
                List{"ElbowRelUpperArm_Y", elbow[i]},
                List{"UseToe", i == 4 ? "true" : "false"}};
      if (i == 4) type.push_back(List{"ToeLength", 0.035517656});
      types.push_back(std::move(type));
    }
    setProperty(kernel.create("Variables", "/sys/variables/NaoType"), "value", types);
  }
  Node& agent(const std::string& name) { return scene->create<Node>("AgentAspect", name); }
  void import(const std::string& file, Node& root, const List& arguments = {}) {
    kernel.root().require<ISceneServer>("/sys/server/scene").importScene(file, root, arguments);
  }
  std::int64_t count(const std::string& property) const { return getProperty(*importer, property).toInteger(); }

 private:
  void variables(const std::string& group, const std::vector<std::pair<std::string, Value>>& all) {
    Leaf& node = kernel.create("Variables", "/sys/variables/" + group);
    for (const auto& [name, value] : all) callMethod(node, "set", List{name, value});
  }
};

}  // namespace spark::test
