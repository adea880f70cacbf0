#include "spark/plugin.h"

#include "api/modifier.h"
#include "gamecontrol/agent_timing.h"
#include "gamecontrol/disqualify_effector.h"
#include "gamecontrol/game_control.h"
#include "gamecontrol/judges.h"
#include "gamecontrol/request_effector.h"
#include "gamecontrol/scene_effector.h"
#include "gamecontrol/script_aspect.h"
#include "gamecontrol/script_behavior.h"
#include "gamecontrol/script_effector.h"
#include "gamecontrol/script_perceptor.h"

SPARK_PLUGIN("gamecontrol", "1.0",
             "Agents: their connections and behaviours, effectors, perceptors, and the rules' base.",
             spark::GameControl, spark::AgentTiming, spark::AgentLatency, spark::AgentAspect, spark::Perceptor,
             spark::Effector, spark::ControlAspect, spark::Behavior, spark::Modifier, spark::NumberModifier,
             spark::SceneEffector, spark::RequestEffector, spark::RequestPerceptor, spark::RequestAspect,
             spark::ActionLimitAspect, spark::DisqualifyEffector, spark::ScriptBehavior, spark::ScriptPerceptor,
             spark::ScriptEffector, spark::ScriptAspect)
