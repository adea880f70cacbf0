#pragma once
/// \file
/// From wanted joint angles to the speeds that the motors take.

#include "nao.h"
#include "spark/predicates.h"

namespace humanoid {

/// Drives all joints of one robot. A command acts two messages after the percepts that it answers: the one still under
/// way is counted in.
class JointDrive {
 public:
  explicit JointDrive(const Build& build) : build_(build) {}
  /// Appends one command a joint. `wanted`, `measured`: angles [rad]; `share`: of the way left that is to be made
  /// within a cycle, 0..1.
  void drive(const Pose& wanted, const Pose& measured, double share, spark::Predicates& out);

 private:
  const Build& build_;
  Pose underWay_{};  ///< rad/s
};

}  // namespace humanoid
