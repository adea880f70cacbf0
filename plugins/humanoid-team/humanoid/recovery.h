#pragma once
/// \file
/// Up from the belly: the hips fold, the knees follow, arms and ankles catch the swing in a squat, the legs stretch.

#include "posture.h"
#include "walk.h"

namespace humanoid {

/// What suits a type of robot. Times in s, angles in degrees.
struct RecoveryTuning {
  double pike = 0.3, fold = 0.35, rise = 1.0;          ///< s for folding the hips, the knees, for stretching
  double pikeHip = 100, pikeKnee = 0, pikeAnkle = 75;  ///< when the rest begins to fold
  double pikeArms = 0, elbow = 0;                      ///< shoulder pitch until then; elbows until it stands
  double armsOut = 0;                                  ///< shoulder yaw, away from the body, until it stands
  double foldArms = -5;                                ///< shoulder pitch while the knees fold
  double backAnkle = 55, backArms = -20;               ///< in the squat, while it still leans too far forward
  double frontArms = 50;                               ///< in the squat, while it leans too far back
  double squatLean = 48;                               ///< of the torso in the squat
  double squatHip = 100, squatKnee = -130, squatAnkle = 75;
  double straighten = 0.3, damp = 0.05;  ///< of the ankles for a degree of lean, for a degree/s, while it stretches
};
const RecoveryTuning& recoveryOf(int type);

class Recovery {
 public:
  explicit Recovery(const RecoveryTuning& tuning) : tuning_(tuning) {}
  /// `pace`: of folding, 1 as tuned; another one when that has failed.
  void start(const Pose& from, const Pose& stance, double pace = 1);
  void stop() { phase_ = Phase::done; }
  bool playing() const { return phase_ != Phase::done; }
  /// One cycle further. Ends when it stands, or when it lies again.
  void step(const Percepts& percepts, const Posture& posture, Pose& pose);

 private:
  enum class Phase { prepare, pike, fold, squat, rise, done };
  void enter(Phase phase, const Pose& pose);
  void blend(double seconds, Pose& pose) const;
  void squat(double lean, double rate, Pose& pose);

  const RecoveryTuning& tuning_;
  Phase phase_ = Phase::done;
  double pace_ = 1, time_ = 0, settled_ = 0;  ///< s in this phase; in which the squat has been steady
  Pose from_{}, to_{}, stance_{};
};

}  // namespace humanoid
