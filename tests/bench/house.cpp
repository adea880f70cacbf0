#include "house.h"

#include <filesystem>

#include "api/agents.h"
#include "heap.h"
#include "spark/error.h"
#include "spark/script_server.h"
#include "spark/state.h"

namespace spark::bench {

namespace fs = std::filesystem;

namespace {
/// Heaps of any size are solved exactly, as by raw ODE.
constexpr std::int64_t kAllRows = 1'000'000;

/// ODE's engine: the one of the physics server, or the one to which the articulated engine defers islands.
Leaf& odeEngine(Kernel& kernel) {
  Leaf* below = kernel.root().find("/sys/server/physics/engine/deferred");
  return below ? *below : kernel.root().require<Leaf>("/sys/server/physics/engine");
}

fs::path bin() { return fs::canonical("/proc/self/exe").parent_path(); }

/// A ground and 1,000 separate boxes that fall on it and never sleep, so every cycle has the same work.
constexpr const char* kBoxes = R"lua(
  include "house.lua"
  files() scene() physics() simulation()
  local top = get "/usr/scene"
  get("/usr/scene/world").autoDisableFlag = false
  local ground = top:new("PlaneCollider", "ground")
  ground:setParams(0, 0, 1, 0)
  ground:new("ContactJointHandler")
  for i = 0, 999 do
    local box = top:new("Transform", "box" .. i)
    box.localPos = { i % 32, i // 32, 0.2 + 0.01 * (i % 40) }
    box:new("RigidBody", "body"):setBoxTotal(1, 0.3, 0.3, 0.3)
    local shape = box:new("BoxCollider", "shape")
    shape:setBoxLengths(0.3, 0.3, 0.3)
    local surface = shape:new("ContactJointHandler")
    surface.contactBounceMode = false
    surface.contactSoftERPMode, surface.contactSoftERP = true, 0.2
    surface.contactSlipMode, surface.contactSlip = true, 0.005
  end
)lua";
}  // namespace

Instance::Instance(const Setup& setup, Entrance& entrance) : setup_(setup), entrance_(entrance) {
  kernel_.log().setLevel(Level::error);
  kernel_.plugins().scan(bin() / ".." / "plugins");
  build();
  setThreads(setup.threads);
  if (kernel_.root().find("/sys/server/monitor")) entrance.watch();
  admitAgents();
  run(kSettleCycles);
  if (setup.world.motion == World::Motion::heap) {
    pileUp(kernel_);
    run(kHeapCycles);
  }
  ready_ = played_;
}

Instance::~Instance() = default;

void Instance::build() {
  const fs::path share = bin() / ".." / "share" / "spark";
  ScriptServer& lua = scripts(kernel_);
  lua.addFolder(share / "lua");
  lua.run(fmt::format("host = {{ share = \"{}\", scenePaths = {{}} }}", fs::weakly_canonical(share).string()),
          "sparkbench");
  if (setup_.world.kind == World::Kind::boxes) {
    lua.run(kBoxes, "boxes");
  } else {
    for (const char* port : {"agents", "monitors"}) lua.addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
    lua.addOverride("webPort", 0);
    if (setup_.solver != "dense") lua.addOverride("solver", setup_.solver);
    if (setup_.world.kind == World::Kind::spheres) lua.addOverride("agents", setup_.world.count);
    lua.runConfig(setup_.world.kind == World::Kind::spheres ? "crowd.lua" : "soccer.lua");
  }
  simulation_ = &kernel_.root().require<Leaf>("/sys/server/simulation");
  setProperty(*simulation_, "rate", "max");
  if (setup_.world.motion == World::Motion::heap) setProperty(odeEngine(kernel_), "directRows", kAllRows);
  entrance_.open(kernel_);
}

void Instance::admitAgents() {
  const int count = setup_.world.agents();
  if (count == 0) return;
  for (int i = 0; i < count; ++i) {
    entrance_.admit(setup_.world);
    if (setup_.world.humanoid() || i + 1 == count) run(kJoinCycles);
  }
  const int seen = kernel_.root().require<IGameControl>("/sys/server/gamecontrol").agentsSeen();
  if (seen != count)
    throw Error(fmt::format("{}: expected {} agents with a robot, found {}", setup_.world.name, count, seen));
}

void Instance::run(std::int64_t cycles) {
  callMethod(*simulation_, "runCycles", std::vector<Value>{cycles});
  played_ += cycles;
}

void Instance::setThreads(int threads) { setProperty(*simulation_, "threads", threads); }

Phases Instance::phases() {
  Phases out;
  const Value means = getProperty(*simulation_, "phaseMicros");
  for (const Value& v : means.toList()) out.emplace_back(v.at(0u)->toString(), v.at(1)->toNumber());
  callMethod(*simulation_, "resetTimers", {});
  return out;
}

std::uint64_t Instance::hash() { return stateHash(kernel_.root()); }

}  // namespace spark::bench
