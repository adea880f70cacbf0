#pragma once

#include <array>

#include "soccer_rule_aspect.h"

namespace spark {

/// Offside, a rule of its own that one line of the config adds. (The installed base has the play modes but no rule.)
///
/// At each new touch in PlayOn, team-mates of the player are marked if they are in an offside position: in the
/// opponents' half and nearer to the opponents' goal line than the ball and the second-last opponent. If a marked
/// player touches the ball before an opponent does, the mode becomes offside_X (X: its side). After RuleKickInPauseTime
/// the opponents have a free kick at that position.
class OffsideAspect : public SoccerControlAspect {
  SPARK_CLASS(OffsideAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  static void describe(Description<OffsideAspect>& d) {
    d.doc("Offside. Its presence below game control switches the rule on, `enabled` off and on during a match.");
    d.property("marked", &OffsideAspect::markedUnums)
        .doc("Numbers of the marked players, of the team that touched the ball last.");
  }
  void rule(const Event& event) override;
  /// Disabled: no player is marked. An offside that was called still leads to its free kick.
  void rest(const Event& event) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  /// Handles the pause of an offside. True in PlayOn, when there is something to judge.
  bool isInPlay();
  void judgeTouch(soccer::Pitch& pitch);
  /// Marks the players of `side` that are in an offside position, except number `toucher`.
  void mark(const soccer::Pitch& pitch, Side side, int toucher);
  std::vector<int> markedUnums() const;

  std::array<bool, GameStateAspect::kTeamSize + 1> marked_{};  ///< by uniform number
  Side markedSide_ = Side::none;
  Vec3 kickPosition_ = Vec3::Zero();  ///< of the free kick [m]
};

}  // namespace spark
