#pragma once

#include "game_state_aspect.h"

namespace spark {

/// The state of the ball in this cycle: touches, on the field or not, in a goal or not. Runs after game state and
/// before the rules.
class BallStateAspect : public SoccerControlAspect {
  SPARK_CLASS(BallStateAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  /// Contacts of an agent with shorter gaps [s] are one touch, as in the installed base.
  static constexpr double kContactGap = 0.1;

  /// A touch of the ball.
  struct Touch {
    int agent = 0;           ///< the agent's number; 0: there was no touch yet
    Side side = Side::none;  ///< the player's team
    int unum = 0;            ///< the player's number
    double time = 0;         ///< simulated time of the last contact [s]
  };

  static void describe(Description<BallStateAspect>& d);
  void rule(const Event& event) override;
  /// Disabled: there are no touches and no goals; the ball's position is not updated.
  void rest(const Event& event) override;

  /// Reports that a kick effector of `agent` acts on the ball: this counts as a touch in this cycle. Of several calls
  /// in a cycle the first counts.
  void kickedBy(const AgentAspect& agent) {
    if (kicker_ == 0) kicker_ = agent.number();
  }
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
  /// The side that defends the goal that the ball is in; none: it is in no goal.
  Side inGoalOf() const { return inGoal_; }
  /// The ball's position in this cycle [m].
  const Vec3& position() const { return position_; }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void findTouch(const soccer::Pitch& pitch);
  /// Counts a contact of `player`, unless it is nullptr or has no team; sets `first` when it is the first one.
  void addContact(const soccer::Player* player, const soccer::Player*& first);
  void findGoal(const soccer::Pitch& pitch);
  std::string lastTeam() const { return soccer::sideName(last_.side); }
  int lastUnum() const { return last_.unum; }

  int kicker_ = 0;  ///< number of the agent that kicks in this cycle; 0: none
  bool touched_ = false, newTouch_ = false, onField_ = true;
  std::array<bool, 2> touchedBy_{};  ///< left, right
  std::int64_t swapsSeen_ = 0;       ///< GameStateAspect::sideSwaps()
  Touch last_;
  Side inGoal_ = Side::none;
  Vec3 position_ = Vec3::Zero(), lastValid_ = Vec3::Zero();
};

}  // namespace spark
