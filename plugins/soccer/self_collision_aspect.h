#pragma once

#include "api/robot_parts.h"
#include "box_overlap.h"
#include "foul_aspect.h"

namespace spark {

/// A robot's boxes may not overlap by more than SelfCollisionsTolerance. The effectors that the boxes' limbs name are
/// frozen for SelfCollisionJointFrozenTime, and then spared for SelfCollisionJointThawTime; or, with
/// SelfCollisionBeamPenalty, the player is sent off. Of two boxes the later one in the tree may name the earlier one
/// (addNotCollideWithColliderName): they are not compared. All others are, neighbours at a joint and parts of one body
/// too.
class SelfCollisionAspect : public FoulAspect {
  SPARK_CLASS(SelfCollisionAspect, FoulAspect)
 public:
  static void describe(Description<SelfCollisionAspect>& d) {
    d.doc(
        "A robot that runs into itself has its joints frozen, or is sent off; off with Soccer.FoulOnSelfCollisions "
        "false.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static constexpr double kLongAgo = -1e9;  ///< s
  static constexpr float kRounding = 1.001F;
  struct Box {
    IRobotBox* box;
    soccer::SingleBox now;  ///< in this cycle
    Vec3f half;             ///< of its edges [m]
    std::vector<int> limb;  ///< joints that it freezes
  };
  struct Pair {
    int a, b;
    float reachSquared;  ///< m^2: boxes whose centres are farther apart cannot overlap
  };
  struct Joint {
    IFreezable* effector;
    bool frozen = false;
    double since = kLongAgo;  ///< s of the clock of play: when it was frozen last
  };
  struct Robot {
    int agent = 0;                ///< its number
    std::uint64_t changedAt = 0;  ///< the agent's, when it was looked at
    std::vector<Box> boxes;
    std::vector<Pair> pairs;
    std::vector<Joint> joints;
    double sentOff = kLongAgo;  ///< s of the clock of play
  };

  void lookUp();
  Robot dissect(const soccer::Player& player) const;
  static void keepClocks(const Robot& from, Robot& to);
  void thaw(Robot& robot, double now);
  void judgeRobot(std::size_t player, double now);
  bool overlap(const Robot& robot, const Pair& pair) const;
  bool freeze(Robot& robot, const Box& box, double now);
  void tell(const soccer::Player& player, const Box& a, const Box& b, double now);

  TreeWatch tree_;
  std::vector<Robot> robots_;  ///< by index of the player
};

}  // namespace spark
