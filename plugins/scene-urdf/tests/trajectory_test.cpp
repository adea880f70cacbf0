// A robot of URDF moves as in MuJoCo, which reads such files too.
#include <mujoco/mujoco.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "api/phases.h"
#include "api/physics.h"
#include "robots.h"
#include "spark/access.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

constexpr double kStep = 0.002, kCycle = 0.02;

struct Oracle {
  mjModel* m = nullptr;
  mjData* d = nullptr;
  explicit Oracle(const std::string& text) {
    mjVFS files;
    mj_defaultVFS(&files);
    REQUIRE(mj_makeEmptyFileVFS(&files, "r.urdf", static_cast<int>(text.size())) == 0);
    std::memcpy(files.filedata[mj_findFileVFS(&files, "r.urdf")], text.data(), text.size());
    char error[1000] = "";
    m = mj_loadXML("r.urdf", &files, error, sizeof error);
    mj_deleteVFS(&files);
    INFO(error);
    REQUIRE(m);
    m->opt.timestep = kStep;
    // Here the links of a robot do not collide with each other.
    m->opt.disableflags |= mjDSBL_CONTACT;
    d = mj_makeData(m);
  }
  ~Oracle() {
    mj_deleteData(d);
    mj_deleteModel(m);
  }
};

struct UrdfHost : TestHost {
  TemporaryFolder folder;
  std::vector<IJoint*> joints;
  std::int64_t cycle = 0;
  explicit UrdfHost(const std::string& text) {
    for (const char* plugin : {"files", "scene", "scene-urdf", "physics", "physics-ode", "physics-mujoco"})
      kernel.plugins().use(plugin);
    kernel.events().define(phase::kPrepare, Order::childrenFirst, "before the step");
    kernel.events().define(phase::kPhysics, Order::parentsFirst, "the step");
    kernel.events().define(phase::kPlace, Order::parentsFirst, "after the step");
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("UrdfImporter", "/sys/server/scene/urdf");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("MujocoEngine", "/sys/server/physics/engine");
    Node& scene = *kernel.create("Scene", "/usr/scene").asNode();
    setProperty(kernel.create("World", "/usr/scene/world"), "timestep", kStep);
    folder.write("r.urdf", text);
    callMethod(scene, "importScene", List{"r.urdf"});
    scene.collect(joints);
  }
  void step() {
    for (const ChannelName channel : {phase::kPrepare, phase::kPhysics, phase::kPlace})
      kernel.events().channel(channel).emit(Event{channel, double(cycle) * kCycle, kCycle, cycle, nullptr});
    ++cycle;
  }
};

}  // namespace

TEST_CASE("An arm that falls moves as in MuJoCo, which reads the same file") {
  Oracle oracle(urdf::test::kArm);
  UrdfHost host(urdf::test::kArm);
  REQUIRE(host.joints.size() == static_cast<std::size_t>(oracle.m->njnt));
  double worst = 0, moved = 0;
  for (int cycle = 0; cycle < 50; ++cycle) {
    host.step();
    for (int i = 0; i < static_cast<int>(std::lround(kCycle / kStep)); ++i) mj_step(oracle.m, oracle.d);
    for (IJoint* joint : host.joints) {
      const int j = mj_name2id(oracle.m, mjOBJ_JOINT, joint->leaf().name().c_str());
      REQUIRE(j >= 0);
      const double q = oracle.d->qpos[oracle.m->jnt_qposadr[j]];
      worst = std::max(worst, std::abs(q - joint->angle(0)));
      moved = std::max(moved, std::abs(q));
    }
  }
  CHECK(moved > 0.5);
  CHECK(worst < 1e-9);
}
