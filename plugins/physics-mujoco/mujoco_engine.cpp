#include "mujoco_engine.h"

#include <algorithm>
#include <chrono>

#include "spark/plugin.h"

namespace spark {

using mujoco::MujocoWorld;

namespace {

/// Steps until a model that is compiled aside takes over. Compiling takes time with the square of the bodies (0.5 s for
/// 530 of them on a machine of 2026); steps of 5 ms in real time leave it twice as long.
int stepsToCompile(std::size_t bodies) {
  constexpr std::size_t kBodySquaresPerStep = 1400;
  return 1 + static_cast<int>(bodies * bodies / kBodySquaresPerStep);
}
/// Steps for which a world that changes again and again may wait for its model.
constexpr int kLongestWait = 400;

/// Room for what touches usually: memory grows with the square of the rows, so it is doubled where it does not suffice.
mujoco::Sizes sizesFor(const engine::Model& model) {
  // Bodies without joints lie on each other with all corners; robots stand on their feet.
  const auto joined =
      std::count_if(model.bodies.begin(), model.bodies.end(), [](const auto& b) { return b.joints > 0; });
  const int jointed = static_cast<int>(joined), single = static_cast<int>(model.bodies.size()) - jointed;
  return {50 + 12 * single + jointed, 200 + 50 * single + 5 * jointed};
}

}  // namespace

MujocoEngine::Known& MujocoEngine::of(const engine::Model& model) {
  for (Known& known : worlds_)
    if (known.id == model.id) return known;
  worlds_.emplace_back().id = model.id;
  return worlds_.back();
}

void MujocoEngine::forget(const engine::Model& model) {
  abandon(of(model));
  std::erase_if(worlds_, [&](const Known& known) { return known.id == model.id; });
}

void MujocoEngine::compile(const engine::Model& model, const engine::State& state) {
  Known& known = of(model);
  // Collision detection and dynamics are one here: each asks once.
  if (known.structure == model.structure && known.collision == model.collision && known.dynamics == model.dynamics)
    return;
  known.structure = model.structure;
  known.collision = model.collision;
  known.dynamics = model.dynamics;
  const mujoco::Sizes least = sizesFor(model);
  known.sizes = {std::max(least.contacts, known.sizes.contacts), std::max(least.rows, known.sizes.rows)};
  if (known.world && static_cast<int>(model.bodies.size()) > atOnce_ && known.pending.waited < kLongestWait)
    buildAside(known, model, state);
  else
    build(known, model, state);
}

void MujocoEngine::build(Known& known, const engine::Model& model, const engine::State& state) {
  abandon(known);
  known.world.reset();
  mujoco::Trees trees(model, state);
  const std::string text = mujoco::toMjcf(model, trees, known.step, known.sizes);
  try {
    begin(known, model, state, std::move(trees), mujoco::compileWorld(text));
  } catch (const Error& e) {
    refuse(known, e.what());
  }
}

void MujocoEngine::begin(Known& known, const engine::Model& model, const engine::State& state, mujoco::Trees trees,
                         mujoco::Compiled compiled) {
  if (!trees.leftOver.empty() && !std::exchange(warned_, true))
    kernel().log().warning(
        "{}: {} joints have no effect in MuJoCo: those that close a loop of bodies, and angular motors", path(),
        trees.leftOver.size());
  known.world = std::make_unique<MujocoWorld>(model, state, std::move(trees), std::move(compiled));
  known.world->setFilter(known.filter);
  ++compilations_;
}

void MujocoEngine::buildAside(Known& known, const engine::Model& model, const engine::State& state) {
  known.world->bind(model);
  const int waited = known.pending.waited;
  abandon(known);
  Pending& p = known.pending;
  p.waited = waited;
  p.stepsLeft = stepsToCompile(model.bodies.size());
  p.trees.emplace(model, state);
  p.compiled =
      std::async(std::launch::async, mujoco::compileWorld, mujoco::toMjcf(model, *p.trees, known.step, known.sizes));
}

void MujocoEngine::abandon(Known& known) {
  std::erase_if(abandoned_,
                [](const auto& f) { return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (known.pending.trees) abandoned_.push_back(std::move(known.pending.compiled));
  known.pending = {};
}

void MujocoEngine::takePending(Known& known, const engine::Model& model, const engine::State& state) {
  Pending& p = known.pending;
  if (!p.trees) return;
  ++p.waited;
  if (--p.stepsLeft > 0) return;
  try {
    // The number of steps does not depend on the machine, so that runs are alike: a slower one waits here.
    begin(known, model, state, std::move(*p.trees), p.compiled.get());
  } catch (const Error& e) {
    refuse(known, e.what());
  }
  p = {};
}

/// The log says so once; nothing moves until the model is another one.
void MujocoEngine::refuse(Known& known, const std::string& why) {
  known.world.reset();
  if (std::exchange(known.refused, why) != why)
    kernel().log().error("{}: MuJoCo does not take this world, so nothing in it moves: {}", path(), why);
}

void MujocoEngine::detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int,
                          engine::Contacts& out) {
  Known& known = of(model);
  known.filter = filter;
  if (known.world) known.world->detect(model, state, filter, out);
}

void MujocoEngine::report(MujocoWorld& world) {
  const std::string message = world.takeMessage();
  if (message.empty()) return;
  ++messages_;
  if ((messages_ & (messages_ - 1)) == 0)
    kernel().log().warning("{}: MuJoCo reports: {} (message {})", path(), message, messages_);
}

void MujocoEngine::step(engine::Step& step) {
  Known& known = of(step.model);
  if (known.world && known.step != step.dt) {
    known.step = step.dt;
    build(known, step.model, step.state);
  }
  if (!known.world) {
    for (engine::DynamicState& s : step.state.bodies) s.force.setZero(), s.torque.setZero();
    return;
  }
  try {
    known.world->step(step);
  } catch (const Error& e) {
    return refuse(known, e.what());
  }
  report(*known.world);
  takePending(known, step.model, step.state);
  if (!known.world || known.full || !known.world->isFull()) return;
  const mujoco::Sizes old = known.sizes;
  kernel().log().info("{}: MuJoCo's room of {} contacts and {} rows was too small; it is doubled", path(), old.contacts,
                      old.rows);
  known.sizes = {2 * old.contacts, 2 * old.rows};
  build(known, step.model, step.state);
  if (known.world) return;
  // There is no more room: on with the old one.
  known.full = true;
  known.sizes = old;
  build(known, step.model, step.state);
}

}  // namespace spark

SPARK_PLUGIN("physics-mujoco", "1.0", "MuJoCo: contacts and dynamics in coordinates of joints.", spark::MujocoEngine)
