#pragma once

#include <optional>

#include "game_state_aspect.h"

namespace spark {

namespace soccer {

/// An effector whose action on the ball begins in this cycle.
class IBallAction {
 public:
  enum class Kind { kick, catching };
  virtual ~IBallAction() = default;
  virtual Kind kind() const = 0;
  /// The player, if the action would take effect where player and ball are now; otherwise nullptr.
  virtual const Player* reaches() = 0;
};

}  // namespace soccer

/// The state of the ball in this cycle: touches, on the field or not, in a goal or not. Runs after game state and
/// before the rules.
///
/// Lines and goals are judged on the ball's path, the straight line between its positions in two cycles: a fast ball
/// moves by several times its diameter in between, and near a corner its position alone does not say which line it
/// crossed first. A ball that a trainer or a script has placed moves on from there.
class BallStateAspect : public SoccerControlAspect {
  SPARK_CLASS(BallStateAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  /// Contacts of an agent with shorter gaps [s] are one touch, as in the installed base.
  static constexpr double kContactGap = 0.1;
  /// At most this number of players touch the ball in a cycle; there is no room around it for more.
  static constexpr std::size_t kMaxRivals = 64;

  /// The lines around the field.
  enum class Line { goal, touch };

  /// A touch of the ball.
  struct Touch {
    int agent = 0;           ///< the agent's number; 0: there was no touch yet
    Side side = Side::none;  ///< the player's team
    int unum = 0;            ///< the player's number
    double time = 0;         ///< simulated time of the last contact [s]
  };

  BallStateAspect() {
    kickers_.reserve(kMaxRivals);
    rivals_.reserve(kMaxRivals);
    actions_.reserve(kMaxRivals);
  }
  static void describe(Description<BallStateAspect>& d);
  void rule(const Event& event) override;
  /// Disabled: there are no touches and no goals; the ball's position is not updated.
  void rest(const Event& event) override;

  /// Reports that a kick effector of `agent` acts on the ball: this counts as a touch in this cycle.
  void kickedBy(const AgentAspect& agent) {
    if (kickers_.size() < kickers_.capacity()) kickers_.push_back(agent.number());
  }
  /// Announces an action of this cycle, in the act phase. `effector`: the node that `action` is part of.
  void announce(Leaf& effector, soccer::IBallAction& action) {
    if (actions_.size() < actions_.capacity()) actions_.push_back({Ref<Leaf>(&effector), &action});
  }
  /// True if actions of this kind take effect in this cycle, in the prepare phase. A goalie that catches and a player
  /// that kicks exclude each other: the nearer one acts; of those that are as near, a draw decides.
  bool mayAct(soccer::IBallAction::Kind kind);
  /// True when a player touches the ball in this cycle.
  bool touched() const { return touched_; }
  /// True when a player of `side` touches the ball in this cycle, as first player or not.
  bool touchedBy(Side side) const { return side != Side::none && touchedBy_[side == Side::right]; }
  /// True when the touch of this cycle is not the continued contact of the same agent.
  bool newTouch() const { return touched_ && newTouch_; }
  /// The last touch of the match; `agent` is 0 before the first.
  const Touch& last() const { return last_; }
  /// True when the ball's centre is on the field, its radius beyond the goal and touch lines included.
  bool onField() const { return onField_; }
  /// The ball's last position on the field [m].
  const Vec3& lastValid() const { return lastValid_; }
  /// The line that a ball that is not on the field crossed first.
  Line crossedLine() const;
  /// The side that defends the goal that the ball is in; none: it is in no goal.
  Side inGoalOf() const { return inGoal_; }
  /// The ball's position in this cycle [m].
  const Vec3& position() const { return position_; }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  /// True if a ball whose centre is there is on the field, lines included.
  bool isOnField(const Vec3& p) const { return std::abs(p.x()) < maxX_ && std::abs(p.y()) < maxY_; }
  /// Finds the ball's position, and where its path of this cycle began.
  void followBall(const soccer::Pitch& pitch, double step);
  void findTouch(soccer::Pitch& pitch, double step);
  /// The player whose touch counts in this cycle: the nearest of `rivals_`; nullptr: there is none.
  const soccer::Player* decideTouch(soccer::Pitch& pitch, double step);
  void addRival(const soccer::Player* player);
  /// The kind that takes effect; nullopt: all do.
  std::optional<soccer::IBallAction::Kind> decideActions();
  /// Forgets the actions of the cycle.
  void endActions() {
    actions_.clear();
    isDecided_ = false;
  }
  void findGoal(const soccer::Pitch& pitch);
  std::string lastTeam() const { return soccer::sideName(last_.side); }
  int lastUnum() const { return last_.unum; }

  struct Announced {
    Ref<Leaf> effector;
    soccer::IBallAction* action;
  };
  std::vector<Announced> actions_;                   ///< of this cycle; empty between cycles
  bool isDecided_ = false;                           ///< `acting_` is of this cycle
  std::optional<soccer::IBallAction::Kind> acting_;  ///< see decideActions()
  std::vector<int> kickers_;  ///< numbers of the agents that kick in this cycle; empty between cycles
  bool touched_ = false, newTouch_ = false, onField_ = true;
  std::array<bool, 2> touchedBy_{};  ///< left, right
  std::int64_t swapsSeen_ = 0;       ///< GameStateAspect::sideSwaps()
  Touch last_;
  Side inGoal_ = Side::none;
  Vec3 position_ = Vec3::Zero(), lastValid_ = Vec3::Zero();
  Vec3 from_ = Vec3::Zero();                   ///< the last position on the ball's path that is on the field [m]
  bool placed_ = false;                        ///< the ball is where something placed it, off the field
  double maxX_ = HUGE_VAL, maxY_ = HUGE_VAL;   ///< limits of the centre of a ball on the field [m]
  std::vector<const soccer::Player*> rivals_;  ///< players that touch the ball in this cycle
};

}  // namespace spark
