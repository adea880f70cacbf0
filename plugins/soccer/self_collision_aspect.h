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
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static constexpr double kLongAgo = -1e9;    ///< s
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
  struct Joint {
    IFreezable* effector;
    bool frozen = false;
    double frozenAt = kLongAgo;  ///< time of play when it was last frozen [s]
  };
  struct Robot {
    int agent = 0;                ///< the agent's number
    std::uint64_t changedAt = 0;  ///< the agent's changedAt() when its parts were looked up
    std::vector<Box> boxes;
    std::vector<Pair> pairs;
    std::vector<Joint> joints;
    double sentOffAt = kLongAgo;  ///< time of play [s]
  };

  void lookUp();
  static Robot makeRobot(const soccer::Player& player);
  /// Copies the times of a robot to its new version. Joints that were added come after the old ones.
  static void copyTimes(const Robot& from, Robot& to);
  /// Releases joints that have been frozen for long enough.
  void thaw(Robot& robot, double now);
  void judgeRobot(std::size_t player, double now);
  bool overlap(const Robot& robot, const Pair& pair) const;
  /// Freezes the joints of a box. True when one of them was neither frozen nor immune. Without FoulOnSelfCollisions the
  /// times are recorded, but no joint is frozen.
  bool freeze(Robot& robot, const Box& box, double now);
  /// Logs a self-collision, or writes it to the file.
  void record(const soccer::Player& player, const Box& a, const Box& b, double now);

  TreeWatch tree_;
  std::vector<Robot> robots_;  ///< by index of the player
};

}  // namespace spark
