#pragma once

#include "api/robot_parts.h"
#include "box_overlap.h"
#include "foul_aspect.h"

namespace spark {

/// Self-collision, as in the installed base: boxes of a robot overlap by more than SelfCollisionsTolerance. The
/// effectors that both boxes name are frozen for SelfCollisionJointFrozenTime and then immune for
/// SelfCollisionJointThawTime; with SelfCollisionBeamPenalty the player is sent off instead. A pair of boxes is
/// excluded if the one later in the tree names the earlier one (addNotCollideWithColliderName). All other pairs are
/// tested, also boxes that a joint connects or of the same body.
///
/// Its times are simulated times, whatever happens to the clock of play: it may be stopped, or set by a trainer. While
/// the clock of play runs they advance as it does, with its rounding, because recorded sessions depend on that.
class SelfCollisionAspect : public FoulAspect {
  SPARK_CLASS(SelfCollisionAspect, FoulAspect)
 public:
  static void describe(Description<SelfCollisionAspect>& d) {
    d.doc(
        "A robot whose parts collide has its joints frozen, or is sent off; off with Soccer.FoulOnSelfCollisions "
        "false.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override;
  void idle() override { release(); }
  void onUnlink() override { release(); }
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static constexpr double kNever = -1e9;      ///< of a Stopwatch [s]
  static constexpr float kRounding = 1.001F;  ///< factor for squared distances
  struct Box {
    IRobotBox* box;
    soccer::SingleBox current;  ///< in this cycle
    Vec3f half;                 ///< half edge lengths [m]
    std::vector<int> joints;    ///< indices of the joints that it freezes
  };
  struct Pair {
    int a, b;            ///< indices of boxes, a < b
    float reachSquared;  ///< boxes with centres farther apart cannot overlap [m^2]
  };
  /// Measures the simulated time since an event.
  struct Stopwatch {
    double elapsed = kNever;  ///< kNever: there was no event yet [s]
    void start() { elapsed = 0; }
    void advance(double step) {
      if (elapsed >= 0) elapsed += step;
    }
    /// True when the event was less than `seconds` ago. The tolerance is for sums of steps, and is finer than the clock
    /// of play.
    bool isWithin(double seconds) const { return elapsed >= 0 && elapsed < seconds - 1e-9; }
  };
  struct Joint {
    IFreezable* effector;
    Ref<Leaf> node;  ///< of the effector; empty when it was removed
    bool frozen = false;
    Stopwatch sinceFrozen;
  };
  struct Robot {
    int agent = 0;                ///< the agent's number
    std::uint64_t changedAt = 0;  ///< the agent's changedAt() when its parts were looked up
    std::vector<Box> boxes;
    std::vector<Pair> pairs;
    std::vector<Joint> joints;
    Stopwatch sinceSentOff;
  };

  void lookUp();
  static Robot makeRobot(const soccer::Player& player);
  /// Copies the times of a robot to its new version. Joints that were added come after the old ones.
  static void copyTimes(const Robot& from, Robot& to);
  /// Advances the times of a robot, and releases joints that have been frozen for long enough.
  void advance(Robot& robot, double step);
  /// Releases all joints and forgets when they were frozen.
  void release();
  static void thaw(Joint& joint);
  void judgeRobot(std::size_t player);
  bool overlap(const Robot& robot, const Pair& pair) const;
  /// Freezes the joints of a box. True when one of them was neither frozen nor immune. Without FoulOnSelfCollisions the
  /// times are recorded, but no joint is frozen.
  bool freeze(Robot& robot, const Box& box);
  /// Logs a self-collision, or writes it to the file.
  void record(const soccer::Player& player, const Box& a, const Box& b);

  TreeWatch tree_;
  std::vector<Robot> robots_;  ///< by index of the player
};

}  // namespace spark
