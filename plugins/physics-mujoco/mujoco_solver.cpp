#include "mujoco_solver.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iterator>

#include "api/physics.h"
#include "mjcf_constraints.h"
#include "mujoco_engine.h"

namespace spark::mujoco {

namespace {

/// Steps until a model that is compiled aside takes over, where equal runs must give equal results. Like the compiler's
/// time, the number grows with the square of the bodies; it depends on the world alone.
int stepsToCompile(std::size_t bodies) {
  constexpr std::size_t kBodySquaresPerStep = 1400;
  return 1 + static_cast<int>(bodies * bodies / kBodySquaresPerStep);
}

/// Compiles in a thread of its own, from copies that end there. In real time it has the lowest priority, so that it
/// does not slow the simulation.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
Compiled compileAside(engine::Model model, Trees trees, double step, Sizes sizes, MeshPieces pieces, bool paced) {
  if (paced) ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 19);
  return compileWorld(toMjcf(model, trees, step, sizes, Constraints(model, trees), pieces), true);
}

/// Steps for which a world that changes again and again may wait for its model.
constexpr int kLongestWait = 400;

/// Room for what touches usually: memory grows with the square of the rows, so it is doubled where it does not suffice.
Sizes sizesFor(const engine::Model& model) {
  // Bodies without joints lie on each other with all corners; robots stand on their feet.
  const auto joined =
      std::count_if(model.bodies.begin(), model.bodies.end(), [](const auto& b) { return b.joints > 0; });
  const int jointed = static_cast<int>(joined), single = static_cast<int>(model.bodies.size()) - jointed;
  return {50 + 12 * single + jointed, 200 + 50 * single + 5 * jointed};
}

std::vector<Pose> posesOf(const engine::State& state) {
  std::vector<Pose> out;
  out.reserve(state.bodies.size());
  for (const engine::DynamicState& s : state.bodies) out.push_back({s.position, s.rotation});
  return out;
}

bool isSame(const Pose& a, const Pose& b) { return a.position == b.position && a.rotation == b.rotation; }

/// The path of the node below `node` whose block has that number.
std::string pathOfConstraint(const Node& node, int number) {
  for (const auto& child : node.children()) {
    if (constraintNumber(*child) == number) return child->path();
    if (const Node* const inner = child->asNode())
      if (std::string found = pathOfConstraint(*inner, number); !found.empty()) return found;
  }
  return "";
}

/// The path of the body or collider that has the id `identity` in its world; "" if there is none.
template <class T>
std::string pathOf(Node& root, std::uint64_t identity) {
  std::vector<T*> all;
  root.collect(all);
  for (T* object : all)
    if (object->identity() == identity) return object->leaf().path();
  return "";
}

/// The path of the node of which a text of MuJoCo's compiler speaks, which knows bodies as b0, geoms as g0 and meshes
/// as m0 (mjcf.h); "" if it speaks of none.
std::string nodeIn(const std::string& text, const engine::Model& model, Node& root) {
  constexpr std::string_view kBefore = "Object name = ";
  const std::size_t at = text.find(kBefore);
  if (at == std::string::npos) return "";
  const char* const name = text.c_str() + at + kBefore.size();
  engine::Index index = 0;
  if (std::from_chars(name + 1, text.c_str() + text.size(), index).ec != std::errc()) return "";
  if (*name == 'b') return index < model.bodies.size() ? pathOf<IRigidBody>(root, model.bodies[index].id) : "";
  return index < model.geoms.size() ? pathOf<ICollider>(root, model.geoms[index].id) : "";
}

}  // namespace

void MujocoSolver::compile(const engine::Model& model, const engine::State& state) {
  const Sizes least = sizesFor(model);
  sizes_ = {std::max(least.contacts, sizes_.contacts), std::max(least.rows, sizes_.rows)};
  poses_.clear();
  takeMeshes(model);
  if (world_ && static_cast<int>(model.bodies.size()) > engine_.atOnce_ && pending_.waited < kLongestWait)
    buildAside(model, state);
  else
    build(model, state);
}

void MujocoSolver::takeMeshes(const engine::Model& model) {
  pieces_.update(model);
  struct Kind {
    const engine::Geom* first = nullptr;
    int count = 0;
    void add(const engine::Geom& g) {
      if (count++ == 0) first = &g;
    }
  } flat, hulls;
  const std::uint64_t before = newestGeom_;
  for (const engine::Geom& g : model.geoms) newestGeom_ = std::max(newestGeom_, g.id);
  for (const engine::Geom& g : model.geoms) {
    if (g.shape.shape != engine::Shape::mesh || g.id <= before) continue;
    const MeshPieces::Entry& made = pieces_.of(g);
    const bool hasPieces = g.body == kNone && !made.pieces.empty();
    if (!hasPieces && !made.isSolid) flat.add(g);
    if (g.body == engine::kNone && !hasPieces && made.isSolid) hulls.add(g);
  }
  const auto say = [&](const Kind& kind, const char* what) {
    if (kind.count == 0) return;
    const std::string others = kind.count > 1 ? fmt::format(" (and {} more)", kind.count - 1) : "";
    engine_.kernel().log().warning("{}{}: a mesh of {} triangles {}",
                                   pathOf<ICollider>(engine_.kernel().root(), kind.first->id), others,
                                   kind.first->shape.mesh->triangles.size() / 3, what);
  };
  say(flat, "is flat, and on a body does not collide in MuJoCo");
  say(hulls,
      "that does not move has too many convex pieces: it collides as its convex hull, its hollows are filled. Take a "
      "HeightFieldCollider, or ConvexColliders");
}

void MujocoSolver::build(const engine::Model& model, const engine::State& state) {
  abandon();
  const std::unique_ptr<MujocoWorld> before = std::move(world_);
  Trees trees(model, state);
  const Constraints constraints(model, trees);
  reportSkipped(constraints);
  Written text = toMjcf(model, trees, step_, sizes_, constraints, pieces_);
  try {
    begin(model, std::move(trees), compileWorld(std::move(text)));
    if (before) world_->takeActivations(*before);
    poses_ = posesOf(state);
  } catch (const Error& e) {
    refuse(e.what(), &model);
  }
}

void MujocoSolver::reportSkipped(const Constraints& constraints) {
  const std::vector<int> before = std::exchange(skipped_, constraints.skipped());
  for (const int number : skipped_)
    if (std::find(before.begin(), before.end(), number) == before.end())
      engine_.kernel().log().warning(
          "{}: no effect in MuJoCo: expected bodies that are there, or joints with one coordinate, and no element "
          "twice",
          pathOfConstraint(engine_.kernel().root(), number));
}

void MujocoSolver::reportRaised(std::vector<std::uint64_t> bodies) {
  std::sort(bodies.begin(), bodies.end());
  std::vector<std::uint64_t> all, added;
  std::set_difference(bodies.begin(), bodies.end(), raised_.begin(), raised_.end(), std::back_inserter(added));
  std::set_union(bodies.begin(), bodies.end(), raised_.begin(), raised_.end(), std::back_inserter(all));
  raised_ = std::move(all);
  if (added.empty()) return;
  engine_.kernel().log().warning(
      "{}{}: its mass [kg] or moments of inertia [kg m^2] are taken as 2e-15: expected more than 1e-15, MuJoCo takes "
      "no less of a body that moves",
      pathOf<IRigidBody>(engine_.kernel().root(), added.front()),
      added.size() > 1 ? fmt::format(" (and {} more)", added.size() - 1) : "");
}

void MujocoSolver::reportStiff(const engine::Model& model) {
  if (saidStiff_ || world_->stiffJoint() == engine::kNone) return;
  saidStiff_ = true;
  engine_.kernel().log().warning(
      "{}: its spring or controller is too stiff for MuJoCo's own step of {} s, in which it would run away: it acts "
      "implicitly, and so do others",
      pathOf<IJoint>(engine_.kernel().root(), model.joints[world_->stiffJoint()].id), step_);
}

void MujocoSolver::begin(const engine::Model& model, Trees trees, Compiled compiled) {
  reportRaised(compiled.raised);
  // The system takes back the memory of a large world in milliseconds: in another thread.
  auto world = std::make_unique<MujocoWorld>(model, std::move(trees), std::move(compiled), pieces_);
  if (world_) world->takeActivations(*world_);
  if (world_) ending_ = std::async(std::launch::async, [old = std::move(world_)]() mutable { old.reset(); });
  world_ = std::move(world);
  world_->setFilter(filter_);
  ++engine_.compilations_;
}

void MujocoSolver::buildAside(const engine::Model& model, const engine::State& state) {
  world_->bind(model);
  const int waited = pending_.waited;
  abandon();
  Pending& p = pending_;
  p.waited = waited;
  p.number = static_cast<std::uint64_t>(++engine_.compiledAside_);
  p.stepsLeft = stepsToCompile(model.bodies.size());
  p.trees.emplace(model, state);
  p.poses = posesOf(state);
  reportSkipped(Constraints(model, *p.trees));
  p.compiled = std::async(std::launch::async, compileAside, model, *p.trees, step_, sizes_, pieces_, engine_.isPaced());
}

void MujocoSolver::abandon() {
  std::erase_if(abandoned_,
                [](const auto& f) { return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (pending_.compiled.valid()) abandoned_.push_back(std::move(pending_.compiled));
  pending_ = {};
}

void MujocoSolver::takePending(const engine::Model& model) {
  Pending& p = pending_;
  if (!p.compiled.valid()) return;
  ++p.waited;
  --p.stepsLeft;
  const bool ready = p.compiled.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  // In real time the model takes over as soon as it is ready, which is an input. Otherwise it takes over after a fixed
  // number of steps, so that equal runs give equal results, and the simulation may have to wait for it here.
  const bool paced = engine_.isPaced();
  const bool taken = paced && engine_.tape_ ? engine_.tape_->decide("compiled", p.number, ready, false) : ready;
  if (paced ? !taken : p.stepsLeft > 0) return;
  if (!ready)
    engine_.kernel().log().info("{}: waits for MuJoCo's compiler, {} steps after the world changed", engine_.path(),
                                p.waited);
  try {
    begin(model, std::move(*p.trees), p.compiled.get());
    poses_ = std::move(p.poses);
  } catch (const Error& e) {
    refuse(e.what(), &model);
  }
  p = {};
}

/// The log says so once; nothing moves until the model is another one. `model`: that of which `why` speaks.
void MujocoSolver::refuse(const std::string& why, const engine::Model* model) {
  world_.reset();
  if (std::exchange(refused_, why) == why) return;
  const std::string node = model ? nodeIn(why, *model, engine_.kernel().root()) : std::string();
  engine_.kernel().log().error("{}: MuJoCo does not take this world, so nothing in it moves: {}{}{}", engine_.path(),
                               node, node.empty() ? "" : ": ", why);
}

void MujocoSolver::detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter,
                          int perPair, engine::Contacts& out) {
  filter_ = filter;
  if (!world_) return;
  try {
    world_->detect(model, state, filter, perPair, out);
  } catch (const Error& e) {
    refuse(e.what());
  }
}

void MujocoSolver::step(engine::Step& step) {
  if (world_ && step_ != step.dt) {
    step_ = step.dt;
    build(step.model, step.state);
  }
  if (!world_) {
    for (engine::DynamicState& s : step.state.bodies) s.force.setZero(), s.torque.setZero();
    return;
  }
  try {
    world_->step(step);
  } catch (const Error& e) {
    return refuse(e.what());
  }
  if (const std::string message = world_->takeMessage(); !message.empty()) engine_.report(message);
  reportStiff(step.model);
  takePending(step.model);
  if (!world_ || full_ || !world_->isFull()) return;
  const Sizes old = sizes_;
  engine_.kernel().log().info("{}: MuJoCo's room of {} contacts and {} rows was too small; it is doubled",
                              engine_.path(), old.contacts, old.rows);
  sizes_ = {2 * old.contacts, 2 * old.rows};
  build(step.model, step.state);
  if (world_) return;
  // There is no more room: on with the old one.
  full_ = true;
  sizes_ = old;
  build(step.model, step.state);
}

// ---- snapshots ----
//
// MuJoCo's coordinates of free bodies and ball joints count from the poses with which the world was compiled, so equal
// numbers need a world that is compiled with the same.

void MujocoSolver::save(const engine::State& state, StateWriter& out) const {
  const bool whole = world_ && poses_.size() == state.bodies.size();
  out.write(whole);
  if (!whole) return;
  world_->save(state, out);
  if (!out.keeps()) return;
  StateWriter compiled(true);
  for (const Pose& p : poses_) {
    for (int i = 0; i < 3; ++i) compiled.write(p.position[i]);
    for (int i = 0; i < 9; ++i) compiled.write(p.rotation.data()[i]);
  }
  compiled.write(sizes_.contacts);
  compiled.write(sizes_.rows);
  compiled.write(step_);
  compiled.write(full_);
  out.aside(compiled.bytes());
}

void MujocoSolver::load(const engine::Model& model, const engine::State& state, StateReader& in) {
  if (!in.readBool()) return;
  const MujocoWorld::Saved numbers(in);
  const std::string bytes = in.readString();
  StateReader compiled(bytes);
  engine::State then;
  then.bodies.resize(model.bodies.size());
  for (engine::DynamicState& s : then.bodies) {
    for (int i = 0; i < 3; ++i) s.position[i] = compiled.readNumber();
    for (int i = 0; i < 9; ++i) s.rotation.data()[i] = compiled.readNumber();
  }
  Sizes sizes;
  sizes.contacts = static_cast<int>(compiled.readInteger());
  sizes.rows = static_cast<int>(compiled.readInteger());
  const double step = compiled.readNumber();
  full_ = compiled.readBool();
  const std::vector<Pose> poses = posesOf(then);
  const bool same = world_ && std::equal(poses_.begin(), poses_.end(), poses.begin(), poses.end(), isSame) &&
                    sizes_.contacts == sizes.contacts && sizes_.rows == sizes.rows && step_ == step;
  if (!same) {
    sizes_ = sizes;
    step_ = step;
    build(model, then);
  }
  if (world_) world_->resume(numbers, state);
}

}  // namespace spark::mujoco
