#pragma once
/// \file
/// The simulation of lua/soccer.lua with humanoids and a selectable engine, without network, stepped cycle by cycle.

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "api/agents.h"
#include "api/physics.h"
#include "shadow_engine.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::oracle {

/// A player that beams to its start pose and then drives its motors as a test says.
class Puppet : public Behavior {
  SPARK_CLASS(Puppet, Behavior)
 public:
  static void describe(Description<Puppet>& d) { d.doc("Drives its motors as a test says."); }
  int number = 0;                                             ///< from 0; every second one plays for the other team
  double x = 0, y = 0, angle = 0;                             ///< start pose [m, deg]
  std::vector<std::string> motors;                            ///< empty: stands still
  std::function<double(std::size_t motor, int cycle)> speed;  ///< rad/s

  void start(Predicates& actions) override {
    actions.open("scene").add("rsg/agent/nao/nao_hetero.rsg").add(number % 4).close();
  }
  void think(const Predicates&, Predicates& actions) override {
    ++thoughts_;
    if (thoughts_ == 1)
      actions.open("init").pair("unum", number / 2 + 1).pair("teamname", number % 2 ? "Right" : "Left").close();
    if (thoughts_ == 4) actions.open("beam").add(x).add(y).add(angle).close();
    if (!speed) return;
    ++cycle_;
    for (std::size_t i = 0; i < motors.size(); ++i) actions.open(motors[i]).add(speed(i, cycle_)).close();
  }

 private:
  int thoughts_ = 0, cycle_ = 0;
};

class Pitch : test::TestHost {
 public:
  struct StartPose {
    double x, y, angle = 0;
  };
  using Settings = std::vector<std::pair<std::string, Value>>;

  /// Makes a robot at each pose, which is in the frame of the robot's own team.
  explicit Pitch(const std::vector<StartPose>& poses, const Settings& settings = {}) {
    ScriptServer& lua = scripts(kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = {} }", "pitch");
    std::map<std::string, Value> all{{"/sys/server/simulation.rate", "max"},
                                     {"/sys/server/net/agents.port", 0},
                                     {"/sys/server/net/monitors.port", 0},
                                     {"exactReplay", false},
                                     {"Soccer.BeamNoiseXY", 0},
                                     {"Soccer.BeamNoiseAngle", 0}};
    for (const auto& [key, value] : settings) all[key] = value;
    for (const auto& [key, value] : all) lua.addOverride(key, value);
    lua.runConfig("soccer.lua");
    kernel.registerClass<Puppet>();
    kernel.create("Node", "/usr/agent");
    for (const StartPose& pose : poses) addPuppet(pose);
    run(25);
    REQUIRE(robots().size() == poses.size());
    for (std::size_t i = 0; i < puppets_.size(); ++i) {
      std::vector<Effector*> effectors;
      robots()[i]->collect(effectors);
      for (Effector* e : effectors)
        if (e->parent()->as<IJoint>()) puppets_[i]->motors.push_back(e->predicate());
      REQUIRE(puppets_[i]->motors.size() > 20);
    }
  }
  using test::TestHost::kernel;

  const std::vector<AgentAspect*>& robots() {
    return kernel.root().require<IGameControl>("/sys/server/gamecontrol").agents();
  }
  /// The soccer ball.
  IRigidBody& ball() { return *kernel.root().require<Node>("/usr/scene/Ball").childOf<IRigidBody>(); }
  void run(int cycles) { callMethod(simulation(), "runCycles", std::vector<Value>{cycles}); }
  Leaf& simulation() { return kernel.root().require<Leaf>("/sys/server/simulation"); }
  std::uint64_t hash() { return stateHash(kernel.root().require<Leaf>("/usr/scene")); }
  /// Replaces the engine by a ShadowEngine.
  ShadowEngine& watch() { return oracle::watch(kernel); }

  /// Sets the speeds of all motors of all robots from now on. By default they swing.
  void move(const std::function<double(std::size_t motor, int cycle)>& speed = swing) {
    for (Puppet* p : puppets_) p->speed = speed;
  }
  static double swing(std::size_t motor, int cycle) {
    return 0.8 * std::sin(0.06 * cycle + 0.7 * static_cast<double>(motor));
  }
  /// Full speed in changing directions.
  static double wild(std::size_t motor, int cycle) {
    return (cycle / 4 * 7919 + static_cast<int>(motor) * 104729) % 3 * 6.0 - 6;
  }
  /// Starts play, so that the ball can roll. Before kick-off the rules put it back in each cycle.
  void playOn() {
    setProperty(kernel.root().require<Leaf>("/sys/server/gamecontrol/GameStateAspect"), "playMode", "PlayOn");
  }
  /// Pushes all bodies of a robot.
  void push(std::size_t robot, const Vec3& velocity) {
    std::vector<IRigidBody*> bodies;
    robots()[robot]->collect(bodies);
    for (IRigidBody* b : bodies) b->setVelocity(velocity);
  }
  void weaken(double torque) {
    std::vector<IJoint*> joints;
    for (AgentAspect* robot : robots()) robot->collect(joints);
    for (IJoint* j : joints)
      if (j->jointType() == engine::JointType::hinge) j->setParameter(engine::JointParameter::maxForce, 0, torque);
  }

 private:
  void addPuppet(const StartPose& pose) {
    auto made = kernel.classOf("Puppet").create();
    auto& puppet = static_cast<Puppet&>(*made);
    puppet.number = static_cast<int>(puppets_.size());
    puppet.setName("puppet" + std::to_string(puppet.number));
    puppet.x = pose.x, puppet.y = pose.y, puppet.angle = pose.angle;
    puppets_.push_back(&puppet);
    kernel.root().require<Node>("/usr/agent").add(std::move(made));
    run(8);
  }
  std::vector<Puppet*> puppets_;
};

}  // namespace spark::oracle
