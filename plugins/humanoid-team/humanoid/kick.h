#pragma once
/// \file
/// A kick forward: the weight goes over one foot, the other swings.

#include "walk.h"

namespace humanoid {

class Kick {
 public:
  Kick(const Build& build, const Gait& gait) : build_(build), gait_(gait) {}
  /// Begins in the gait's stance. `right`: which foot kicks.
  void start(bool right);
  void stop() { frame_ = kFrames; }
  bool playing() const { return frame_ < kFrames; }
  /// One cycle further: the angles of both legs.
  void step(Pose& pose);

  /// Where the ball should be for a good kick, seen from the torso's middle: to the side of the kicking foot, and forward [m].
  static constexpr double kBallSide = 0.06, kBallForward = 0.17;

 private:
  static constexpr std::size_t kFrames = 6;
  const Build& build_;
  const Gait& gait_;
  bool right_ = true;
  std::size_t frame_ = kFrames;
  double time_ = 0;  ///< s in this frame
};

}  // namespace humanoid
