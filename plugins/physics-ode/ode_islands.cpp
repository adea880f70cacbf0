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

namespace spark::ode {

using engine::Index;
using engine::kNone;

int rowsOf(engine::JointType type) {
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
Index rootOf(WorldData& w, Index b) {
  const auto parent = [&](Index i) -> Index& { return w.bodies[i].islandParent; };
  while (parent(b) != b) b = parent(b) = parent(parent(b));
  return b;
}

int& rowsAt(WorldData& w, Index b) { return w.bodies[rootOf(w, b)].islandRows; }

/// Joins the sets of two bodies that a constraint with `rows` rows connects; kNone is the static world.
void unite(WorldData& w, Index a, Index b, int rows) {
  if (a == kNone) std::swap(a, b);
  if (a == kNone) return;
  a = rootOf(w, a);
  w.bodies[a].islandRows += rows;
  if (b == kNone || (b = rootOf(w, b)) == a) return;
  w.bodies[b].islandParent = a;
  w.bodies[a].islandRows += w.bodies[b].islandRows;
}

/// Makes the sets of bodies that joints connect.
void findJointSets(WorldData& w, const engine::Model& model) {
  for (Index i = 0; i < w.bodies.size(); ++i) w.bodies[i].islandParent = i, w.bodies[i].islandRows = 0;
  for (const engine::Joint& j : model.joints) unite(w, j.a, j.b, rowsOf(j.type));
  for (const LawJoint& l : w.laws) unite(w, l.a, l.b, 1);
}

/// Makes the sets of bodies that joints and contacts connect.
void findIslands(WorldData& w, const engine::Step& step) {
  findJointSets(w, step.model);
  for (const engine::Contact& c : step.contacts)
    if (c.solve) unite(w, c.bodyA, c.bodyB, kContactRows);
}

/// Counts the most rows and the most bodies in a set that joints connect, when the structure changed.
void countJointSets(WorldData& w, const engine::Model& model) {
  if (std::exchange(w.jointRowsCounted, true)) return;
  w.maxJointRows = w.maxJointBodies = 0;
  findJointSets(w, model);
  for (BodyData& b : w.bodies) w.maxJointRows = std::max(w.maxJointRows, std::exchange(b.islandRows, 0));
  for (Index i = 0; i < w.bodies.size(); ++i) w.maxJointBodies = std::max(w.maxJointBodies, ++rowsAt(w, i));
}

/// Upper bound on the rows of an island. n contacts between bodies connect at most n + 1 sets of joints.
std::int64_t maxIslandRows(WorldData& w, const engine::Model& model) {
  countJointSets(w, model);
  const std::int64_t sets = 1 + w.couplingRows / kContactRows;
  return w.couplingRows + sets * w.maxJointRows +
         std::min<std::int64_t>(w.staticRows, sets * w.maxJointBodies * w.maxStaticRows);
}

bool enabled(const WorldData& w, Index i) { return w.enabled[i] != 0; }

/// Disables the awake bodies of large islands, or of all others, and lists them in w.excluded.
void exclude(WorldData& w, int directRows, bool large) {
  w.excluded.clear();
  for (Index i = 0; i < w.bodies.size(); ++i)
    if ((rowsAt(w, i) > directRows) == large && enabled(w, i)) {
      dBodyDisable(w.bodies[i].body);
      w.excluded.push_back(i);
    }
}

/// Enables the bodies of w.excluded again.
void include(WorldData& w) {
  for (const Index i : w.excluded) dBodyEnable(w.bodies[i].body);
}

/// Pushes the bodies that are connected to body `i` and were not visited in this step.
void visitNeighbours(WorldData& w, Index i) {
  for (int k = 0; const dJointID joint = dBodyGetJoint(w.bodies[i].body, k); ++k)
    for (int side = 0; side < 2; ++side) {
      const dBodyID other = dJointGetBody(joint, side);
      if (!other) continue;
      const auto found = static_cast<Index>(reinterpret_cast<std::uintptr_t>(dBodyGetData(other)));
      if (std::exchange(w.bodies[found].visitedStep, w.steps) != w.steps) w.visitStack.push_back(found);
    }
}

/// Appends the bodies that dWorldStep is going to move to w.order, in the order in which it moves them in one thread:
/// recorded sessions depend on it, because the order of geoms in a hash space is that of their last moves. Islands are
/// traversed as in ODE: depth first, from the youngest body.
void findOrder(WorldData& w) {
  for (auto youngest = static_cast<Index>(w.bodies.size()); youngest-- > 0;) {
    if (w.bodies[youngest].visitedStep == w.steps || !dBodyIsEnabled(w.bodies[youngest].body)) continue;
    w.bodies[youngest].visitedStep = w.steps;
    w.visitStack.assign(1, youngest);
    while (!w.visitStack.empty()) {
      const Index i = w.visitStack.back();
      w.visitStack.pop_back();
      w.order.push_back(i);
      visitNeighbours(w, i);
    }
  }
}

/// Number of awake bodies from which on several threads pay off.
constexpr std::size_t kParallelBodies = 40;

}  // namespace

void OdeSolver::solveDirectly(double dt) {
  WorldData& w = world_;
  w.threads->setParallel(w.awake >= kParallelBodies);
  // In one thread ODE's callback tells the order.
  w.listOrder = w.exactReplay && !w.threads->parallel();
  if (w.exactReplay && !w.listOrder) findOrder(w);
  // Recorded sessions have what ODE made of it.
  const MessageCapture strict(engine_.messages_.last, !w.exactReplay);
  w.threads->setStrict(!w.exactReplay);
  dWorldStep(w.id, dt);
  w.threads->takeMessage(engine_.messages_.last);
}

void OdeSolver::solve(const engine::Step& step) {
  world_.order.clear();
  solveIslands(step);
  if (!world_.exactReplay) listMoved(step);
}

// Of a recorded session the order counts, which ODE's callback and findOrder() tell.
void OdeSolver::listMoved(const engine::Step& step) {
  WorldData& w = world_;
  w.order.clear();
  for (Index i = 0; i < w.bodies.size(); ++i)
    if (w.enabled[i] && step.steps(i)) w.order.push_back(i);
}

void OdeSolver::solveIslands(const engine::Step& step) {
  WorldData& w = world_;
  const int directRows = engine_.directRows_;
  // Rows of the largest awake island; 0 when none can be too large.
  int largest = 0;
  if (maxIslandRows(w, step.model) > directRows) {
    findIslands(w, step);
    for (Index i = 0; i < w.bodies.size(); ++i)
      if (enabled(w, i)) largest = std::max(largest, rowsAt(w, i));
  }
  if (largest <= directRows) return solveDirectly(step.dt);
  if (++engine_.approximateSteps_ == 1)
    engine_.kernel().log().info(
        "{}: an island has {} constraint rows, more than the direct solver accepts (directRows: {}). Such islands are "
        "solved approximately. Do robots overlap?",
        engine_.path(), largest, directRows);

  // The direct solver, without the large islands.
  exclude(w, directRows, true);
  solveDirectly(step.dt);
  include(w);

  // The iterative solver with only these, in one thread and always with the same seed. Its time is that of rows times
  // iterations: where a thousand bodies are in one place, it gets fewer, so that the step ends.
  constexpr int kIterations = 20, kMostRows = 2'000'000;  // ODE's default; rows in all iterations
  dWorldSetQuickStepNumIterations(w.id, std::clamp(kMostRows / largest, 1, kIterations));
  exclude(w, directRows, false);
  solveApproximately(step.dt);
  include(w);
}

void OdeSolver::solveApproximately(double dt) {
  WorldData& w = world_;
  const std::lock_guard lock(quickStepMutex());
  dRandSetSeed(1);
  w.threads->setSingleThreaded(true);
  w.listOrder = w.exactReplay;
  dWorldQuickStep(w.id, dt);
  w.threads->setSingleThreaded(false);
}

bool OdeSolver::excludeMoved(const engine::Step& step) {
  WorldData& w = world_;
  const auto open = [&](Index i) { return w.needed[i] && w.bodies[i].movedStep != w.steps; };
  for (const auto& [a, b] : w.links)
    if (open(a) != open(b)) return false;
  for (const engine::Contact& c : step.contacts)
    if (c.solve && c.bodyA != kNone && c.bodyB != kNone && open(c.bodyA) != open(c.bodyB)) return false;
  w.excluded.clear();
  for (Index i = 0; i < w.bodies.size(); ++i)
    if (!open(i) && enabled(w, i)) {
      dBodyDisable(w.bodies[i].body);
      w.excluded.push_back(i);
    }
  return true;
}

void OdeSolver::solveAgain(const engine::Step& step) {
  WorldData& w = world_;
  ++engine_.approximateSteps_;
  solveApproximately(step.dt);
  include(w);
  listMoved(step);
}

}  // namespace spark::ode
