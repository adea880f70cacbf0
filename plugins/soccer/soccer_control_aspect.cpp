#include "soccer_control_aspect.h"

#include "ball_state_aspect.h"
#include "game_state_aspect.h"
#include "soccer_rule_aspect.h"

namespace spark {

void SoccerControlAspect::describe(Description<SoccerControlAspect>& d) {
  d.doc("Base of the control aspects of soccer.");
  d.abstract();
  d.link(&SoccerControlAspect::game_, Beside<GameStateAspect>());
  d.link(&SoccerControlAspect::ball_, Beside<BallStateAspect>());
  d.link(&SoccerControlAspect::referee_, Beside<SoccerRuleAspect>());
}

}  // namespace spark
