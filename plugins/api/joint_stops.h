#pragma once
/// \file
/// How fast joints come back from beyond their stops.

#include <algorithm>

#include "api/model.h"
#include "spark/abi/api/joint_stops.h"

namespace spark::engine {

/// Largest speed at which a stop moves an axis back that is beyond it [rad/s; slider: m/s]. A fraction of the error in
/// each step, as ERP means it, would be a blow where a model starts far beyond its stops.
constexpr double kStopReturn = 5;

/// The speed at which a stop of a joint moves an axis back that is `excess` beyond it [rad or m], of the same sign.
/// Angular motors have no such bound: they are beside the joint that holds the bodies.
inline double stopReturn(JointType joint, double excess, double erp, double dt) {
  const double speed = erp * excess / dt;
  return joint == JointType::angularMotor ? speed : std::clamp(speed, -kStopReturn, kStopReturn);
}

}  // namespace spark::engine
