#include <algorithm>
#include <utility>

#include "ode_engine.h"

// An island is a set of bodies that joints and solved contacts connect; static geoms connect nothing. Islands with more
// than `directRows` constraint rows are too large for the direct solver.
//
//  1. A cheap upper bound on the rows of any island decides whether islands must be counted at all.
//  2. If so, disjoint sets of bodies (union by the links of islandParent, with path halving) give the islands.
//  3. If one is too large, the world is stepped twice: by the direct solver without the bodies of large islands, then
//  by
//     the iterative solver with only these. Excluded bodies are disabled for ODE. Islands do not touch each other, so
//     ODE does not wake them.

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

/// Root of the set of a body.
BodyData* rootOf(BodyData* b) {
  while (b->islandParent != b) b = b->islandParent = b->islandParent->islandParent;
  return b;
}

/// Joins the sets of two bodies that a constraint with `rows` rows connects; nullptr is the static world.
void unite(BodyData* a, BodyData* b, int rows) {
  if (!a) std::swap(a, b);
  if (!a) return;
  a = rootOf(a);
  a->islandRows += rows;
  if (!b || (b = rootOf(b)) == a) return;
  b->islandParent = a;
  a->islandRows += b->islandRows;
}

/// Makes the sets of bodies that joints connect.
void findJointSets(WorldData& w) {
  for (const auto& b : w.bodies) b->islandParent = b.get(), b->islandRows = 0;
  for (const auto& j : w.joints) unite(data(j->a), data(j->b), rowsOf(j->type));
}

/// Makes the sets of bodies that joints and contacts connect.
void findIslands(WorldData& w) {
  findJointSets(w);
  for (const engine::SolverPair& p : w.contactPairs) unite(data(p.a), data(p.b), kContactRows);
}

/// Counts the most rows and the most bodies in a set that joints connect, when the structure changed.
void countJointSets(WorldData& w) {
  if (w.jointRowsAt == w.structure) return;
  w.jointRowsAt = w.structure;
  w.maxJointRows = w.maxJointBodies = 0;
  findJointSets(w);
  for (const auto& b : w.bodies) w.maxJointRows = std::max(w.maxJointRows, std::exchange(b->islandRows, 0));
  for (const auto& b : w.bodies) w.maxJointBodies = std::max(w.maxJointBodies, ++rootOf(b.get())->islandRows);
}

/// Upper bound on the rows of an island. n contacts between bodies connect at most n + 1 sets of joints.
std::int64_t maxIslandRows(WorldData& w) {
  countJointSets(w);
  const std::int64_t sets = 1 + w.couplingRows / kContactRows;
  return w.couplingRows + sets * w.maxJointRows +
         std::min<std::int64_t>(w.staticRows, sets * w.maxJointBodies * w.maxStaticRows);
}

/// Disables the awake bodies of large islands, or of all others, and lists them in w.excluded.
void exclude(WorldData& w, int directRows, bool large) {
  w.excluded.clear();
  for (const auto& b : w.bodies)
    if ((rootOf(b.get())->islandRows > directRows) == large && dBodyIsEnabled(b->id)) {
      dBodyDisable(b->id);
      w.excluded.push_back(b.get());
    }
}

/// Enables the bodies of w.excluded again.
void include(WorldData& w) {
  for (BodyData* b : w.excluded) dBodyEnable(b->id);
}

/// Pushes the bodies that are connected to `b` and were not visited in this step.
void visitNeighbours(WorldData& w, const BodyData& b) {
  for (int i = 0; const dJointID joint = dBodyGetJoint(b.id, i); ++i)
    for (int side = 0; side < 2; ++side) {
      const dBodyID other = dJointGetBody(joint, side);
      auto* found = other ? static_cast<BodyData*>(dBodyGetData(other)) : nullptr;
      if (!found || found->visitedStep == w.steps) continue;
      found->visitedStep = w.steps;
      w.visitStack.push_back(found);
    }
}

/// Marks the geoms of all bodies that dWorldStep is going to move as moved, in the order in which it moves them in one
/// thread. A geom that is marked already keeps its position in the space's list, so the threads of the step cannot
/// change the order. Islands are traversed as in ODE: depth first, from the youngest body.
void moveGeomsInOrder(WorldData& w) {
  for (auto youngest = w.bodies.rbegin(); youngest != w.bodies.rend(); ++youngest) {
    if ((*youngest)->visitedStep == w.steps || !dBodyIsEnabled((*youngest)->id)) continue;
    (*youngest)->visitedStep = w.steps;
    w.visitStack.assign(1, youngest->get());
    while (!w.visitStack.empty()) {
      const BodyData& b = *w.visitStack.back();
      w.visitStack.pop_back();
      dBodySetPosition(b.id, b.position[0], b.position[1], b.position[2]);
      visitNeighbours(w, b);
    }
  }
}

/// Number of awake bodies from which on several threads pay off.
constexpr std::ptrdiff_t kParallelBodies = 40;

}  // namespace

void OdeEngine::solveDirectly(WorldData& w, double dt) {
  const auto awake =
      std::count_if(w.bodies.begin(), w.bodies.end(), [](const auto& b) { return dBodyIsEnabled(b->id); });
  w.threads->setParallel(awake >= kParallelBodies);
  if (w.threads->parallel() && w.exactReplay) moveGeomsInOrder(w);
  dWorldStep(w.id, dt);
  w.threads->takeMessage(odeMessage_);
}

void OdeEngine::solve(WorldData& w, double dt) {
  // Rows of the largest awake island; 0 when none can be too large.
  int largest = 0;
  if (maxIslandRows(w) > directRows_) {
    findIslands(w);
    for (const auto& b : w.bodies)
      if (dBodyIsEnabled(b->id)) largest = std::max(largest, rootOf(b.get())->islandRows);
  }
  if (largest <= directRows_) return solveDirectly(w, dt);
  if (++approximateSteps_ == 1)
    kernel().log().info(
        "{}: an island has {} constraint rows, more than the direct solver accepts (directRows: {}). Such islands are "
        "solved approximately. Do robots overlap?",
        path(), largest, directRows_);

  // The direct solver, without the large islands.
  exclude(w, directRows_, true);
  solveDirectly(w, dt);
  include(w);

  // The iterative solver with only these, in one thread and always with the same seed.
  exclude(w, directRows_, false);
  {
    const std::lock_guard lock(quickStepMutex());
    dRandSetSeed(1);
    w.threads->setSingleThreaded(true);
    dWorldQuickStep(w.id, dt);
    w.threads->setSingleThreaded(false);
  }
  include(w);
}

}  // namespace spark
