#pragma once

#include "soccer_rule.h"

namespace spark {

/// BeforeKickOff: keeps the ball at the centre and the teams in their halves.
class BeforeKickOffRule : public SoccerRule {
  SPARK_CLASS(BeforeKickOffRule, SoccerRule)
 public:
  static void describe(Description<BeforeKickOffRule>& d) {
    d.doc("Before the kick-off: keeps the ball at the centre and the teams in their halves.");
  }

 private:
  void judge(const Event&) override;
};

/// KickOff_X: keeps the opponents away from the ball; the first touch starts play. The team that kicked off may not
/// score until an opponent has touched the ball, or one of its own players has touched it outside of the centre circle.
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
