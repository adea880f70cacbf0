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

constexpr double kUsualStep = 0.02;  // s

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
  if (known.world && known.structure == model.structure && known.collision == model.collision &&
      known.dynamics == model.dynamics)
    return;
  known.structure = model.structure;
  known.collision = model.collision;
  known.dynamics = model.dynamics;
  const mujoco::Sizes least = sizesFor(model), old = known.world ? known.world->sizes() : least;
  const double step = known.world ? known.world->stepSize() : kUsualStep / substeps_;
  known.world.reset();
  try {
    build(known, model, state, step, {std::max(least.contacts, old.contacts), std::max(least.rows, old.rows)});
  } catch (const Error& e) {
    // The log says so once; nothing moves until the model is another one.
    if (std::exchange(known.refused, e.what()) != e.what())
      kernel().log().error("{}: MuJoCo does not take this world, so nothing in it moves: {}", path(), e.what());
  }
}

void MujocoEngine::build(Known& known, const engine::Model& model, const engine::State& state, double step,
                         const mujoco::Sizes& sizes) {
  known.world = std::make_unique<MujocoWorld>(model, state, step, sizes);
  ++compilations_;
  if (!known.world->trees().leftOver.empty() && !std::exchange(warned_, true))
    kernel().log().warning(
        "{}: {} joints have no effect in MuJoCo: those that close a loop of bodies, and angular motors", path(),
        known.world->trees().leftOver.size());
}

void MujocoEngine::detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int,
                          engine::Contacts& out) {
  if (Known& known = of(model); known.world) known.world->detect(model, state, filter, out);
}

void MujocoEngine::step(engine::Step& step) {
  Known& known = of(step.model);
  if (!known.world) return;
  const double wanted = step.dt / substeps_;
  if (std::abs(known.world->stepSize() - wanted) > 1e-12)
    build(known, step.model, step.state, wanted, mujoco::Sizes(known.world->sizes()));
  known.world->step(step, substeps_);
  if (known.full || !known.world->isFull()) return;
  const mujoco::Sizes old = known.world->sizes();
  kernel().log().info("{}: MuJoCo's room of {} contacts and {} rows was too small; it is doubled", path(), old.contacts,
                      old.rows);
  try {
    build(known, step.model, step.state, wanted, {2 * old.contacts, 2 * old.rows});
  } catch (const Error& e) {
    known.full = true;
    kernel().log().error("{}: {}. Contacts above that room are dropped", path(), e.what());
  }
}

}  // namespace spark

SPARK_PLUGIN("physics-mujoco", "1.0", "MuJoCo: contacts and dynamics in coordinates of joints.", spark::MujocoEngine)
