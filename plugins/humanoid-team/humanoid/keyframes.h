#pragma once
/// \file
/// Movements that are played from a list of poses.

#include <span>
#include <vector>

#include "nao.h"

namespace humanoid {

/// Which side an angle is for. Angles are those of the right side; the left side's are mirrored.
enum class Side { both, right, left };
/// A joint by its right one, `Joint::rHipPitch` say.
struct Angle {
  Side side;
  Joint joint;
  double deg;
};
/// Joints that are not named stay where they were to be.
struct Keyframe {
  double seconds;  ///< from the pose before to this one
  std::vector<Angle> angles;
};
using Movement = std::vector<Keyframe>;

/// Sets the angles of a keyframe. `mirrored`: left is right.
void apply(const Keyframe& frame, bool mirrored, Pose& pose);

/// Plays one movement.
class Player {
 public:
  /// `from`: the pose it begins in. The movement must outlive the playing.
  void start(const Movement& movement, const Pose& from, bool mirrored = false);
  void stop() { movement_ = nullptr; }
  bool playing() const { return movement_ != nullptr; }
  /// One cycle further.
  void step(Pose& pose);

 private:
  void next();

  const Movement* movement_ = nullptr;
  bool mirrored_ = false;
  std::size_t frame_ = 0;
  double time_ = 0;  ///< s in this frame
  Pose from_{}, to_{};
};

/// From the back over the right side to the belly.
const Movement& rollOver();
/// From either side to the belly.
const Movement& tipForward();

}  // namespace humanoid
