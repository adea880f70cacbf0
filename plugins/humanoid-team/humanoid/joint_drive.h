#pragma once
/// \file
/// Converts wanted joint angles to motor speeds.

#include "nao.h"
#include "spark/predicates.h"

namespace humanoid {

/// Drives all joints of one robot. A command takes effect two messages after the percepts that it answers, so the
/// previous command, which has not taken effect yet, is included in the calculation.
class JointDrive {
 public:
  explicit JointDrive(const Build& build) : build_(build) {}
  /// Appends one command per joint. `wanted`, `measured`: angles [rad]; `share`: fraction of the remaining angle to
  /// cover in one cycle, 0..1.
  void drive(const Pose& wanted, const Pose& measured, double share, spark::Predicates& out);
  template <class F>
  void fields(F& f) {
    f(underWay_);
  }

 private:
  const Build& build_;
  Pose underWay_{};  ///< speeds of the command that has not taken effect yet [rad/s]
};

}  // namespace humanoid
