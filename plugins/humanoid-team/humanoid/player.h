#pragma once
/// \file
/// The program of a humanoid player: turns sense messages into actions.

#include <string>

#include "get_up.h"
#include "joint_drive.h"
#include "localisation.h"
#include "tactics.h"
#include "walk.h"

namespace humanoid {

/// Controls one Nao. Independent of the transport and deterministic: the same messages give the same answers.
class HumanoidPlayer {
 public:
  /// `unum`: 1..11, number 1 is the goalie; `type`: robot type 0..4.
  HumanoidPlayer(std::string team, int unum, int type);
  HumanoidPlayer(const HumanoidPlayer&) = delete;

  /// Appends the first message, which loads the robot.
  void start(spark::Predicates& actions) const;
  /// Call it for every sense message. Appends the answer, without `(syn)`.
  void think(const spark::Predicates& message, spark::Predicates& actions);

  /// Uniform number.
  int unum() const { return unum_; }
  /// Percepts and estimates as of the last message.
  const Percepts& percepts() const { return percepts_; }
  const Localisation& localisation() const { return localisation_; }
  const Posture& posture() const { return posture_; }
  /// Estimated position of the ball in the team's frame [m].
  const Vec2& ball() const { return ball_; }
  /// The current task.
  Task task() const { return task_; }
  /// All that it remembers, as state.
  template <class F>
  void fields(F& f) {
    bool rises = getUp_.playing();
    f(team_, unum_, percepts_, posture_, localisation_, drive_, walk_, getUp_, rises, risesFrom_, fell_, pose_, task_);
    f(walking_, attempts_, roseAt_, triedAt_, uprightAt_, footAt_, initAt_, beamAt_, lyingSince_, pausedSince_);
    f(ballFromHere_, ball_, ballAt_, mates_, others_, restart_, barredSince_);
    getUp_.resume(rises ? &movementOf(type_, risesFrom_) : nullptr);
  }

 private:
  /// The last message of a team-mate.
  struct Mate {
    double heardAt = -10, toBall = 1e9;  ///< time of the message [s]; length of its path to the ball [m]
    template <class F>
    void fields(F& f) {
      f(heardAt, toBall);
    }
  };

  /// An observed player.
  struct Other {
    std::string team;
    int unum;
    double seenAt;  ///< time of the observation [s]
    Vec2 place;     ///< team's frame [m]
    template <class F>
    void fields(F& f) {
      f(team, unum, seenAt, place);
    }
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
  void noticeSide();
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
  Lying risesFrom_ = Lying::no;  ///< the side of the movement that getUp_ plays, or played last
  Lying fell_ = Lying::no;       ///< the side on which it lay when it started to get up
  Pose pose_{};
  Task task_ = Task::stand;
  bool walking_ = false;
  int attempts_ = 0;                       ///< consecutive attempts to get up
  double roseAt_ = -100, triedAt_ = -100;  ///< when it last stood up and last started to get up [s]
  double uprightAt_ = 0, footAt_ = 0;      ///< when it was last upright, and last had a foot on the ground [s]
  double initAt_ = -10, beamAt_ = -10, lyingSince_ = -1, pausedSince_ = -1;  ///< s
  Vec2 ballFromHere_ = Vec2::Zero();  ///< position of the ball relative to the robot, x to its right, y forward [m]
  Vec2 ball_ = Vec2::Zero();          ///< in the team's frame [m]
  double ballAt_ = -100;              ///< when the ball was last seen or reported [s]
  std::array<Mate, 12> mates_;
  std::vector<Other> others_;
  bool restart_ = false;     ///< the mode of the last message was a restart of the own team
  double barredSince_ = -1;  ///< when it took a restart, until another player touches the ball [s]; -1: it may play
};

}  // namespace humanoid
