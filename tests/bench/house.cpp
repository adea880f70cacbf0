#include "house.h"

#include <fmt/format.h>

#include <cstdlib>

#include "api/physics.h"
#include "spark/error.h"

namespace spark::bench {

namespace fs = std::filesystem;

namespace {
fs::path bin() { return fs::canonical("/proc/self/exe").parent_path(); }

/// A ground and 1,000 boxes that fall on it, each for itself, and never sleep: every cycle has the same work.
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

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"empty", "empty field", 0, false, false, 2000},
      {"spheres", "22 sphere agents, driving", 22, true, false, 1000},
      {"boxes", "1,000 boxes", 0, true, false, 200},
      {"standing", "22 humanoids, standing", 22, false, true, 200},
      {"moving", "22 humanoids, moving", 22, true, true, 200},
  };
  return all;
}

fs::path referenceScenes() {
  const char* dir = std::getenv("SPARK_REFERENCE_DIR");
  if (!dir || !*dir) return {};
  const fs::path scenes = fs::path(dir) / "scenes-reference";
  return fs::exists(scenes / "rsg/agent/nao/nao.rsg") ? scenes : fs::path();
}

House::House(const Case& c) : case_(c) {
  kernel_.log().setLevel(Level::error);
  kernel_.plugins().scan(bin() / ".." / "plugins");
  build();
  settle();
}

void House::build() {
  const fs::path share = bin() / ".." / "share" / "spark";
  kernel_.lua().addFolder(share / "lua");
  const std::string paths = case_.needsReference ? "\"" + referenceScenes().string() + "\"" : "";
  kernel_.lua().run(fmt::format("host = {{ share = \"{}\", scenePaths = {{ {} }} }}", fs::weakly_canonical(share).string(), paths), "bench");
  if (case_.name == "boxes") kernel_.lua().run(kBoxes, "boxes");
  else runSoccer();
  simulation_ = &kernel_.root().require<Leaf>("/sys/server/simulation");
  setProperty(*simulation_, "rate", "max");
}

/// One after another: robots appear at one place, and several in one place are a knot for the solver.
void House::addAgents() {
  kernel_.registerClass<BenchBrain>();
  if (!kernel_.root().find("/usr/agent")) kernel_.create("Node", "/usr/agent");
  const double scale = case_.needsReference ? 1 : 4;
  for (int i = 0; i < case_.agents; ++i) {
    auto made = kernel_.classOf("BenchBrain").create();
    auto& brain = static_cast<BenchBrain&>(*made);
    brain.setName(fmt::format("brain{}", i));
    brain.index = static_cast<std::size_t>(i);
    brain.type = case_.needsReference ? i % 4 : -1;  // a team may have only so many of one type
    brain.scene = case_.needsReference ? "rsg/agent/nao/nao_hetero.rsg" : "rsg/agent/sphere.rsg";
    const int column = i % 11 % 4, row = i % 11 / 4;
    brain.place[0] = -scale * (2 + 2.4 * column);
    brain.place[1] = scale * (4 * (row - 1) + 0.3 * column);
    brains_.push_back(&brain);
    kernel_.root().require<Node>("/usr/agent").add(std::move(made));
    run(8);
  }
}

void House::runSoccer() {
  for (const char* port : {"agents", "monitors"}) kernel_.lua().addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
  kernel_.lua().runConfig(case_.needsReference ? "soccer.lua" : "soccer-sphere.lua");
}

/// Robots load, get their numbers, go to their places and come to rest; then those that are to move begin.
void House::settle() {
  if (case_.agents > 0) addAgents();
  run(50);
  if (!case_.moving || case_.agents == 0) return;
  const auto& agents = kernel_.root().require<IGameControl>("/sys/server/gamecontrol").agents();
  if (agents.size() != brains_.size()) throw Error(fmt::format("expected {} agents, found {}", brains_.size(), agents.size()));
  for (std::size_t i = 0; i < agents.size(); ++i) {
    if (!case_.needsReference) {
      brains_[i]->drives = true;
      continue;
    }
    std::vector<Effector*> effectors;
    agents[i]->collect(effectors);
    for (Effector* e : effectors)
      if (e->parent()->as<IJoint>()) brains_[i]->motors.push_back(e->predicate());
    if (brains_[i]->motors.empty()) throw Error(agents[i]->path() + " has no motors");
  }
}

void House::run(std::int64_t cycles) { callMethod(*simulation_, "runCycles", std::vector<Value>{cycles}); }

std::vector<std::pair<std::string, double>> House::phases() {
  std::vector<std::pair<std::string, double>> out;
  const Value means = getProperty(*simulation_, "phaseMicros");
  for (const Value& v : means.toList()) out.emplace_back(v.at(0u)->toString(), v.at(1)->toNumber());
  callMethod(*simulation_, "resetTimers", {});
  return out;
}

}  // namespace spark::bench
