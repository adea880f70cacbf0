#include "ode_engine.h"

// An island is what joints and solved contacts hold together; the static world holds nothing together. When all constraints of a world
// are few, or cannot hold many together, nothing is counted. Else islands are found by union of bodies, and if one is too large the world
// is stepped twice: first without the bodies of large islands, by the direct solver, then with only them, by the iterative one. A body that
// is out is one that sleeps, as ODE knows it; islands do not touch each other, so nobody is woken.

namespace spark {

using namespace ode;

int ode::rowsOf(engine::JointType type) {
  switch (type) {
    case engine::JointType::ball:
    case engine::JointType::angularMotor:
      return 3;
    default:
      return 6;
  }
}

namespace {

BodyData* firstOf(BodyData* b) {
  while (b->island != b) b = b->island = b->island->island;
  return b;
}

void unite(BodyData* a, BodyData* b, int rows) {
  if (!a) std::swap(a, b);
  if (!a) return;
  a = firstOf(a);
  a->rows += rows;
  if (!b || (b = firstOf(b)) == a) return;
  b->island = a;
  a->rows += b->rows;
}

void findIslands(WorldData& w, const engine::Contacts& contacts) {
  for (const auto& b : w.bodies) b->island = b.get(), b->rows = 0;
  for (const auto& j : w.joints) unite(j->a, j->b, rowsOf(j->type));
  for (const engine::Contact& c : contacts)
    if (c.solve) unite(data(c.geomA)->body, data(c.geomB)->body, kContactRows);
}

/// Puts the awake bodies of large (or of all other) islands to sleep; they stand in w.sleepers.
void exclude(WorldData& w, int directRows, bool large) {
  w.sleepers.clear();
  for (const auto& b : w.bodies)
    if ((firstOf(b.get())->rows > directRows) == large && dBodyIsEnabled(b->id)) {
      dBodyDisable(b->id);
      w.sleepers.push_back(b.get());
    }
}

void wake(WorldData& w) {
  for (BodyData* b : w.sleepers) dBodyEnable(b->id);
}

}  // namespace

void OdeEngine::solve(WorldData& w, const engine::Contacts& contacts, double dt) {
  // An island of n bodies has at least n - 1 constraints between them, which bounds both.
  const std::int64_t uniting = w.unitingRows + 6 * static_cast<std::int64_t>(w.joints.size());
  const std::int64_t bound = uniting + (1 + uniting / kContactRows) * w.mostStaticRows;
  int largest = 0;
  if (bound > directRows_) {
    findIslands(w, contacts);
    for (const auto& b : w.bodies)
      if (dBodyIsEnabled(b->id)) largest = std::max(largest, firstOf(b.get())->rows);
  }
  if (largest <= directRows_) {
    dWorldStep(w.id, dt);
    return;
  }
  if (++approximateSteps_ == 1)
    kernel().log().info(
        "{}: {} constraint rows hang together, more than the {} that the direct solver is given (directRows): such islands are solved "
        "approximately. "
        "Do robots stand in each other?",
        path(), largest, directRows_);
  exclude(w, directRows_, true);
  dWorldStep(w.id, dt);
  wake(w);
  exclude(w, directRows_, false);
  {
    const std::lock_guard lock(quickMutex());
    dRandSetSeed(1);
    dWorldQuickStep(w.id, dt);
  }
  wake(w);
}

}  // namespace spark
