#pragma once

#include <array>

#include "soccer_rule_aspect.h"

namespace spark {

/// Offside, as a rule of its own: one line of the config adds it.
///
/// At each new touch in PlayOn the toucher's team-mates in an offside position are marked: in the opponents' half,
/// nearer to their goal line than the ball and than the second-last opponent. A marked player's touch before an
/// opponent's gives offside_X (X: his side), and after the restart's pause the opponents have a free kick at that spot.
class OffsideAspect : public SoccerControlAspect {
  SPARK_CLASS(OffsideAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  static void describe(Description<OffsideAspect>& d) {
    d.doc("Offside. Its presence below game control switches the rule on, `enabled` off and on during a match.");
    d.property("marked", &OffsideAspect::markedUnums)
        .doc("Numbers of the marked players; they are of the team that touched the ball last.");
  }
  void rule(const Event& event) override;
  /// Switched off, nobody is marked; an offside that was called is still taken to its free kick.
  void rest(const Event& event) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  /// What both rule() and rest() begin with: false when there is nothing to judge.
  bool inPlay();
  void touch(soccer::Pitch& pitch);
  void mark(const soccer::Pitch& pitch, Side side, int toucher);
  std::vector<int> markedUnums() const;

  std::array<bool, GameStateAspect::kTeamSize + 1> marked_{};  ///< by number
  Side markedSide_ = Side::none;
  Vec3 spot_ = Vec3::Zero();
};

}  // namespace spark
