#pragma once

#include "soccer_rule.h"

namespace spark {

/// BeforeKickOff: the ball is held at the centre, teams stay in their halves.
class BeforeKickOffRule : public SoccerRule {
  SPARK_CLASS(BeforeKickOffRule, SoccerRule)
 public:
  static void describe(Description<BeforeKickOffRule>& d) {
    d.doc("Before the kick-off: the ball is held, teams stay in their halves.");
  }

 private:
  void judge(const Event&) override;
};

/// KickOff_X: the others stay away from the ball; the first touch starts the play. The team that kicked off may not
/// score before an opponent touched the ball, or one of its own outside of the centre circle.
class KickOffRule : public SoccerRule {
  SPARK_CLASS(KickOffRule, SoccerRule)
 public:
  static void describe(Description<KickOffRule>& d) {
    d.doc("The kick-off: where players may stand, the first touch, and the right to score.");
  }

 private:
  void judge(const Event&) override;
  void earnRightToScore();
};

}  // namespace spark
