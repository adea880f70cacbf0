#pragma once
/// \file
/// Up from belly, back, or side: keyframes that both sides of the body play alike, with feedback at the end.

#include <array>
#include <span>

#include "posture.h"

namespace humanoid {

/// A pose of both sides and the time from the one before. Angles in degrees.
struct Keyframe {
  double seconds;
  double shoulderPitch, shoulderOut, armRoll, elbow;
  double hipYaw, legOut, hipPitch, knee, ankle;
};
/// The first frame is held for a moment, so that what follows begins at rest.
struct Movement {
  std::span<const Keyframe> frames;
  double straighten = 0,
         damp =
             0;  ///< of the ankles in the last two frames, for a degree of lean beyond what is wanted, for a degree/s
  double squatLean = 0, endLean = 0;  ///< wanted in the last but one, and at the end [deg]
};

/// How a type (0..4) gets up from belly or back; from a side it turns onto one of them.
const Movement& movementOf(int type, Lying lying);

/// Plays one movement.
class GetUp {
 public:
  /// `from`: the pose it begins in. The movement must outlive the playing.
  void start(const Movement& movement, const Pose& from);
  void stop() { movement_ = nullptr; }
  bool playing() const { return movement_ != nullptr; }
  /// True once, when the first frame is over: does it still lie as it did?
  bool begun() const { return frame_ == 1 && time_ == 0; }
  /// One cycle further.
  void step(const Percepts& percepts, const Posture& posture, Pose& pose);

 private:
  const Movement* movement_ = nullptr;
  std::size_t frame_ = 0;
  double time_ = 0;  ///< s in this frame
  Pose from_{}, to_{};
};

}  // namespace humanoid
