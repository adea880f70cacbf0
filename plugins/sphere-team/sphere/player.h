#pragma once
/// \file
/// The program of a sphere player: turns percepts into actions. The behaviour node (`SphereBehavior`) and the external
/// demo team both use it.

#include <string>
#include <vector>

#include "spark/predicates.h"

namespace spark {

/// Plays 2004-style soccer with a sphere: runs to the ball, kicks at the goal, keeps the goal with number 1, does not
/// crowd, keeps away at the opponents' restarts. Deterministic: the same percepts give the same actions. One object
/// plays one agent; not thread safe.
class SpherePlayer {
 public:
  /// `team`: the team's name; `unum`: 1..11, number 1 is the goalie.
  SpherePlayer(std::string team, int unum);
  /// Sets the scene file of the robot, before start(). Default "rsg/agent/sphere.rsg".
  void setScene(std::string scene) { scene_ = std::move(scene); }
  /// Appends the first message: `(scene ...)`.
  void start(Predicates& actions);
  /// Call it for every sense message. Appends the answer, without `(syn)`.
  void think(const Predicates& percepts, Predicates& actions);

  /// "left", "right", or "" before init.
  const std::string& side() const { return side_; }
  int unum() const { return unum_; }
  const std::string& playMode() const { return playMode_; }
  /// Goals of the own team and of the other.
  int ownScore() const { return side_ == "right" ? right_ : left_; }
  int otherScore() const { return side_ == "right" ? left_ : right_; }
  /// Simulated time of the last sense message [s].
  double time() const { return now_; }
  /// All that it remembers, as state.
  template <class F>
  void fields(F& f) {
    f(team_, scene_, side_, playMode_, unum_, left_, right_, seesField_, seesBall_, placed_, now_, joinedAt_,
      ballTime_);
    f(fieldTime_, modeSince_, caughtAt_, halfLength_, halfWidth_, goalHalfWidth_, self_, ball_, toBall_, ballVelocity_);
    f(driven_, velocity_, taker_, takerUntil_, others_);
  }

 private:
  /// A point or vector in the team's frame: opponents' goal at +x, y to the left [m].
  struct Point {
    double x = 0, y = 0;
    template <class F>
    void fields(F& f) {
      f(x, y);
    }
    Point operator+(Point o) const { return {x + o.x, y + o.y}; }
    Point operator-(Point o) const { return {x - o.x, y - o.y}; }
    Point operator*(double k) const { return {x * k, y * k}; }
    double length() const;
    Point unit() const;
    double dot(Point o) const { return x * o.x + y * o.y; }
  };
  /// Another player.
  struct Other {
    bool mate = false;
    int unum = 0;
    Point place;
    template <class F>
    void fields(F& f) {
      f(mate, unum, place);
    }
  };

  /// A kick; `to`: number of the team-mate that it is for, 0: none.
  struct Kick {
    Point target;
    double speed = 0, elevationDeg = 0;
    int to = 0;
  };

  void read(const Predicates& percepts);
  void readGameState(const Element& gs);
  void readVision(const Element& see);
  void readField(const Element& see);
  void noteRestart(const std::string& before);
  void join(Predicates& actions);
  void takePlaces(Predicates& actions);
  void play(Predicates& actions);
  void keepGoal(Predicates& actions);
  void attack(Predicates& actions);
  void kickTowards(Point target, double speed, double elevationDeg, Predicates& actions);
  void runTo(Point target, double speed, Predicates& actions);
  bool goesToBall() const;
  bool ours(std::string_view kind) const;
  bool theirs() const;
  Point formation() const;
  Point ballSoon(double seconds) const { return ball_ + ballVelocity_ * seconds; }
  double offsideLine() const;
  double wayIsFree(Point from, Point to) const;
  double keeperY() const;
  Point kickWay(Point target, double speed) const;

  std::string team_, scene_ = "rsg/agent/sphere.rsg", side_, playMode_ = "BeforeKickOff";
  int unum_, left_ = 0, right_ = 0;
  bool seesField_ = false, seesBall_ = false, placed_ = false;
  double now_ = 0, joinedAt_ = -1, ballTime_ = 0, fieldTime_ = 0, modeSince_ = 0, caughtAt_ = -10;
  double halfLength_ = 52, halfWidth_ = 34, goalHalfWidth_ = 3.66;
  Point self_, ball_, toBall_, ballVelocity_;
  Point driven_, velocity_;  ///< commanded and estimated own velocity [m/s]
  int taker_ = 0;            ///< number of the player that took the team's last restart
  double takerUntil_ = -1;   ///< until then it leaves the ball to others [s]
  std::vector<Other> others_;
};

}  // namespace spark
