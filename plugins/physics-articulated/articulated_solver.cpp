#include "articulated_solver.h"

#include "spark/plugin.h"

namespace spark {

std::size_t ArticulatedSolver::step(engine::SolverStep& step) {
  Jobs& jobs = kernel().jobs();
  return stepper_.step(step, static_cast<std::size_t>(jobs.threads()),
                       [&](std::size_t n, const auto& work) { jobs.run(n, work); });
}

}  // namespace spark

SPARK_PLUGIN("physics-articulated", "1.0", "A constraint solver for articulated bodies, as the child of an engine.",
             spark::ArticulatedSolver)
