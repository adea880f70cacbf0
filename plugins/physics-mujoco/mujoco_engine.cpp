#include "mujoco_engine.h"

#include <algorithm>

#include "spark/plugin.h"

namespace spark {

using mujoco::MujocoWorld;

namespace {

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
  build(known, model, state);
}

void MujocoEngine::build(Known& known, const engine::Model& model, const engine::State& state) {
  known.world.reset();
  try {
    known.world = std::make_unique<MujocoWorld>(model, state, known.step, known.sizes);
  } catch (const Error& e) {
    refuse(known, e.what());
    return;
  }
  ++compilations_;
  if (!known.world->trees().leftOver.empty() && !std::exchange(warned_, true))
    kernel().log().warning(
        "{}: {} joints have no effect in MuJoCo: those that close a loop of bodies, and angular motors", path(),
        known.world->trees().leftOver.size());
}

/// The log says so once; nothing moves until the model is another one.
void MujocoEngine::refuse(Known& known, const std::string& why) {
  known.world.reset();
  if (std::exchange(known.refused, why) != why)
    kernel().log().error("{}: MuJoCo does not take this world, so nothing in it moves: {}", path(), why);
}

void MujocoEngine::detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int,
                          engine::Contacts& out) {
  if (Known& known = of(model); known.world) known.world->detect(model, state, filter, out);
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
  if (known.full || !known.world->isFull()) return report(*known.world);
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
