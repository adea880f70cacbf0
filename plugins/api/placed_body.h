#pragma once
/// \file
/// What sensors of acceleration know of a body beside its state.

#include "api/math.h"
#include "spark/abi/api/placed_body.h"
#include "spark/interface.h"

namespace spark {

/// A body whose velocity does not change in steps alone: beams, resets and trainers set it. Offered by RigidBody.
/// Simulation thread.
class IPlacedBody {
 public:
  SPARK_INTERFACE(IPlacedBody, 1);
  virtual ~IPlacedBody() = default;
  /// Changes of velocity that no step made, summed up since the body was made, world frame.
  struct Jumps {
    Vec3 linear = Vec3::Zero();   ///< m/s
    Vec3 angular = Vec3::Zero();  ///< rad/s
  };
  /// The difference of two readings is what was set between them. Not part of a saved state.
  virtual const Jumps& jumps() const = 0;
  /// Gravity of its world [m/s^2], also if it does not act on this body.
  virtual Vec3 worldGravity() const = 0;
  /// True: its world repeats recorded sessions of the installed base (Model::exactReplay).
  virtual bool exactReplay() const = 0;
};

}  // namespace spark
