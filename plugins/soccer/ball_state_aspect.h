#pragma once

#include "game_state_aspect.h"

namespace spark {

/// What happened to the ball in this cycle: who touched it, whether it is on the field, whether it is in a goal. Runs
/// after game state and before the rules.
class BallStateAspect : public SoccerControlAspect {
  SPARK_CLASS(BallStateAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  /// s: contacts with shorter gaps are one touch.
  static constexpr double kContactGap = 0.1;

  /// A touch of the ball.
  struct Touch {
    int agent = 0;  ///< the agent's number, 0: none yet
    Side side = Side::none;
    int unum = 0;
    double time = 0;  ///< s of the simulated clock, of the last contact
  };

  static void describe(Description<BallStateAspect>& d);
  void rule(const Event& event) override;
  /// Switched off, nobody touches the ball, and it is nowhere but where it was.
  void rest(const Event& event) override;

  /// A kick acts on the ball: its agent touches it in this cycle. The first of a cycle counts.
  void kickedBy(const AgentAspect& agent) {
    if (kicker_ == 0) kicker_ = agent.number();
  }
  /// Somebody touches the ball in this cycle.
  bool touched() const { return touched_; }
  /// A player of that team touches the ball in this cycle, first or not.
  bool touchedBy(Side side) const { return side != Side::none && touchedBy_[side == Side::right]; }
  /// That touch is a new one: not the continued contact of the same agent.
  bool newTouch() const { return touched_ && fresh_; }
  /// The last touch of the match; `agent` 0 when nobody ever touched it.
  const Touch& last() const { return last_; }
  /// In the field, goal lines and touch lines with the ball's radius included.
  bool onField() const { return onField_; }
  /// Where it was last on the field.
  const Vec3& lastValid() const { return lastValid_; }
  /// The side whose goal it is in, none when it is in no goal.
  Side inGoalOf() const { return inGoal_; }
  const Vec3& position() const { return position_; }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void findTouch(const soccer::Pitch& pitch);
  void note(const soccer::Player* toucher, const soccer::Player*& first);
  void findGoal(const soccer::Pitch& pitch);
  std::string lastTeam() const { return soccer::sideName(last_.side); }
  int lastUnum() const { return last_.unum; }

  int kicker_ = 0;
  bool touched_ = false, fresh_ = false, onField_ = true;
  std::array<bool, 2> touchedBy_{};  ///< left, right
  std::int64_t swapsSeen_ = 0;
  Touch last_;
  Side inGoal_ = Side::none;
  Vec3 position_ = Vec3::Zero(), lastValid_ = Vec3::Zero();
};

}  // namespace spark
