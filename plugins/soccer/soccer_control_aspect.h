#pragma once

#include "api/agents.h"
#include "pitch.h"

namespace spark {

class BallStateAspect;
class GameStateAspect;
class SoccerRuleAspect;

/// Base of the rules of soccer: finds the match and says what is missing.
class SoccerControlAspect : public ControlAspect {
  SPARK_CLASS(SoccerControlAspect, ControlAspect)
 public:
  static void describe(Description<SoccerControlAspect>& d);

 protected:
  void onLink() override { kernel().root().require<SoccerSettings>(); }

  /// The aspects beside it that hold the match; empty where the config has none.
  Link<GameStateAspect, true> game_;
  Link<BallStateAspect, true> ball_;
  Link<SoccerRuleAspect, true> referee_;
};

}  // namespace spark
