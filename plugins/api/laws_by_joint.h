#pragma once
/// \file
/// The laws of a step, by the joints that they act on.

#include "api/state.h"
#include "spark/abi/api/laws_by_joint.h"

namespace spark::engine {

class LawsByJoint {
 public:
  /// Lists those of `state`, which must outlive the step.
  void list(const State& state) {
    laws_ = &state.laws;
    next_.clear();
    if (state.laws.empty()) return;
    first_.assign(state.motors.size(), kNone);
    next_.resize(state.laws.size());
    for (auto i = static_cast<Index>(state.laws.size()); i-- > 0;)
      next_[i] = std::exchange(first_[state.laws[i].joint], i);
  }
  /// Calls `visit` with each law of an axis, in their order.
  template <class F>
  void forEach(Index joint, int axis, F visit) const {
    if (next_.empty()) return;
    for (Index i = first_[joint]; i != kNone; i = next_[i])
      if ((*laws_)[i].axis == axis) visit((*laws_)[i]);
  }

 private:
  const std::vector<AxisLaw>* laws_ = nullptr;
  std::vector<Index> first_, next_;  ///< by joint; by law. Without laws next_ is empty
};

}  // namespace spark::engine
