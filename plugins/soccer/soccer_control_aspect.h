#pragma once

#include "api/agents.h"
#include "pitch.h"

namespace spark {

class BallStateAspect;
class GameStateAspect;
class SoccerRuleAspect;

/// Base of the control aspects of soccer: links them to each other. Linking throws Error when there are no
/// SoccerSettings.
class SoccerControlAspect : public ControlAspect {
  SPARK_CLASS(SoccerControlAspect, ControlAspect)
 public:
  static void describe(Description<SoccerControlAspect>& d);

 protected:
  void onLink() override { kernel().root().require<SoccerSettings>(); }

  /// The aspects of the match beside this one; empty when the config has none.
  Link<GameStateAspect, true> game_;
  Link<BallStateAspect, true> ball_;
  Link<SoccerRuleAspect, true> referee_;
};

}  // namespace spark
