#include "ode_engine.h"

// A solver below the engine works on ODE's memory: the pointers of a SolverBody refer to the state in ODE's body (see
// ode_bodies.cpp), and SolverJoint mirrors ODE's joint (see ode_mirror.cpp). So ODE continues with any body as if it
// had stepped it itself. ODE steps the islands that the solver defers.

namespace spark {

using namespace ode;

engine::ISolver* OdeEngine::solver() {
  if (!tree_.changed(*this)) return solver_;
  solver_ = childOf<engine::ISolver>();
  for (const auto& w : worlds_) {
    w->solved.clear();
    for (const auto& b : w->bodies) b->deferred = !solver_;
  }
  return solver_;
}

namespace {

/// Lists bodies and joints for the solver, when the structure changed.
void listForSolver(WorldData& w) {
  if (w.listedAt == w.structure) return;
  w.listedAt = w.structure;
  w.solverBodies.clear();
  w.solverJoints.clear();
  for (const auto& b : w.bodies) {
    b->index = static_cast<std::uint32_t>(w.solverBodies.size());
    w.solverBodies.push_back(b.get());
  }
  for (const auto& j : w.joints) w.solverJoints.push_back(j.get());
}

/// After the solver: enables the bodies that it stepped in ODE, and marks their geoms as moved.
void updateOde(WorldData& w) {
  w.solved.clear();
  for (const auto& b : w.bodies) {
    if (!b->awake || b->deferred) continue;
    w.solved.push_back(b.get());
    if (!dBodyIsEnabled(b->id)) dBodyEnable(b->id);
    dBodySetPosition(b->id, b->position[0], b->position[1], b->position[2]);
  }
}

void copyFeedback(const engine::SolverJoint& from, dJointFeedback& to) {
  for (int i = 0; i < 3; ++i) {
    to.f1[i] = from.forceA[i];
    to.t1[i] = from.torqueA[i];
    to.f2[i] = from.forceB[i];
    to.t2[i] = from.torqueB[i];
  }
}

}  // namespace

std::size_t OdeEngine::stepBySolver(WorldData& w, engine::ISolver& solver, engine::Contacts& contacts, double dt) {
  listForSolver(w);
  engine::SolverStep step{.world = handle(w),
                          .bodies = w.solverBodies,
                          .joints = w.solverJoints,
                          .contacts = contacts,
                          .pairs = w.contactPairs,
                          .parameters = w.parameters,
                          .dt = dt,
                          .structure = w.structure,
                          .maxCouplingRows = directRows_};
  const std::size_t deferred = solver.step(step);
  updateOde(w);
  for (const auto& j : w.joints)
    if (j->wantsFeedback && j->a && j->a->awake && !j->a->deferred) copyFeedback(*j, j->feedback);
  return deferred;
}

}  // namespace spark
