#include "temporary_folder.h"
#include "worlds.h"

namespace spark::test {

namespace {

constexpr double kLying = 0.2, kStanding = 0.6;  // m: heights of boxes

std::string box(double height, int type) { return fmt::format("rsg/agent/scenario.rsg {} {}", height, type); }

/// The trainer command that moves player `unum` of a team.
std::string put(const char* team, int unum, double x, double y, double z = 0.3) {
  return fmt::format("(agent (unum {})(team {})(pos {} {} {}))", unum, team, x, y, z);
}
std::string ball(double x, double y, double vx = 0, double vy = 0) {
  return fmt::format("(ball (pos {} {} 0.042)(vel {} {} 0))", x, y, vx, vy);
}

// ---- boxes as players, which trigger the rules of play and all fouls ----

enum { kA1, kA2, kA3, kA4, kA5, kB1, kB2, kB3, kB4 };

void makeFouls(World& w) {
  w.configure("soccer.lua", {{"exactReplay", false},
                             {"compat", "L"},
                             {"Soccer.GroundMaxTime", 1},
                             {"Soccer.BallHoldMaxTime", 0.5},
                             {"Soccer.RuleHalfTime", 18},
                             {"Soccer.RuleGoalPauseTime", 1},
                             {"Soccer.PassModeDuration", 1},
                             {"Soccer.PassModeMinOppBallDist", 0.5},
                             {"/sys/server/gamecontrol.requests", true}});
  w.kernel.create("OffsideAspect", "/sys/server/gamecontrol/OffsideAspect");
  Leaf& requestRule = w.kernel.create("RequestAspect", "/sys/server/gamecontrol/requestRule");
  setProperty(requestRule, "tolerance", 1);
  setProperty(requestRule, "allowed", Value(List{"rsg/agent/scenario.rsg"}));
  for (int n = 1; n <= 5; ++n) w.join("A", n, box(kStanding, n % 3));
  for (int n = 1; n <= 3; ++n) w.join("B", n, box(kStanding, n % 3));
  w.join("B", 4, box(kLying, 0));
}

std::string apart() {
  std::string all;
  for (int n = 1; n <= 5; ++n) all += put("Left", n, -2.0 * n, 7);
  for (int n = 1; n <= 3; ++n) all += put("Right", n, 2.0 * n, 7);
  return all + put("Right", 4, 8, 3, 0.1);
}

/// The commands of the trainer and the players in a cycle of the match.
void inputFouls(World& w, int cycle) {
  const auto at = [cycle](int c) { return cycle == c; };
  const auto during = [cycle](int from, int to) { return cycle >= from && cycle < to; };
  if (at(1)) w.trainer("(playMode PlayOn)" + apart() + ball(0, -9)), w.player(kA2).next = "(say hello)";
  // a request that the rules do not allow
  if (at(10)) w.player(kA3).next = "(request (perceptor GPS) (name gps2))";
  // too many players of a team in their own penalty area
  if (at(20))
    w.trainer(put("Left", 1, -13.5, 1.5) + put("Left", 2, -13.6, 0.5) + put("Left", 3, -14.5, -0.5) +
              put("Left", 4, -14.5, -1.5));
  // three players touch each other
  if (at(80)) w.trainer(apart() + put("Left", 2, 0, 0) + put("Right", 2, 0.298, 0));
  if (at(84)) w.trainer(put("Left", 3, -0.298, 0));
  // a player runs into an opponent
  if (at(120)) w.trainer(apart() + put("Right", 3, 0.35, 0, 0.4) + put("Left", 2, 0, 0));
  if (at(121)) w.player(kB3 + 0).next = "(force -200 0 0)";
  // a player holds the ball next to an opponent
  if (during(170, 230)) w.trainer(put("Right", 2, 0.6, 0) + put("Left", 2, 0, 0, 0.4) + ball(0.1, 0));
  // pass mode
  if (at(240)) w.trainer(apart() + put("Left", 2, -3, 0) + ball(-2.7, 0));
  if (at(250)) w.player(kA2).next = "(pass)";
  if (at(280)) w.trainer(ball(-2.7, 0, 1.5, 0.5));
  // a pass to a player in an offside position
  if (at(340)) w.trainer("(playMode PlayOn)" + apart() + put("Left", 3, 9, -2) + ball(2, 0));
  if (at(345)) w.trainer(put("Left", 2, 1.82, 0));
  if (at(350)) w.trainer(put("Left", 2, -3, 5) + ball(9.3, -2));
  if (at(352)) w.trainer(put("Left", 3, 9.12, -2));
  // the ball crosses each line
  if (at(420)) w.trainer("(playMode PlayOn)" + apart() + ball(5, 9.9, 0, 3));
  if (at(480)) w.trainer("(playMode PlayOn)" + ball(14.8, 5, 3, 0));
  if (at(540)) w.trainer("(playMode PlayOn)" + ball(14.5, 4) + put("Right", 2, 14.68, 4));
  if (at(545)) w.trainer(ball(14.8, 4, 3, 0));
  if (at(590)) w.trainer("(playMode goal_kick_left)" + put("Left", 1, -12, 0));
  if (at(610)) w.trainer(ball(-12.2, 0, 3, 0));
  // a goal, and a kick-off
  if (at(660)) w.trainer("(playMode PlayOn)" + apart() + put("Left", 2, 14.0, 0) + ball(14.2, 0));
  if (at(663)) w.trainer(put("Left", 2, 10, 5) + ball(14.8, 0, 4, 0));
  if (at(700)) w.trainer("(select (unum 2)(team Left))");
  if (at(760)) w.trainer("(kickOff Left)" + put("Left", 4, -0.18, 0));
  // another goal kick, and free kicks by name
  if (at(820)) w.trainer("(playMode free_kick_right)");
  if (at(840)) w.trainer(put("Right", 1, 0.18, 0));
  if (cycle % 50 == 10) w.player(static_cast<std::size_t>(cycle / 50 % 9)).next += "(say now)";
}

// ---- robots with joints and all perceptors ----

void makeRobots(World& w) {
  w.configure("soccer.lua", {{"exactReplay", false}, {"Soccer.VisionNoise", true}});
  w.join("A", 2, "rsg/agent/nao/nao_hetero.rsg 0");
  w.join("B", 3, "rsg/agent/nao/nao_hetero.rsg 3");
  w.join("A", 4, "rsg/agent/naov4/nao.rsg");
}

void inputRobots(World& w, int cycle) {
  if (cycle == 1) w.trainer("(playMode PlayOn)" + ball(0, 0) + put("Left", 4, -3, 0, 0.4));
  // one robot is held in the air and hits its legs against each other, the others fall over
  w.trainer(put("Left", 2, -5, 0, 1));
  w.player(0).next = cycle < 70 ? "(rle2 2)(lle2 -2)" : "(rle2 -2)(lle2 2)(he1 1)";
  w.player(1).next = fmt::format("(lle3 {0})(rle3 {0})(he1 {0})(lae1 -{0})", cycle % 40 < 20 ? 2 : -1);
  w.player(2).next = fmt::format("(lle3 {0})(he1 {0})(say hi)", cycle % 30 < 20 ? 1 : -1);
}

// ---- sphere robots ----

void makeSpheres(World& w) {
  w.configure("soccer-sphere.lua", {{"/sys/server/gamecontrol.requests", true}, {"/sys/server/monitor.interval", 3}});
  for (int n = 1; n <= 3; ++n) w.join("A", n, "rsg/agent/sphere.rsg"), w.join("B", n, "rsg/agent/sphere.rsg");
}

void inputSpheres(World& w, int cycle) {
  // A granted request, whose answer is not sent for long.
  if (cycle == 3)
    setProperty(w.kernel.root().require<Leaf>("/usr/scene/AgentAspect1/_RequestAnswers"), "interval", 1000);
  // A command that waits while the state is saved.
  if (cycle == 50)
    callMethod(w.kernel.root().require<Leaf>("/sys/server/monitor"), "command", std::vector<Value>{ball(1, 1)});
  if (cycle == 5) w.player(0).next = "(request (perceptor TimePerceptor) (name clock))";
  if (cycle == 1) w.trainer("(playMode PlayOn)" + ball(0.5, 0));
  if (cycle % 50 == 18) w.trainer(put("Left", 1, 0, 0, 0.22) + "(ball (pos 0.34 0 0.111)(vel 0 0 0))");
  if (cycle % 50 == 20) w.player(0).next = "(kick 20 60)";
  if (cycle % 60 == 20) w.player(1).next = "(drive 20 -30 0)";
  if (cycle % 60 == 22) w.player(2).next = "(pantilt 20 5)(say ball)";
  if (cycle % 60 == 30) w.player(1).next = "(catch 30)";
}

// ---- a match with the class names of the SPL's configs ----

void makeSpl(World& w) {
  w.configureByText(R"lua(
    include "house.lua"
    include "materials.lua"
    include "soccer-house.lua"
    files() scene() materials() physics() simulation() agents{} monitors{}
    plugin "sensors"
    plugin "effectors"
    soccerVariables{ AutomaticKickOff = true, WaitBeforeKickOff = 0.2 }
    for _, class in ipairs { "TeamlessAspect", "SPLState", "BallStateAspect", "SPLRule" } do new(class, "/sys/server/gamecontrol/" .. class) end
    new("TrainerCommandParser", "/sys/server/monitor/TrainerCommandParser")
    get("/sys/variables/Soccer"):define("Extra", 3)
    get("/usr/scene"):importScene("rsg/soccer/field.rsg")
  )lua");
  w.join("A", 1, box(kStanding, 0));
  w.join("B", 1, box(kStanding, 1));
}

void inputSpl(World& w, int cycle) {
  if (cycle == 30) w.trainer("(playMode PlayOn)" + ball(14.8, 2, 3, 0));
}

// ---- single joints, controllers and sensors ----

Leaf& make(World& w, const std::string& type, const std::string& path) {
  return w.kernel.create(type, "/usr/scene/" + path);
}

void call(Leaf& leaf, const char* method, const List& arguments) { callMethod(leaf, method, arguments); }

void makeBox(World& w, const std::string& name, const Vec3& at) {
  call(make(w, "Transform", name), "setLocalPos", {at.x(), at.y(), at.z()});
  call(make(w, "RigidBody", name + "/body"), "setBoxTotal", {1.0, 0.3, 0.2, 0.1});
  call(make(w, "BoxCollider", name + "/shape"), "setBoxLengths", {0.3, 0.2, 0.1});
  call(make(w, "ContactJointHandler", name + "/shape/solid"), "setContactBounceMode", {false});
}

void makePieces(World& w) {
  w.configureByText(R"lua(
    include "house.lua"
    include "materials.lua"
    files() scene() materials() physics() simulation()
    for _, name in ipairs { "gamecontrol", "monitor", "sensors", "effectors", "soccer", "sounds" } do plugin(name) end
  )lua");
  call(make(w, "PlaneCollider", "ground"), "setParams", {0.0, 0.0, 1.0, 0.0});
  make(w, "ContactJointHandler", "ground/solid");
  double x = 0;
  for (const char* joint : {"BallJoint", "HingeJoint", "Hinge2Joint", "SliderJoint", "UniversalJoint", "FixedJoint"}) {
    const std::string one = std::string(joint) + "1", other = std::string(joint) + "2";
    makeBox(w, one, {x, 0, 1}), makeBox(w, other, {x + 0.4, 0, 1});
    call(make(w, joint, other + "/joint"), "attach", {"../../" + one + "/body", "../body"});
    x += 2;
  }
  makeBox(w, "carriage", {x, 0, 1});
  call(make(w, "SliderJoint", "carriage/rail"), "attach", {"../body", ""});
  make(w, "ActuatorEffector", "SliderJoint2/joint/push");
  makeBox(w, "walker", {0, 4, 0.5});
  make(w, "FPSController", "walker/body/legs");
  makeBox(w, "feeler", {2, 4, 0.5});
  make(w, "PerceptorHandler", "feeler/shape/feels"), make(w, "CollisionPerceptor", "feeler/sensor");
  makeBox(w, "toucher", {4, 4, 0.5});
  make(w, "PerceptorHandler", "toucher/shape/feels"), make(w, "TouchPerceptor", "toucher/sensor");
  makeBox(w, "stone", {2.1, 4, 1});
  make(w, "SoundHandler", "stone/shape/sound");
  make(w, "FieldFlag", "flag"), make(w, "SingleMatNode", "mark");
  w.kernel.create("StatusVariables", "/sys/variables/Status");
}

void inputPieces(World& w, int cycle) {
  const auto at = [&w](const char* path) -> Leaf& { return w.at(std::string("/usr/scene/") + path); };
  if (cycle == 5)
    for (const char* joint : {"Hinge", "Hinge2", "Slider", "Universal"})
      for (const int axis : {0, 1}) {
        if (axis == 1 && (joint == std::string("Hinge") || joint == std::string("Slider"))) continue;
        Leaf& j = at((std::string(joint) + "Joint2/joint").c_str());
        call(j, "setMaxMotorForce", {axis, 2.0 + axis});
      }
  if (cycle == 5) call(at("carriage/rail"), "setMaxMotorForce", {0, 3.0});
  if (cycle % 30 == 7) call(w.at("/sys/variables/Status"), "set", {"score", List{cycle, 1}});
  if (cycle == 10)
    setProperty(at("walker/body/legs"), "HAngle", 30.0), setProperty(at("walker/body/legs"), "forward", 0.5);
  if (cycle == 15) setProperty(at("SliderJoint2/joint/push"), "control", 0.5);
  if (cycle == 20) call(at("flag"), "setLocalPos", {1.0, 2.0, 0.0}), call(at("mark"), "setMaterial", {"matYellow"});
}

// ---- exact replay: the order of contacts is state ----

void makePiles(World& w) {
  w.configureByText(R"lua(
    include "house.lua"
    include "materials.lua"
    files() scene() materials() physics("OdeEngine", { exactReplay = true }) simulation()
  )lua");
  call(make(w, "PlaneCollider", "ground"), "setParams", {0.0, 0.0, 1.0, 0.0});
  make(w, "ContactJointHandler", "ground/solid");
  for (int i = 0; i < 24; ++i) makeBox(w, fmt::format("box{}", i), {0.1 * (i % 3), 0.07 * (i % 4), 0.3 + 0.15 * i});
}

void inputPiles(World& w, int cycle) {
  if (cycle % 40 == 20) call(w.at("/usr/scene/box3/body"), "addForce", {cycle % 80 == 20 ? 200.0 : -200.0, 0.0, 300.0});
}

void makeFallers(World& w) {
  w.configure("soccer.lua", {{"exactReplay", true}});
  for (int n = 1; n <= 3; ++n) w.join("A", n, "rsg/agent/nao/nao.rsg");
}

void inputFallers(World& w, int cycle) {
  if (cycle == 1)
    w.trainer("(playMode PlayOn)" + put("Left", 1, -3, 0, 0.4) + put("Left", 2, -2.8, 0.1, 0.9) +
              put("Left", 3, -2.9, 0, 1.4));
  w.player(static_cast<std::size_t>(cycle % 3)).next = fmt::format("(lle3 {})(he1 1)", cycle % 30 < 15 ? 2 : -2);
}

// ---- players inside the host, and scripts ----

void makeMatch(World& w) { w.configure("soccer.lua", {{"team", "Red Blue"}, {"players", 2}, {"exactReplay", false}}); }

void makeSphereMatch(World& w) { w.configure("soccer-sphere.lua", {{"team", "Red Blue"}, {"players", 3}}); }

void makeLateMatch(World& w) {
  w.configure("soccer-sphere.lua", {{"team", "Red Blue"}, {"players", 3}, {"senseLatency", 4}, {"actLatency", 3}});
  Leaf& own = w.kernel.create("AgentLatency", "/sys/server/gamecontrol/timing/second");
  setProperty(own, "agent", 2);
  setProperty(own, "senseLatency", 10);
}

void makeScripts(World& w) {
  w.configureByText(R"lua(
    include "house.lua"
    files() scene() physics() simulation() agents{}
    new("Variables", "/sys/variables/Count")
    state.falls = 0
    on("rule", function(self, event)
      state.falls = state.falls + math.random(3)
      Count.falls = state.falls
    end)
    local agent = get("/usr/scene"):new("Transform", "thing"):new("AgentAspect", "agent")
    agent:new("ScriptPerceptor", "eye"):on("perceive", function() return { falls = Count.falls } end)
    agent:new("ScriptBehavior", "mind"):on("think", function() end)
  )lua");
}

// ---- robots with imperfect sensors and effectors ----

void makeImperfect(World& w) {
  w.configureByText(R"lua(
    include "house.lua"
    files() scene() physics() simulation() agents{}
    for _, name in ipairs { "sensors", "effectors", "modifiers" } do plugin(name) end
    get("/usr/scene/world").gravity = { 0, 0, 0 }
  )lua");
  for (int n = 1; n <= 2; ++n) w.join("A", n, "rsg/agent/imperfect.rsg");
}

void inputImperfect(World& w, int cycle) {
  w.player(0).next = fmt::format("(force {} 0 1){}", cycle % 20 - 10, cycle == 5 ? "(create)" : "");
  if (cycle % 3 == 0) w.player(1).next = fmt::format("(force 0 {} 1)", cycle % 7 - 3);
}

// ---- the replay of a recorded match ----

/// The log of a short match, recorded when it is first needed.
const std::string& log() {
  static const TemporaryFolder folder;
  static const std::string file = [] {
    const std::string path = folder.file("game.log");
    World w;
    w.configure("soccer-sphere.lua", {{"monitorLog", path}});
    w.join("A", 1, "rsg/agent/sphere.rsg");
    w.trainer(ball(0, 0, 2, 1));
    w.cycles(200);
    return path;
  }();
  return file;
}

void makeReplay(World& w) { w.configure("logplayer.lua", {{"file", log()}, {"wait", false}, {"speed", 0.7}}); }
void inputReplay(World&, int) {}  // nothing comes from outside

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all{
      {"fouls", makeFouls, inputFouls, 900},
      {"robots", makeRobots, inputRobots, 150},
      {"spheres", makeSpheres, inputSpheres, 200},
      {"spl", makeSpl, inputSpl, 100},
      {"pieces", makePieces, inputPieces, 150},
      {"imperfect", makeImperfect, inputImperfect, 150},
      {"replay", makeReplay, inputReplay, 100},
      {"piles", makePiles, inputPiles, 200},
      {"fallers", makeFallers, inputFallers, 125},
      {"match", makeMatch, inputReplay, 150},
      {"sphere match", makeSphereMatch, inputReplay, 200},
      {"late match", makeLateMatch, inputReplay, 200},
      {"scripts", makeScripts, inputReplay, 50},
  };
  return all;
}

}  // namespace spark::test
