#pragma once
/// \file
/// Getting up from belly, back or side: keyframes, the same for both sides of the body, with feedback at the end.

#include <algorithm>
#include <array>
#include <span>

#include "posture.h"

namespace humanoid {

/// A symmetric pose, and the time to reach it from the previous one [s]. Angles in degrees.
struct Keyframe {
  double seconds;
  double shoulderPitch, shoulderOut, armRoll, elbow;
  double hipYaw, legOut, hipPitch, knee, ankle;
};
/// A sequence of keyframes. The first is held for a moment, so that the others start at rest.
struct Movement {
  std::span<const Keyframe> frames;
  double straighten = 0,
         damp = 0;  ///< of the ankles in the last two frames, per degree of lean beyond the target, and per degree/s
  double squatLean = 0, endLean = 0;  ///< target lean in the last frame but one, and at the end [deg]
};

/// The movement with which a robot of `type` (0..4) gets up from belly or back; from a side it first rolls over.
const Movement& movementOf(int type, Lying lying);

/// Executes a movement.
class GetUp {
 public:
  /// Starts `movement`, which must outlive its execution. `from`: the current pose.
  void start(const Movement& movement, const Pose& from);
  void stop() { movement_ = nullptr; }
  /// Goes on with the movement of loaded fields; nullptr: with none.
  void resume(const Movement* movement) {
    movement_ = movement;
    if (movement) frame_ = std::min(frame_, movement->frames.size() - 1);
  }
  bool playing() const { return movement_ != nullptr; }
  /// True for one cycle after the first frame: the time to check that the robot still lies on the same side.
  bool begun() const { return frame_ == 1 && time_ == 0; }
  /// Sets `pose` for the next cycle.
  void step(const Percepts& percepts, const Posture& posture, Pose& pose);
  /// Its state without the movement.
  template <class F>
  void fields(F& f) {
    f(frame_, time_, from_, to_);
  }

 private:
  const Movement* movement_ = nullptr;
  std::size_t frame_ = 0;
  double time_ = 0;  ///< s in this frame
  Pose from_{}, to_{};
};

}  // namespace humanoid
