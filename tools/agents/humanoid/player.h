#pragma once
/// \file
/// A humanoid player: sense messages in, actions out.

#include <string>

#include "get_up.h"
#include "joint_drive.h"
#include "localisation.h"
#include "tactics.h"
#include "walk.h"

namespace humanoid {

/// Plays one Nao. Knows nothing of sockets; deterministic: the same messages give the same answers. One object plays
/// one agent.
class HumanoidPlayer {
 public:
  /// `unum`: 1..11, number 1 keeps the goal; `type`: robot type 0..4.
  HumanoidPlayer(std::string team, int unum, int type);
  HumanoidPlayer(const HumanoidPlayer&) = delete;

  /// The first message, once connected: asks for the robot.
  void start(spark::Predicates& actions) const;
  /// To be called for every sense message; appends the answer (without `(syn)`, which is the caller's).
  void think(const spark::Predicates& message, spark::Predicates& actions);

  int unum() const { return unum_; }
  const Percepts& percepts() const { return percepts_; }
  const Localisation& localisation() const { return localisation_; }
  const Posture& posture() const { return posture_; }
  /// The ball's place on the field, as far as it knows [m].
  const Vec2& ball() const { return ball_; }
  Task task() const { return task_; }

 private:
  /// A team-mate, as he told.
  struct Mate {
    double heardAt = -10, toBall = 1e9;  ///< s, m
  };

  /// Another player where he was seen.
  struct Other {
    std::string team;
    int unum;
    double seenAt;  ///< s
    Vec2 place;     ///< on the field [m]
  };

  void sense(const spark::Predicates& message);
  void senseBall();
  void senseOthers();
  void hear();
  void watchRestart();
  std::vector<Vec2> inTheWay(double nearBall) const;
  Lying lying() const;
  Situation situation() const;
  Decision decideNow() const;
  void act(const Decision& decision, spark::Predicates& actions);
  void takePlace(const Vec2& place, spark::Predicates& actions);
  void getUp();
  void walk(const Velocity& velocity);
  void rise();
  void standStill();
  void settle();
  void look();
  void say(spark::Predicates& actions) const;
  double toBall() const;

  std::string team_;
  int unum_, type_;
  const Build& build_;
  Percepts percepts_;
  Posture posture_;
  Localisation localisation_;
  JointDrive drive_;
  const Gait& gait_;
  Walk walk_;
  GetUp getUp_;
  Lying fell_ = Lying::no;  ///< how he lay when he began to get up
  Pose pose_{};
  Task task_ = Task::stand;
  bool walking_ = false;
  int attempts_ = 0;                       ///< to get up, one soon after the other
  double roseAt_ = -100, triedAt_ = -100;  ///< s, when he stood up, and began to get up
  double uprightAt_ = 0, footAt_ = 0;      ///< s, when he was upright, and had a foot on the ground, last
  double initAt_ = -10, beamAt_ = -10, lyingSince_ = -1, pausedSince_ = -1;  ///< s
  Vec2 ballFromHere_ = Vec2::Zero();  ///< the ball from the robot, x to its right, y forward [m]
  Vec2 ball_ = Vec2::Zero();          ///< on the field [m]
  double ballAt_ = -100;              ///< s, when it was last seen or told of
  std::array<Mate, 12> mates_;
  std::vector<Other> others_;
  bool restart_ = false;     ///< the last message told of a restart of ours
  double barredSince_ = -1;  ///< s, when he took a restart that nobody has touched since; -1: he may play
};

}  // namespace humanoid
