#pragma once

#include <span>
#include <vector>

#include "last_kick.h"

namespace spark {

class PassModeRule;

/// The referee: the state that the rules of play share. It follows BallStateAspect and creates the rules below itself,
/// each a control aspect of its own that the config can set or disable (soccer_rule.h). They judge in this order:
///
///     SoccerRuleAspect         the mode of this cycle, position and taker of the restart
///       BeforeKickOffRule      BeforeKickOff
///       KickOffRule            KickOff_X -> PlayOn
///       RestartRule            KickIn_X, corner_kick_X, free_kick_X, direct_free_kick_X -> PlayOn
///       GoalKickRule           goal_kick_X -> PlayOn
///       PassModeRule           pass_X -> PlayOn; the ban on scoring after it
///       DoubleTouchRule        PlayOn, pass_X -> free_kick_X
///       GoalRule               PlayOn, pass_X -> Goal_X, goal_kick_X, corner_kick_X; Goal_X -> KickOff_X
///       PenaltyShootoutRule    PlayOn -> Goal_Left, with Soccer.PenaltyShootout
///       BallOutRule            PlayOn, pass_X -> goal_kick_X, corner_kick_X, KickIn_X
///       DropBallRule           KickOff_X and all restarts -> PlayOn
///
/// A mode that a rule starts is judged from the next cycle on, a mode that a trainer sets in the same cycle.
class SoccerRuleAspect : public SoccerControlAspect {
  SPARK_CLASS(SoccerRuleAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;

  /// A foul as monitors get it.
  struct Foul {
    std::int64_t index = 0;  ///< counts from 1
    int type = 0;            ///< soccer::Foul
    Side side = Side::none;
    int unum = 0;
  };

  static void describe(Description<SoccerRuleAspect>& d);
  void rule(const Event& event) override;
  /// Disabled: neither rules of play nor fouls are judged.
  void rest(const Event&) override { ready_ = false; }

  // For the rules of this cycle.

  /// False when there is no ball, no settings or another aspect is missing. None of the accessors may be called then.
  bool ready() const { return ready_; }
  GameStateAspect& game() const { return *game_; }
  BallStateAspect& ball() const { return *ball_; }
  soccer::Pitch& pitch() const { return game_->pitch(); }
  const SoccerSettings& settings() const { return pitch().settings(); }
  /// The rule of pass mode; nullptr if there is none.
  PassModeRule* passMode() const { return passMode_.get(); }
  /// The mode at the start of this cycle.
  PlayMode mode() const { return mode_; }
  /// True when no rule has ended that mode yet.
  bool holds() const { return game_->mode() == mode_; }
  /// True when the ball is in play: PlayOn or pass mode, at the start of the cycle and now.
  bool playing() const { return isPlay(mode_) && isPlay(game_->mode()); }
  /// True when double touches and goals directly from restarts are judged: not with two agents or fewer, nor in a
  /// penalty shoot-out, as in the installed base.
  bool restricted() const { return pitch().players().size() > 2 && !settings().penaltyShootout; }

  // Restarts.

  /// Starts the mode of a restart at `position` [m].
  void award(PlayMode mode, const Vec3& position);
  void awardGoalKick(Side side) { award(forSide(PlayMode::goalKickLeft, side), goalKickPosition(side)); }
  void awardCorner(Side side) { award(forSide(PlayMode::cornerKickLeft, side), cornerPosition(opponent(side))); }
  void awardFreeKick(Side side) { award(forSide(PlayMode::freeKickLeft, side), freeKickPosition()); }
  /// Position of the current or last restart [m].
  const Vec3& kickPosition() const { return kickPosition_; }
  /// The restart is taken by the touch of this cycle; starts PlayOn.
  void taken(bool indirect);
  /// The taker of the last restart.
  soccer::LastKick& lastKick() { return lastKick_; }
  /// The team that has kicked off and may not score yet; none: no restriction.
  Side kickOffSide() const { return kickOffSide_; }
  void setKickOffSide(Side side) { kickOffSide_ = side; }
  /// Drops the ball at `position` [m], or at the front corner of the penalty area that this is in; moves both teams
  /// away from it and starts PlayOn.
  void dropBall(const Vec3& position);

  // Fouls.

  /// Reports a foul to monitors. `type`: soccer::Foul; `team`: left, right or none.
  void reportFoul(int type, const std::string& team, int unum);
  /// The last fouls (at most 64), oldest first.
  std::span<const Foul> fouls() const { return fouls_; }

 protected:
  void onLink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static bool isPlay(PlayMode m) {
    return m == PlayMode::playOn || m == PlayMode::passLeft || m == PlayMode::passRight;
  }
  /// True when the match is complete: see ready().
  bool findMatch();
  void enterMode();
  // Positions of the installed base for restarts [m].
  Vec3 positionFor(PlayMode mode) const;
  Vec3 freeKickPosition() const;
  Vec3 goalKickPosition(Side side) const;
  Vec3 cornerPosition(Side defending) const;
  Vec3 kickInPosition() const;

  Link<PassModeRule, true> passMode_;
  bool ready_ = false;

  PlayMode mode_ = PlayMode::beforeKickOff;
  std::int64_t modeSeen_ = 0, positionGivenAt_ = -1;  ///< counts of mode changes
  Vec3 kickPosition_ = Vec3::Zero();
  soccer::LastKick lastKick_;
  Side kickOffSide_ = Side::none;
  std::vector<Foul> fouls_;
  std::int64_t foulCount_ = 0;
};

/// The class of the SPL server: accepted, with the same rules.
class SPLRule : public SoccerRuleAspect {
  SPARK_CLASS(SPLRule, SoccerRuleAspect)
 public:
  static void describe(Description<SPLRule>& d) { d.doc("Accepted for SPL configs; the same as SoccerRuleAspect."); }
};

}  // namespace spark
