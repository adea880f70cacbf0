#pragma once

#include <span>
#include <vector>

#include "last_kick.h"

namespace spark {

class PassModeRule;

/// The referee: what the rules of play share. It stands after ball state and makes the rules below itself, each a
/// control aspect of its own that the config may set or switch off (soccer_rule.h). Their order is the order of
/// judging:
///
///     SoccerRuleAspect         the mode of this cycle, where a restart is, who took it
///       BeforeKickOffRule      the ball is held, teams stay in their halves
///       KickOffRule            KickOff_X                                                               -> PlayOn
///       RestartRule            KickIn_X, corner_kick_X, free_kick_X, direct_free_kick_X                -> PlayOn
///       GoalKickRule           goal_kick_X                                                             -> PlayOn
///       PassModeRule           pass_X, and what pass mode costs                                        -> PlayOn
///       DoubleTouchRule        PlayOn, pass_X                                                          -> free_kick_X
///       GoalRule               PlayOn, pass_X -> Goal_X, goal_kick_X, corner_kick_X; Goal_X            -> KickOff_X
///       PenaltyShootoutRule    with Soccer.PenaltyShootout: the goalie left his area                   -> Goal_Left
///       BallOutRule            PlayOn, pass_X                                   -> goal_kick_X, corner_kick_X,
///       KickIn_X DropBallRule           a restart that nobody takes                                             ->
///       PlayOn
///
/// A mode that began in this cycle is judged from the next cycle on; one that a trainer set, in the same cycle.
class SoccerRuleAspect : public SoccerControlAspect {
  SPARK_CLASS(SoccerRuleAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;

  /// What monitors are told of a foul.
  struct Foul {
    std::int64_t index = 0;  ///< counts from 1
    int type = 0;            ///< protocol section 6.7
    Side side = Side::none;
    int unum = 0;
  };

  static void describe(Description<SoccerRuleAspect>& d);
  void rule(const Event& event) override;
  /// Switched off, no rule of play is judged, nor any foul.
  void rest(const Event&) override { ready_ = false; }

  // For the rules of this cycle.
  /// False: there is no field, or another aspect is missing. Nothing below may be called then.
  bool ready() const { return ready_; }
  GameStateAspect& game() const { return *game_; }
  BallStateAspect& ball() const { return *ball_; }
  soccer::Pitch& pitch() const { return game_->pitch(); }
  const SoccerSettings& settings() const { return pitch().settings(); }
  /// nullptr when there is no such rule.
  PassModeRule* passMode() const { return passMode_.get(); }
  /// The mode that this cycle began with.
  PlayMode mode() const { return mode_; }
  /// No rule has ended that mode yet.
  bool holds() const { return game_->mode() == mode_; }
  /// PlayOn or pass mode, and no rule has stopped it in this cycle.
  bool playing() const { return isPlay(mode_) && isPlay(game_->mode()); }
  /// With two agents at most, or in a shoot-out, a kick-off or free kick is not restricted.
  bool restricted() const { return pitch().players().size() > 2 && !settings().penaltyShootout; }

  // Restarts.
  /// A restart at `where`.
  void award(PlayMode mode, const Vec3& where);
  void awardGoalKick(Side side) { award(forSide(PlayMode::goalKickLeft, side), goalKickPosition(side)); }
  void awardCorner(Side side) { award(forSide(PlayMode::cornerKickLeft, side), cornerPosition(opponent(side))); }
  void awardFreeKick(Side side) { award(forSide(PlayMode::freeKickLeft, side), freeKickPosition()); }
  /// Where the current or last restart is taken.
  const Vec3& kickPosition() const { return kickPosition_; }
  /// The restart is taken by who touches the ball now; play goes on.
  void taken(bool indirect);
  soccer::LastKick& lastKick() { return lastKick_; }
  /// The team that kicked off and has not earned the right to score yet; none: no restriction.
  Side kickOffSide() const { return kickOffSide_; }
  void setKickOffSide(Side side) { kickOffSide_ = side; }
  /// The ball lies free at `where` (outside of penalty areas), both teams are cleared from it, play goes on.
  void dropBall(const Vec3& where);

  // Fouls.
  /// Tells monitors of a foul; `team` is left, right or none.
  void reportFoul(int type, std::string team, int unum);
  /// The last fouls, oldest first.
  std::span<const Foul> fouls() const { return fouls_; }

 protected:
  void onLink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static bool isPlay(PlayMode m) {
    return m == PlayMode::playOn || m == PlayMode::passLeft || m == PlayMode::passRight;
  }
  bool findMatch();
  void enterMode();
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

/// The SPL variant: accepted, plays by the same rules.
class SPLRule : public SoccerRuleAspect {
  SPARK_CLASS(SPLRule, SoccerRuleAspect)
 public:
  static void describe(Description<SPLRule>& d) { d.doc("Accepted for SPL configs; the same as SoccerRuleAspect."); }
};

}  // namespace spark
