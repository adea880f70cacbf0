#include <algorithm>
#include <utility>

#include "ode_engine.h"

// An island is what joints and solved contacts hold together; the static world holds nothing together. When the
// contacts of a step cannot bring too many constraints together, nothing is counted. Else islands are found by union of
// bodies, and if one is too large the world is stepped twice: first without the bodies of large islands, by the direct
// solver, then with only them, by the iterative one. A body that is out is one that sleeps, as ODE knows it; islands do
// not touch each other, so nobody is woken.

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

void findHeld(WorldData& w) {
  for (const auto& b : w.bodies) b->island = b.get(), b->rows = 0;
  for (const auto& j : w.joints) unite(data(j->a), data(j->b), rowsOf(j->type));
}

void findIslands(WorldData& w) {
  findHeld(w);
  for (const engine::SolverPair& p : w.contactPairs) unite(data(p.a), data(p.b), kContactRows);
}

/// Most rows and most bodies that joints alone hold together.
void countHeld(WorldData& w) {
  if (w.heldAt == w.structure) return;
  w.heldAt = w.structure;
  w.heldRows = w.heldBodies = 0;
  findHeld(w);
  for (const auto& b : w.bodies) w.heldRows = std::max(w.heldRows, std::exchange(b->rows, 0));
  for (const auto& b : w.bodies) w.heldBodies = std::max(w.heldBodies, ++firstOf(b.get())->rows);
}

/// No island has more rows: so many contacts between bodies bring together one more of what joints hold.
std::int64_t boundOfRows(WorldData& w) {
  countHeld(w);
  const std::int64_t parts = 1 + w.unitingRows / kContactRows;
  return w.unitingRows + parts * w.heldRows +
         std::min<std::int64_t>(w.staticRows, parts * w.heldBodies * w.mostStaticRows);
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

/// Adds what hangs on a body and was not found in this step.
void visitNeighbours(WorldData& w, const BodyData& b) {
  for (int i = 0; const dJointID joint = dBodyGetJoint(b.id, i); ++i)
    for (int side = 0; side < 2; ++side) {
      const dBodyID other = dJointGetBody(joint, side);
      auto* found = other ? static_cast<BodyData*>(dBodyGetData(other)) : nullptr;
      if (!found || found->foundAt == w.steps) continue;
      found->foundAt = w.steps;
      w.toVisit.push_back(found);
    }
}

/// Says that the geoms of all bodies that dWorldStep is going to move have moved, in the order in which it moves them
/// in one thread: a geom that is known to have moved stays where it is in its space. Islands are walked through as ODE
/// does it, the youngest body first.
void moveGeomsInOrder(WorldData& w) {
  for (auto youngest = w.bodies.rbegin(); youngest != w.bodies.rend(); ++youngest) {
    if ((*youngest)->foundAt == w.steps || !dBodyIsEnabled((*youngest)->id)) continue;
    (*youngest)->foundAt = w.steps;
    w.toVisit.assign(1, youngest->get());
    while (!w.toVisit.empty()) {
      const BodyData& b = *w.toVisit.back();
      w.toVisit.pop_back();
      dBodySetPosition(b.id, b.position[0], b.position[1], b.position[2]);
      visitNeighbours(w, b);
    }
  }
}

/// Awake bodies that are worth more than one thread.
constexpr std::ptrdiff_t kWorthThreads = 40;

}  // namespace

void OdeEngine::solveDirectly(WorldData& w, double dt) {
  const auto awake =
      std::count_if(w.bodies.begin(), w.bodies.end(), [](const auto& b) { return dBodyIsEnabled(b->id); });
  w.threads->setParallel(awake >= kWorthThreads);
  if (w.threads->parallel() && w.exactReplay) moveGeomsInOrder(w);
  dWorldStep(w.id, dt);
  w.threads->hear(said_);
}

void OdeEngine::solve(WorldData& w, double dt) {
  int largest = 0;
  if (boundOfRows(w) > directRows_) {
    findIslands(w);
    for (const auto& b : w.bodies)
      if (dBodyIsEnabled(b->id)) largest = std::max(largest, firstOf(b.get())->rows);
  }
  if (largest <= directRows_) return solveDirectly(w, dt);
  if (++approximateSteps_ == 1)
    kernel().log().info(
        "{}: {} constraint rows hang together, more than the {} that the direct solver is given (directRows): such "
        "islands are solved "
        "approximately. "
        "Do robots stand in each other?",
        path(), largest, directRows_);
  exclude(w, directRows_, true);
  solveDirectly(w, dt);
  wake(w);
  exclude(w, directRows_, false);
  {
    const std::lock_guard lock(quickMutex());
    dRandSetSeed(1);
    w.threads->setAlone(true);
    dWorldQuickStep(w.id, dt);
    w.threads->setAlone(false);
  }
  wake(w);
}

}  // namespace spark
