#pragma once
/// \file
/// A match without a network: sphere players whose actions the test sets and whose percepts it reads.

#include <catch2/catch.hpp>

#include "absence.h"
#include "api/agents.h"
#include "api/monitor.h"
#include "api/physics.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// Sends the actions in `next` once, and stores its percepts.
class Puppet : public Behavior {
  SPARK_CLASS(Puppet, Behavior)
 public:
  static void describe(Description<Puppet>& d) { d.doc("A player controlled by a test."); }
  void start(Predicates& actions) override { readSexp("(scene " + robot + ")", actions); }
  void think(const Predicates& percepts, Predicates& actions) override {
    heard.clear();
    writeSexp(percepts, 2, heard);
    all += heard;
    readSexp(next, actions);
    next.clear();
  }
  std::string robot = "rsg/agent/sphere.rsg";
  std::string next;   ///< S-expressions
  std::string heard;  ///< the last percepts
  std::string all;    ///< all percepts
};

/// A soccer match on the field of 2004, or on the current league's field if `sphere` is false.
struct SoccerMatch : TestHost {
  explicit SoccerMatch(bool sphere = true) {
    for (const char* p : {"files", "scene", "scene-rsg", "physics", "physics-ode", "simulation", "parser-sexp",
                          "gamecontrol", "sensors", "effectors", "monitor", "soccer"})
      kernel.plugins().use(p);
    kernel.registerClass<Puppet>();
    kernel.create("FileServer", "/sys/server/file");
    Leaf& files = kernel.create("DirectoryFileSystem", "/sys/server/file/scenes");
    setProperty(files, "path", SPARK_SCENES);
    setProperty(files, "prefix", "rsg");
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("RsgImporter", "/sys/server/scene/rsg");
    kernel.create("Scene", "/usr/scene");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    kernel.create("World", "/usr/scene/world");
    kernel.create("Space", "/usr/scene/space");
    setProperty(kernel.create("Simulation", "/sys/server/simulation"), "rate", "max");
    kernel.create("GameControl", "/sys/server/gamecontrol");
    kernel.create("SoccerSettings", "/sys/variables/Soccer");
    if (sphere) sphereLeague();
    for (const char* aspect : {"GameStateAspect", "BallStateAspect", "SoccerRuleAspect"})
      kernel.create(aspect, std::string("/sys/server/gamecontrol/") + aspect);
    kernel.create("MonitorServer", "/sys/server/monitor");
    for (const char* item : {"GameStateItem", "SoccerRuleItem", "TrainerCommandParser"})
      kernel.create(item, std::string("/sys/server/monitor/") + item);
  }
  void sphereLeague() {
    const std::pair<const char*, double> values[] = {
        {"FieldLength", 104},     {"FieldWidth", 68},      {"GoalWidth", 7.32},        {"GoalDepth", 2},
        {"GoalHeight", 0.5},      {"PenaltyLength", 16.5}, {"PenaltyWidth", 33},       {"FreeKickDistance", 9.15},
        {"FreeKickMoveDist", 10}, {"AgentRadius", 0.22},   {"AgentLinearDrag", 600},   {"BallRadius", 0.111},
        {"BallMass", 0.425878},   {"BallLinearDrag", 0.1}, {"BallAngularDrag", 0.001}, {"BallMaxSpeed", 40},
        {"BeamNoiseXY", 0},       {"BeamNoiseAngle", 0}};
    for (const auto& [name, value] : values) set(name, value);
    set("MaxRobotTypeCount", 11);
    set("MinRobotTypesCount", 1);
    set("MaxSumTwoRobotTypes", 22);
  }
  void set(const char* name, Value value) { setProperty(at("/sys/variables/Soccer"), name, value); }
  Leaf& at(std::string_view path) { return kernel.root().require<Leaf>(path); }
  Value get(std::string_view path, std::string_view property) { return getProperty(at(path), property); }

  void importField() {
    kernel.root()
        .require<ISceneServer>("/sys/server/scene")
        .importScene("rsg/soccer/field.rsg", kernel.root().require<Node>("/usr/scene"), {});
  }
  void run(int cycles) {
    const Value n(cycles);
    callMethod(at("/sys/server/simulation"), "runCycles", std::span(&n, 1));
  }
  void runSeconds(double seconds) { run(static_cast<int>(std::lround(seconds / 0.02))); }

  /// Connects a puppet with a robot but without a team.
  Puppet& connect(const std::string& name) {
    auto& p = kernel.create<Puppet>("Puppet", "/usr/agent/" + name);
    run(5);
    return p;
  }
  /// Sends actions and runs until they have taken effect.
  void act(Puppet& p, const std::string& actions) {
    p.next = actions;
    run(2);
  }
  /// Connects a puppet that joins a team.
  Puppet& join(const std::string& team, int unum) {
    Puppet& p = connect(team + std::to_string(unum));
    act(p, "(init (unum " + std::to_string(unum) + ")(teamname " + team + "))");
    run(2);
    return p;
  }
  IRigidBody& bodyOf(int agent) {
    return kernel.root().require<IRigidBody>("/usr/scene/AgentAspect" + std::to_string(agent) + "/body/physics");
  }
  IRigidBody& ball() { return kernel.root().require<IRigidBody>("/usr/scene/Ball/physics"); }
  Leaf& stateOf(int agent) { return at("/usr/scene/AgentAspect" + std::to_string(agent) + "/body/AgentState"); }

  static void place(IRigidBody& body, double x, double y, double z) {
    body.setPose({Vec3(x, y, z), Mat3::Identity()});
    body.setVelocity(Vec3::Zero());
    body.setAngularVelocity(Vec3::Zero());
    body.enable();
  }
  void placeAgent(int agent, double x, double y) { place(bodyOf(agent), x, y, 0.22); }
  void placeBall(double x, double y, double z = 0.111) { place(ball(), x, y, z); }
  /// Places the agent at the ball, on its -x side, so that it touches the ball.
  void touch(int agent) {
    const Vec3 b = ball().state().position;
    place(bodyOf(agent), b.x() - 0.3, b.y(), 0.22);
    run(1);
  }
  std::string mode() { return get("/sys/server/gamecontrol/GameStateAspect", "playMode").toString(); }
  void setMode(const char* mode) { setProperty(at("/sys/server/gamecontrol/GameStateAspect"), "playMode", mode); }
  double gameTime() { return get("/sys/server/gamecontrol/GameStateAspect", "time").toNumber(); }
  std::string score() { return get("/sys/server/gamecontrol/GameStateAspect", "score").text(); }
  /// Executes a trainer command. Returns "", or the reason why it had no effect.
  std::string trainer(const std::string& text) {
    Predicates p;
    readSexp(text, p);
    std::string why = "unknown";
    for (const Element e : p) {
      why.clear();
      if (!kernel.root().require<ITrainer>("/sys/server/monitor/TrainerCommandParser").command(e, why)) why = "unknown";
    }
    return why;
  }
};

}  // namespace spark::test
