// Each model of this folder moves in Spark as in MuJoCo alone, or expected.txt says why not: those in MJCF, those in
// URDF (urdf/), which MuJoCo reads as well, and those of Webots (webots/), each beside a twin in MJCF of the same name.
//
// A model is loaded by libmujoco and by its importer, with MujocoEngine, and moves for 1 s in steps of its own length.
// All controls are 0.3, or in URDF and Webots' language, whose joints have no actuators in MuJoCo, the force of each
// joint with an effector. At 0.1, 0.5 and 1 s the coordinates of all joints, and the centres of mass and rotations of
// all bodies, must agree to 1e-6. Bodies, joints and actuators of a model need names. A reason that begins with
// "rounding: " is checked: MuJoCo alone does not agree with itself when it starts 1e-15 beside.
//
// SPARK_MODEL=path runs one other file, whatever lies around it: its bodies are compared by their order, and what has
// no name is left out otherwise. `test-models "[file]"` prints the row of that file.
//
// With the other engines, whose laws of contacts and integration are not MuJoCo's, they must agree to 5 mm and 5 mrad
// after 0.1 s, or engines.txt says why not.

#include <mujoco/mujoco.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <span>

#include "api/agents.h"
#include "api/phases.h"
#include "api/physics.h"
#include "spark/access.h"
#include "test_support.h"

namespace spark::test {
namespace {

namespace fs = std::filesystem;

/// The file to run alone; "": all of this folder.
const std::string kAlone = std::getenv("SPARK_MODEL")
                               ? fs::absolute(std::getenv("SPARK_MODEL")).lexically_normal().relative_path().string()
                               : "";
const fs::path kFolder = kAlone.empty() ? fs::path(SPARK_SOURCES "/tests/models") : fs::path("/");
constexpr double kTimes[] = {0.1, 0.5, 1};
constexpr double kTolerance = 1e-6, kControl = 0.3;

/// A name of the file as the importer writes it in the tree.
std::string treeName(std::string name) {
  for (char& c : name)
    if (std::string_view("/\\[]").find(c) != std::string_view::npos) c = '_';
  return name;
}

bool isMjcf(const std::string& file) { return file.ends_with(".xml"); }

/// What MuJoCo reads of a model.
fs::path oracleFile(const std::string& file) {
  fs::path path = kFolder / file;
  return path.extension() == ".wbt" ? path.replace_extension(".xml") : path;
}

struct BodyPose {
  Vec3 center;
  Mat3 rotation;  ///< since the start: a body whose frame the file does not give may have another one
};
/// Coordinates of joints [rad or m], counted from the pose of the file, and poses of bodies, by name.
struct Snapshot {
  std::map<std::string, double> joints;
  std::map<std::string, BodyPose> bodies;
};
using Motion = std::vector<Snapshot>;  // one for each of kTimes

void makeRelative(Snapshot& s, const Snapshot& start) {
  for (auto& [name, pose] : s.bodies) pose.rotation = pose.rotation * start.bodies.at(name).rotation.transpose();
}

/// The first step at or behind a time.
long stepAt(double time, double timestep) { return std::lround(time / timestep); }

// ---- MuJoCo ----

struct Oracle {
  mjModel* m = nullptr;
  mjData* d = nullptr;
  std::string error;
  const bool drivesJoints;

  explicit Oracle(const std::string& name) : drivesJoints(!isMjcf(name)) {
    char text[1000] = "";
    m = mj_loadXML(oracleFile(name).c_str(), nullptr, text, sizeof text);
    if (!m) error = text;
    if (m) d = mj_makeData(m);
  }
  ~Oracle() {
    if (d) mj_deleteData(d);
    if (m) mj_deleteModel(m);
  }
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  std::string nameOf(int type, int id) const {
    const char* const name = mj_id2name(m, type, id);
    if ((!name || !*name) && !kAlone.empty()) return "";
    if (!name || !*name) throw Error(fmt::format("the object {} of type {} has no name", id, mju_type2Str(type)));
    return treeName(name);
  }
  /// `beside`: how far from its place it starts, along the first coordinate.
  Motion move(double beside = 0) {
    Motion motion;
    if (beside != 0) d->qpos[0] += beside;
    mj_kinematics(m, d);
    mj_comPos(m, d);
    const Snapshot start = snapshot();
    for (int i = 0; i < m->nu; ++i) d->ctrl[i] = kControl;
    for (int j = 0; drivesJoints && j < m->njnt; ++j)
      if (m->jnt_type[j] == mjJNT_HINGE || m->jnt_type[j] == mjJNT_SLIDE) d->qfrc_applied[m->jnt_dofadr[j]] = kControl;
    long step = 0;
    for (const double time : kTimes) {
      for (; step < stepAt(time, m->opt.timestep); ++step) mj_step(m, d);
      mj_kinematics(m, d);
      mj_comPos(m, d);
      motion.push_back(snapshot());
      makeRelative(motion.back(), start);
    }
    return motion;
  }
  /// Bodies without joints are parts of those above.
  Snapshot snapshot() const {
    Snapshot s;
    for (int j = 0; j < m->njnt; ++j)
      if (m->jnt_type[j] == mjJNT_HINGE || m->jnt_type[j] == mjJNT_SLIDE)
        s.joints[nameOf(mjOBJ_JOINT, j)] += d->qpos[m->jnt_qposadr[j]] - m->qpos0[m->jnt_qposadr[j]];
    for (int b = 1; b < m->nbody; ++b) {
      if (m->body_dofnum[b] == 0) continue;
      double mass = 0;
      Vec3 center = Vec3::Zero();
      for (int k = 1; k < m->nbody; ++k) {
        if (m->body_weldid[k] != b) continue;
        mass += m->body_mass[k];
        center += m->body_mass[k] * Vec3(d->xipos + 3 * k);
      }
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(d->xmat + 9 * b);
      const std::string name = kAlone.empty() ? nameOf(mjOBJ_BODY, b) : fmt::format("#{:04}", s.bodies.size());
      s.bodies[name] = {center / mass, rotation};
    }
    s.joints.erase("");
    return s;
  }
};

// ---- Spark ----

struct ModelHost : TestHost {
  Node* scene = nullptr;

  explicit ModelHost(const std::string& file, const std::string& engine) {
    for (const char* plugin :
         {"files", "scene", "scene-mjcf", "scene-urdf", "scene-webots", "physics", "physics-mujoco", "physics-ode",
          "physics-articulated", "gamecontrol", "sensors", "effectors"})
      kernel.plugins().use(plugin);
    kernel.events().define(phase::kPrepare, Order::childrenFirst, "before the step");
    kernel.events().define(phase::kPhysics, Order::parentsFirst, "the step");
    kernel.events().define(phase::kPlace, Order::parentsFirst, "after the step");
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/models"), "path", kFolder.string());
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("MjcfImporter", "/sys/server/scene/mjcf");
    kernel.create("UrdfImporter", "/sys/server/scene/urdf");
    kernel.create("WebotsImporter", "/sys/server/scene/webots");
    kernel.create("PhysicsServer", "/sys/server/physics");
    if (engine != "MujocoEngine") kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create(engine, "/sys/server/physics/engine");
    scene = kernel.create("Scene", "/usr/scene").asNode();
    kernel.create("World", "/usr/scene/world");
    callMethod(*scene, "importScene", List{file});
  }
  /// Sends each effector its control. A controller's stiffness and damping are those of the file.
  void control(const Oracle& oracle) {
    std::vector<Effector*> effectors;
    scene->collect(effectors);
    const auto gain = [&](const std::string& name) {
      const int id = mj_name2id(oracle.m, mjOBJ_ACTUATOR, name.c_str());
      return id < 0 ? 0 : oracle.m->actuator_gainprm[mjNGAIN * id];
    };
    for (Effector* e : effectors) {
      const std::string& name = e->messageName();
      const std::string text = e->classObject()->name().ends_with("ActuatorEffector")
                                   ? fmt::format("(a {})", kControl)
                                   : fmt::format("(a {0} {0} {1} {2} {3})", radToDeg(kControl), gain(name + "_pos"),
                                                 gain(name + "_vel"), kControl);
      Predicates action;
      readSexp(text, action);
      const std::string remark = e->act(*action.begin());
      if (!remark.empty()) throw Error(name + ": " + remark);
    }
  }
  Motion move(const Oracle& oracle) {
    control(oracle);
    const double dt = oracle.m->opt.timestep;
    Motion motion;
    const Snapshot start = snapshot();
    std::int64_t step = 0;
    for (const double time : kTimes) {
      for (; step < stepAt(time, dt); ++step)
        for (const ChannelName channel : {phase::kPrepare, phase::kPhysics, phase::kPlace})
          kernel.events().channel(channel).emit(Event{channel, double(step) * dt, dt, step, nullptr});
      motion.push_back(snapshot());
      makeRelative(motion.back(), start);
    }
    return motion;
  }
  Snapshot snapshot() const {
    Snapshot s;
    std::vector<IJoint*> joints;
    std::vector<IRigidBody*> bodies;
    scene->collect(joints);
    scene->collect(bodies);
    for (IJoint* j : joints)
      if (j->axes() == 1) s.joints[j->leaf().name()] = j->angle(0);
    for (IRigidBody* b : bodies) {
      const engine::BodyState state = b->state();
      if (kAlone.empty())
        s.bodies[b->leaf().parent()->name()] = {state.position, state.rotation};
      else if (!getProperty(b->leaf(), "connector").toBool())
        s.bodies[fmt::format("#{:04}", s.bodies.size())] = {state.position, state.rotation};
    }
    return s;
  }
};

// ---- the comparison ----

/// What became of a model.
struct Result {
  bool loads = false, agrees = false;
  double worst = 0;
  std::string where;               ///< of the worst difference; or why it does not load
  std::vector<std::string> named;  ///< what the importer reported
};

void compare(const Snapshot& expected, const Snapshot& found, double time, Result& r) {
  const auto note = [&](double difference, const std::string& what) {
    if (difference <= r.worst) return;
    r.worst = difference;
    r.where = fmt::format("{} at {} s", what, time);
  };
  for (const auto& [name, q] : expected.joints) {
    const auto own = found.joints.find(name);
    if (own == found.joints.end() && !kAlone.empty()) continue;
    note(own == found.joints.end() ? HUGE_VAL : std::abs(own->second - q), "joint " + name);
  }
  if (expected.bodies.size() != found.bodies.size() && !kAlone.empty())
    note(HUGE_VAL, fmt::format("{} bodies in place of {}", found.bodies.size(), expected.bodies.size()));
  for (const auto& [name, pose] : expected.bodies) {
    const auto own = found.bodies.find(name);
    const bool none = own == found.bodies.end();
    note(none ? HUGE_VAL : (own->second.center - pose.center).cwiseAbs().maxCoeff(), "centre of " + name);
    if (!none) note((own->second.rotation - pose.rotation).cwiseAbs().maxCoeff(), "rotation of " + name);
  }
}

Result resultOf(const std::string& file, const std::string& engine, std::span<const double> times) {
  Result r;
  Oracle oracle(file);
  if (!oracle.m) throw Error(fmt::format("MuJoCo refuses {}: {}", file, oracle.error));
  // Before the plugin is loaded, whose callbacks would count here too.
  const Motion expected = oracle.move();
  try {
    ModelHost host(file, engine);
    r.loads = true;
    const Motion found = host.move(oracle);
    for (std::size_t i = 0; i < times.size(); ++i) compare(expected[i], found[i], times[i], r);
    r.agrees = r.worst <= kTolerance;
    std::istringstream lines(host.text);
    for (std::string line; std::getline(lines, line);)
      if (const std::size_t at = line.find(file + ":"); at != std::string::npos)
        r.named.push_back(line.substr(at + file.size() + 1));
      else if (line.find("MuJoCo reports") != std::string::npos)
        r.named.push_back(line);
  } catch (const Error& e) {
    r.where = e.what();
  }
  return r;
}

/// How far MuJoCo's own motion is from itself when it starts a rounding beside.
Result roundingOf(const std::string& file) {
  Result r;
  const Motion exact = Oracle(file).move(), beside = Oracle(file).move(1e-15);
  for (std::size_t i = 0; i < exact.size(); ++i) compare(exact[i], beside[i], kTimes[i], r);
  return r;
}

/// The rows of a table: file | why it does not agree.
std::map<std::string, std::string> rowsOf(const char* table) {
  std::map<std::string, std::string> rows;
  std::ifstream in(kFolder / table);
  for (std::string line; std::getline(in, line);) {
    const std::size_t bar = line.find(" | ");
    if (line.starts_with("#") || bar == std::string::npos) continue;
    rows[line.substr(0, bar)] = line.substr(bar + 3);
  }
  return rows;
}

std::vector<std::string> modelFiles() {
  std::vector<std::string> files;
  for (const auto& [folder, ending] : {std::pair{".", ".xml"}, {"urdf", ".urdf"}, {"webots", ".wbt"}})
    for (const auto& entry : fs::directory_iterator(kFolder / folder))
      if (entry.path().extension() == ending)
        files.push_back((folder / entry.path().filename()).lexically_normal().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("Models of all languages move as in MuJoCo alone, or a table says why not") {
  std::map<std::string, std::string> rows = rowsOf("expected.txt");
  std::size_t loads = 0, agrees = 0;
  const std::vector<std::string> files = modelFiles();
  for (const std::string& file : files) {
    Result r = resultOf(file, "MujocoEngine", kTimes);
    const auto row = rows.find(file);
    const std::string why = row == rows.end() ? "" : row->second;
    if (why.starts_with("rounding: ")) {
      const double own = roundingOf(file).worst;
      INFO(file << ": MuJoCo alone, started 1e-15 beside: " << own);
      CHECK(own > kTolerance);
      r.named.push_back(fmt::format("MuJoCo alone, started 1e-15 beside: {:.1e}", own));
    }
    loads += r.loads;
    agrees += r.agrees;
    fmt::print("{} | {} | {} | {:.1e}{} | {}{}\n", file, r.loads ? "loads" : "REFUSED", r.agrees ? "agrees" : "DIFFERS",
               r.worst, r.agrees || r.where.empty() ? "" : " " + r.where, fmt::join(r.named, "; "),
               why.empty() ? "" : " [" + why + "]");
    if (why.empty()) {
      INFO(file << ": " << r.worst << " " << r.where);
      CHECK((r.loads && r.agrees));
    } else if (r.agrees) {
      WARN(file << " agrees: its row in expected.txt can go");
    }
    if (row != rows.end()) rows.erase(row);
  }
  fmt::print("{} models: {} load, {} agree\n", files.size(), loads, agrees);
  for (const auto& [file, why] : rows) FAIL_CHECK("expected.txt has a row for " << file << ", which is not there");
  CHECK(files.size() >= 60);
}

TEST_CASE("Models of all languages move nearly as in MuJoCo with the other engines, or a table says why not") {
  constexpr double kNearly = 5e-3;  // after 0.1 s
  std::map<std::string, std::string> rows = rowsOf("engines.txt");
  for (const std::string& file : modelFiles()) {
    const auto row = rows.find(file);
    const std::string why = row == rows.end() ? "" : row->second;
    bool differs = false;
    for (const char* engine : {"OdeEngine", "ArticulatedEngine"}) {
      const Result r = resultOf(file, engine, std::span(kTimes).first(1));
      INFO(file << " with " << engine << ": " << r.worst << " " << r.where);
      CHECK(r.loads);
      const bool mayDiffer = !why.empty() && (!why.starts_with("ODE: ") || engine == std::string_view("OdeEngine"));
      if (!mayDiffer) CHECK(r.worst <= kNearly);
      differs |= r.worst > kNearly;
    }
    if (!why.empty() && !differs) WARN(file << " agrees: its row in engines.txt can go");
    if (row != rows.end()) rows.erase(row);
  }
  for (const auto& [file, why] : rows) FAIL_CHECK("engines.txt has a row for " << file << ", which is not there");
}

TEST_CASE("The model in SPARK_MODEL moves as in MuJoCo alone", "[.file]") {
  REQUIRE_FALSE(kAlone.empty());
  const Result r = resultOf(kAlone, "MujocoEngine", kTimes);
  fmt::print("{} | {} | {} | {:.1e} {} | {}\n", kAlone, r.loads ? "loads" : "REFUSED", r.agrees ? "agrees" : "DIFFERS",
             r.worst, r.agrees ? "" : r.where, fmt::join(r.named, "; "));
  if (!r.agrees) fmt::print("rounding {} {:.1e}\n", kAlone, roundingOf(kAlone).worst);
}

}  // namespace spark::test
