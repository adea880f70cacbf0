#pragma once
/// \file
/// The brain of a sphere player: percepts in, actions out. It knows nothing of a host: the same source file is built into the
/// in-process behaviour (`SphereBehavior`) and into the external demo team.

#include <string>
#include <vector>

#include "spark/predicates.h"

namespace spark {

/// Plays 2004-style soccer with a sphere: runs to the ball, kicks at the goal, keeps the goal with number 1, does not crowd, keeps
/// away at the opponents' restarts. Deterministic: the same percepts give the same actions. One object plays one agent; not thread safe.
class SpherePlayer {
 public:
  /// `team`: the team's name; `unum`: 1..11, number 1 is the goalie.
  SpherePlayer(std::string team, int unum);
  /// Robot file that start() asks for; to be set before. Default "rsg/agent/sphere.rsg".
  void setScene(std::string scene) { scene_ = std::move(scene); }
  /// The first message, to be sent once when connected: `(scene ...)`.
  void start(Predicates& actions);
  /// To be called for every sense message; appends the reply (without `(syn)`: that is the caller's, in lockstep).
  void think(const Predicates& percepts, Predicates& actions);

  /// "left", "right", "" until the server has told.
  const std::string& side() const { return side_; }
  int unum() const { return unum_; }
  const std::string& playMode() const { return playMode_; }
  /// Goals of the own team and of the other.
  int ownScore() const { return side_ == "right" ? right_ : left_; }
  int otherScore() const { return side_ == "right" ? left_ : right_; }
  /// s, simulated time of the last sense message.
  double time() const { return now_; }

 private:
  /// A point on the field. Frame: own half at negative x, opponents' goal at +x, y to the left [m].
  struct Point {
    double x = 0, y = 0;
  };
  /// What was seen of somebody: offset from here in the server's field frame [m].
  struct Seen {
    bool mate = false;
    int unum = 0;
    Point offset;
  };

  void read(const Predicates& percepts);
  void readGameState(const Element& gs);
  void readVision(const Element& see);
  void locate(Point sum, int count);
  void beam(Predicates& actions) const;
  void play(Predicates& actions);
  void keepGoal(Predicates& actions);
  void runTo(Point target, Predicates& actions) const;
  void kickIfNear(Predicates& actions) const;
  Point formation() const;
  Point ballSoon() const;
  bool nearestOfTeam() const;
  bool mayTouch() const;

  std::string team_, scene_ = "rsg/agent/sphere.rsg", side_, playMode_ = "BeforeKickOff";
  int unum_, left_ = 0, right_ = 0, seenOwn_ = 0;
  bool initSent_ = false, located_ = false, ballSeen_ = false;
  double now_ = 0, ballTime_ = 0;
  Point self_, velocity_, ball_, ballVelocity_;
  double ballHeight_ = 0;
  std::vector<Seen> seen_;
};

}  // namespace spark
