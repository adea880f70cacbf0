// A robot that is imported and stepped by an engine moves as MuJoCo moves the original file.

#include <mujoco/mujoco.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <regex>
#include <thread>

#include "api/phases.h"
#include "api/physics.h"
#include "spark/access.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace spark::test {
namespace {

constexpr double kStep = 0.005, kCycle = 0.02;

/// The league's world: a plane, air, and steps of 5 ms. `content`: additional elements.
std::string worldWith(const std::string& content) {
  return R"(<mujoco model="world">
  <option timestep="0.005" density="1.2" viscosity="2e-5"/>
  <size nconmax="1500" njmax="4000"/>
  <worldbody><geom name="ground" type="plane" size="0 0 1"/></worldbody>
  )" + content +
         "\n</mujoco>";
}
std::string include(const std::string& file) { return "<include file=\"" + file + "\"/>"; }

/// The origin of each of many robots, 2 m apart.
Vec3 originOf(int robot) { return {2.0 * (robot % 6), 2.0 * (robot / 6), 0}; }
std::string prefixOf(int robot) { return "r-" + std::to_string(robot) + "-"; }

/// The target of a joint: angle and rate [rad, rad/s].
struct Target {
  double angle = 0, rate = 0;
};
/// Computes the target of a MuJoCo joint.
using Targets = Target (*)(const mjModel& m, int joint, double time);

/// MuJoCo alone, with the file's joints controlled externally.
struct Oracle {
  mjModel* m = nullptr;
  mjData* d = nullptr;
  std::vector<double> maxForce;  ///< by joint; 0 for the free joint

  /// `count` above 1: this number of robots, each with its own prefix and origin.
  explicit Oracle(const std::string& robot, int count = 1) {
    std::ifstream file(SPARK_SOURCES "/scenes/robots/" + robot);
    std::string text(std::istreambuf_iterator<char>(file), {});
    // MuJoCo 2.2.2 does not know this attribute. The actuators are removed because control() replaces them.
    const std::regex range(R"x(name="(\w+)"([^>]*) actuatorfrcrange="\S+ (\S+)")x");
    std::map<std::string, double> limits;
    for (std::sregex_iterator i(text.begin(), text.end(), range), end; i != end; ++i)
      limits[(*i)[1]] = std::stod((*i)[3]);
    text = std::regex_replace(text, range, "name=\"$1\"$2");
    const std::size_t actuators = text.find("<actuator>");
    text.erase(actuators, text.find("</actuator>") + 11 - actuators);
    mjVFS files;
    mj_defaultVFS(&files);
    std::string content = include(robot);
    if (count == 1) {
      add(files, robot, text);
    } else {
      const std::size_t head = text.find("<compiler"), tail = text.find("<sensor>"), bodies = text.find("<worldbody>");
      content = text.substr(head, bodies - head);
      for (int i = 0; i < count; ++i) {
        std::string one = text.substr(bodies, tail - bodies);
        one = std::regex_replace(one, std::regex(R"x((name|body1|body2)=")x"), "$&" + prefixOf(i));
        const std::size_t at = one.find("pos=\"0 0 ");
        one.replace(at + 5, 3, fmt::format("{} {}", originOf(i).x(), originOf(i).y()));
        content += one;
      }
    }
    add(files, "world.xml", worldWith(content));
    char error[1000] = "";
    m = mj_loadXML("world.xml", &files, error, sizeof error);
    mj_deleteVFS(&files);
    INFO(error);
    REQUIRE(m);
    d = mj_makeData(m);
    for (int j = 0; j < m->njnt; ++j) {
      const std::string name = mj_id2name(m, mjOBJ_JOINT, j);
      maxForce.push_back(limits[name.starts_with("r-") ? name.substr(name.find('-', 2) + 1) : name]);
    }
  }
  ~Oracle() {
    mj_deleteData(d);
    mj_deleteModel(m);
  }
  static void add(mjVFS& files, const std::string& name, const std::string& text) {
    REQUIRE(mj_makeEmptyFileVFS(&files, name.c_str(), static_cast<int>(text.size())) == 0);
    std::memcpy(files.filedata[mj_findFileVFS(&files, name.c_str())], text.data(), text.size());
  }
  void step(double kp, double kd, Targets targets, double time) {
    mj_step1(m, d);
    for (int j = 0; j < m->njnt; ++j) {
      if (m->jnt_type[j] != mjJNT_HINGE) continue;
      const Target t = targets(*m, j, time);
      const double torque = kp * (t.angle - d->qpos[m->jnt_qposadr[j]]) + kd * (t.rate - d->qvel[m->jnt_dofadr[j]]);
      d->qfrc_applied[m->jnt_dofadr[j]] = std::clamp(torque, -maxForce[j], maxForce[j]);
    }
    mj_step2(m, d);
  }
  /// True if two parts of the robot touch each other.
  bool touchesItself() const {
    for (int i = 0; i < d->ncon; ++i)
      if (m->geom_bodyid[d->contact[i].geom1] != 0 && m->geom_bodyid[d->contact[i].geom2] != 0) return true;
    return false;
  }
};

/// The same robot in the tree.
struct MjcfHost : TestHost {
  Node* scene = nullptr;
  std::vector<IJoint*> joints;  ///< in the order of the file
  std::int64_t cycle = 0;
  TemporaryFolder folder;

  /// Parameters as for Oracle. `engine`: class of the engine.
  explicit MjcfHost(const std::string& robot, int count = 1, const std::string& engine = "MujocoEngine") {
    for (const char* plugin :
         {"files", "scene", "scene-mjcf", "physics", "physics-ode", "physics-articulated", "physics-mujoco"})
      kernel.plugins().use(plugin);
    kernel.events().define(phase::kPrepare, Order::childrenFirst, "before the step");
    kernel.events().define(phase::kPhysics, Order::parentsFirst, "the step");
    kernel.events().define(phase::kPlace, Order::parentsFirst, "after the step");
    kernel.create("FileServer", "/sys/server/file");
    for (const std::string& path : {std::string(SPARK_SOURCES "/scenes/robots"), folder.path().string()})
      setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/" + std::to_string(path.size())), "path",
                  path);
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("MjcfImporter", "/sys/server/scene/mjcf");
    kernel.create("PhysicsServer", "/sys/server/physics");
    if (engine != "MujocoEngine") kernel.create("OdeCollision", "/sys/server/physics/collision");
    Leaf& node = kernel.create(engine, "/sys/server/physics/engine");
    if (engine == "ArticulatedEngine") node.asNode()->create("OdeEngine", "deferred");
    scene = kernel.create("Scene", "/usr/scene").asNode();
    kernel.create("World", "/usr/scene/world");
    folder.write("world.xml", worldWith(count == 1 ? include(robot) : ""));
    callMethod(*scene, "importScene", List{"world.xml"});
    for (int i = 0; count > 1 && i < count; ++i) {
      Node& parent = *scene->create("Transform").asNode();
      callMethod(parent, "setLocalPos", List{originOf(i).x(), originOf(i).y(), 0.0});
      callMethod(parent, "importScene", List{robot, prefixOf(i)});
    }
    scene->collect(joints);
  }
  void step() {
    for (const ChannelName channel : {phase::kPrepare, phase::kPhysics, phase::kPlace})
      kernel.events().channel(channel).emit(Event{channel, double(cycle) * kCycle, kCycle, cycle, nullptr});
    ++cycle;
  }
};

Vec3 vectorOf(const Value& v) {
  const List& list = v.toList();
  return {list[0].toNumber(), list[1].toNumber(), list[2].toNumber()};
}

/// The largest difference of joint angles [rad] and of body positions [m] over all cycles, until `seconds` are over or
/// the robot touches itself. `reached`: the time until then [s].
double distance(const std::string& robot, double kp, double kd, Targets targets, double seconds, double& reached) {
  Oracle oracle(robot);
  MjcfHost host(robot);
  std::map<std::string, IJoint*> byName;
  for (IJoint* j : host.joints) byName[j->leaf().name()] = j;
  REQUIRE(byName.size() == static_cast<std::size_t>(oracle.m->njnt - 1));
  double worst = 0;
  for (int cycle = 0; cycle * kCycle < seconds - 1e-9; ++cycle) {
    const double time = cycle * kCycle;
    for (int j = 1; j < oracle.m->njnt; ++j) {
      const Target t = targets(*oracle.m, j, time);
      IJoint& joint = *byName.at(mj_id2name(oracle.m, mjOBJ_JOINT, j));
      joint.control(
          0, {.stiffness = kp, .damping = kd, .position = t.angle, .velocity = t.rate, .maxForce = oracle.maxForce[j]});
    }
    for (int i = 0; i < 4; ++i) oracle.step(kp, kd, targets, time);
    host.step();
    mj_kinematics(oracle.m, oracle.d);
    if (oracle.touchesItself()) break;
    reached = time + kCycle;
    for (int j = 1; j < oracle.m->njnt; ++j) {
      IJoint& joint = *byName.at(mj_id2name(oracle.m, mjOBJ_JOINT, j));
      worst = std::max(worst, std::abs(joint.angle(0) - oracle.d->qpos[oracle.m->jnt_qposadr[j]]));
      const engine::BodyState s = joint.body(0)->state();
      const int body = oracle.m->jnt_bodyid[j];
      const Leaf& leaf = joint.body(0)->leaf();
      const Vec3 link = s.position + s.rotation * vectorOf(getProperty(leaf, "linkOrigin"));
      worst = std::max(worst, (link - Vec3(oracle.d->xpos + 3 * body)).cwiseAbs().maxCoeff());
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(oracle.d->xmat + 9 * body);
      worst = std::max(worst, (s.rotation - r).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

}  // namespace

namespace {

/// Straight, but a little away from the stops: at a stop, rounding errors decide whether it is active.
Target straight(const mjModel& m, int joint, double) {
  const double* const range = m.jnt_range + 2 * joint;
  return {std::clamp(0.0, range[0] + 0.02, range[1] - 0.02), 0};
}

/// All joints swing, each with its own frequency.
Target swinging(const mjModel&, int joint, double t) {
  const double w = 2 * 3.14159265358979 * (0.5 + 0.07 * joint);
  return {0.12 * std::sin(w * t + 0.4 * joint), 0};
}

}  // namespace

TEST_CASE("A standing T1 moves as in MuJoCo alone") {
  double reached = 0;
  const double worst = distance("t1.xml", 200, 5, straight, 2, reached);
  WARN("2 s standing: largest difference " << worst << " m or rad");
  CHECK(reached == Approx(2));
  CHECK(worst < 1e-9);
}

TEST_CASE("A T1 that swings all joints moves as in MuJoCo alone") {
  double reached = 0;
  const double worst = distance("t1.xml", 100, 3, swinging, 1, reached);
  WARN("1 s moving: largest difference " << worst << " m or rad, without self-contact until " << reached << " s");
  CHECK(reached == Approx(1));
  CHECK(worst < 1e-9);
}

namespace {

/// The cost of many robots that swing all joints in an engine, and in MuJoCo alone in the same run.
struct Cost {
  double plain = 0, own = 0;  ///< CPU time of a cycle (4 steps of 5 ms) in MuJoCo alone and in the engine [us]
  double first = 0;           ///< CPU time of the first cycle [ms], in which the model is compiled
  double join = 0;            ///< wall time of the longest cycle while a robot joins, including the import [ms]
  double distance = 0;        ///< largest difference of a joint angle at the end [rad]
};

double cpuTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

Cost costOf(const std::string& engine, int robots) {
  constexpr int kCycles = 60, kJoints = 24;  // 1.2 s; joints per robot
  const auto targets = [](const mjModel& m, int joint, double t) { return swinging(m, joint % kJoints, t); };
  Oracle oracle("t1.xml", robots);
  MjcfHost host("t1.xml", robots, engine);
  std::map<std::string, IJoint*> byName;
  for (IJoint* j : host.joints) byName[j->leaf().name()] = j;
  std::vector<std::pair<int, IJoint*>> joints;
  for (int j = 0; j < oracle.m->njnt; ++j)
    if (oracle.m->jnt_type[j] == mjJNT_HINGE) joints.emplace_back(j, byName.at(mj_id2name(oracle.m, mjOBJ_JOINT, j)));

  Cost cost;
  std::vector<double> plain, own;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const double time = cycle * kCycle;
    for (const auto& [j, joint] : joints) {
      const Target t = targets(*oracle.m, j, time);
      joint->control(
          0, {.stiffness = 100, .damping = 3, .position = t.angle, .velocity = t.rate, .maxForce = oracle.maxForce[j]});
    }
    const double start = cpuTime();
    for (int i = 0; i < 4; ++i) oracle.step(100, 3, targets, time);
    const double between = cpuTime();
    host.step();
    const double end = cpuTime();
    if (cycle == 0) cost.first = 1e-3 * (end - between);
    if (cycle < 10) continue;
    plain.push_back(between - start);
    own.push_back(end - between);
  }
  for (const auto& [j, joint] : joints)
    cost.distance = std::max(cost.distance, std::abs(joint->angle(0) - oracle.d->qpos[oracle.m->jnt_qposadr[j]]));
  using Clock = std::chrono::steady_clock;
  const auto longest = [&](auto work) {
    const auto start = Clock::now();
    work();
    cost.join = std::max(cost.join, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    std::this_thread::sleep_until(start + std::chrono::milliseconds(20));  // real time
  };
  Node& parent = *host.scene->create("Transform").asNode();
  callMethod(parent, "setLocalPos", List{-3.0, 0.0, 0.0});
  longest([&] {
    callMethod(parent, "importScene", List{"t1.xml", "late-"});
    host.step();
  });
  for (int i = 0; i < 60; ++i) longest([&] { host.step(); });
  cost.plain = median(plain);
  cost.own = median(own);
  return cost;
}

}  // namespace

// For tools/accept engines, which compares the joint angles at the end with a current MuJoCo (second_oracle.mjs).
TEST_CASE("Prints the joint angles of a T1 that stood and of one that moved", "[.angles]") {
  for (const bool standing : {true, false}) {
    Oracle limits("t1.xml");  // only for ranges and torque limits
    MjcfHost host("t1.xml");
    std::map<std::string, IJoint*> byName;
    for (IJoint* j : host.joints) byName[j->leaf().name()] = j;
    for (int cycle = 0; cycle < (standing ? 100 : 50); ++cycle) {
      for (int j = 1; j < limits.m->njnt; ++j) {
        const Target t = standing ? straight(*limits.m, j, 0) : swinging(*limits.m, j, cycle * kCycle);
        byName.at(mj_id2name(limits.m, mjOBJ_JOINT, j))
            ->control(0, {.stiffness = standing ? 200.0 : 100.0,
                          .damping = standing ? 5.0 : 3.0,
                          .position = t.angle,
                          .velocity = t.rate,
                          .maxForce = limits.maxForce[j]});
      }
      host.step();
    }
    std::string angles;
    for (const auto& [name, joint] : byName)
      angles += fmt::format("{}\"{}\": {:.17g}", angles.empty() ? "" : ", ", name, joint->angle(0));
    fmt::print("{{\"motion\": \"{}\", \"angles\": {{{}}}}}\n", standing ? "standing" : "moving", angles);
  }
}

// For tools/accept engines: prints a line of JSON.
TEST_CASE("Prints the longest cycle in real time while a T1 joins 22", "[.join]") {
  MjcfHost host("t1.xml", 22);
  host.kernel.plugins().use("simulation");
  setProperty(host.kernel.create("Simulation", "/sys/server/simulation"), "rate", "real");
  for (IJoint* j : host.joints)
    j->control(0, {.stiffness = 100, .damping = 3, .position = 0, .velocity = 0, .maxForce = 100});
  using Clock = std::chrono::steady_clock;
  auto next = Clock::now();
  const auto cycle = [&](auto work) {
    const auto start = Clock::now();
    work();
    const double took = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    next = std::max(next + std::chrono::milliseconds(20), Clock::now());
    std::this_thread::sleep_until(next);
    return took;
  };
  std::vector<double> usual;
  for (int i = 0; i < 100; ++i) usual.push_back(cycle([&] { host.step(); }));
  const Leaf& engine = host.kernel.root().require<Leaf>("/sys/server/physics/engine");
  const auto compiled = [&] { return getProperty(engine, "compilations").toInteger(); };
  const std::int64_t before = compiled();
  Node& parent = *host.scene->create("Transform").asNode();
  callMethod(parent, "setLocalPos", List{-3.0, 0.0, 0.0});
  const double import = cycle([&] {
    callMethod(parent, "importScene", List{"t1.xml", "late-"});
    host.step();
  });
  double waiting = 0, taking = 0;
  int cycles = 1;
  for (; compiled() == before && cycles < 3000; ++cycles) {
    waiting = std::max(waiting, taking);
    taking = cycle([&] { host.step(); });
  }
  for (int i = 0; i < 20; ++i) taking = std::max(taking, cycle([&] { host.step(); }));
  fmt::print(
      "{{\"cycle_ms\": {:.1f}, \"import_ms\": {:.1f}, \"waiting_ms\": {:.1f}, \"taking_ms\": {:.1f}, \"join_ms\": "
      "{:.1f}, "
      "\"cycles\": {}}}\n",
      median(usual), import, waiting, taking, std::max({import, waiting, taking}), cycles);
}

// For tools/accept engines: prints a line of JSON for each engine and number of robots.
TEST_CASE("Prints the cost of many T1 in each engine and in MuJoCo alone", "[.cost]") {
  for (const std::string engine : {"MujocoEngine", "ArticulatedEngine"})
    for (const int robots : {1, 14, 22}) {
      const Cost c = costOf(engine, robots);
      fmt::print(
          "{{\"engine\": \"{}\", \"robots\": {}, \"mj_step\": {:.1f}, \"cost\": {:.1f}, \"ratio\": {:.3f}, "
          "\"first_ms\": {:.0f}, "
          "\"join_ms\": {:.1f}, \"distance\": {:.2g}}}\n",
          engine, robots, c.plain, c.own, c.own / c.plain, c.first, c.join, c.distance);
    }
}

TEST_CASE("K1 and PiPlus move as in MuJoCo alone") {
  // The camera of PiPlus is part of its head here, so the air drag differs.
  for (const auto& [robot, limit] : {std::pair{"k1.xml", 1e-9}, std::pair{"piplus.xml", 1e-6}}) {
    double reached = 0;
    const double worst = distance(robot, 100, 3, straight, 0.2, reached);
    WARN(robot << ": largest difference " << worst << " m or rad in " << reached << " s");
    CHECK(reached == Approx(0.2));
    CHECK(worst < limit);
  }
}

}  // namespace spark::test
