#include "agent_collision_handler.h"
#include "ball_holding_aspect.h"
#include "charging_foul_aspect.h"
#include "crowding_foul_aspect.h"
#include "field_effectors.h"
#include "goal_rules.h"
#include "illegal_defence_aspect.h"
#include "incapable_foul_aspect.h"
#include "init_effector.h"
#include "kick_effector.h"
#include "kick_off_rules.h"
#include "match_perceptors.h"
#include "monitor_items.h"
#include "offside_aspect.h"
#include "pass_effector.h"
#include "restart_rules.h"
#include "self_collision_aspect.h"
#include "spark/plugin.h"
#include "sphere_effectors.h"
#include "teamless_aspect.h"
#include "touching_foul_aspect.h"
#include "trainer_command_parser.h"
#include "vision_perceptor.h"

SPARK_PLUGIN("soccer", "1.0", "Soccer: field, rules, perceptors and effectors.",
             // the field
             spark::SoccerSettings, spark::Ball, spark::FieldFlag, spark::SoccerNode, spark::ObjectState,
             spark::GoalPost, spark::Line, spark::AgentState, spark::AgentCollisionHandler,
             // rules
             spark::SoccerControlAspect, spark::GameStateAspect, spark::BallStateAspect, spark::SoccerRuleAspect,
             spark::OffsideAspect, spark::SPLState, spark::SPLRule, spark::TeamlessAspect,
             // rules of play
             spark::SoccerRule, spark::BeforeKickOffRule, spark::KickOffRule, spark::SetPieceRule, spark::RestartRule,
             spark::GoalKickRule, spark::PassModeRule, spark::DoubleTouchRule, spark::GoalRule,
             spark::PenaltyShootoutRule, spark::BallOutRule, spark::DropBallRule,
             // fouls
             spark::PlayerContactAspect, spark::FoulAspect, spark::IncapableFoulAspect, spark::CrowdingFoulAspect,
             spark::IllegalDefenceAspect, spark::TouchingFoulAspect, spark::ChargingFoulAspect,
             spark::BallHoldingAspect, spark::SelfCollisionAspect, spark::PenaltyAspect,
             // perceptors
             spark::GameStatePerceptor, spark::HearPerceptor, spark::AgentStatePerceptor, spark::GameTimePerceptor,
             spark::VisionPerceptor, spark::RestrictedVisionPerceptor,
             // effectors
             spark::InitEffector, spark::SingleMatInitEffector, spark::StaticMeshInitEffector, spark::BeamEffector,
             spark::SayEffector, spark::PassEffector, spark::KickEffector, spark::DriveEffector, spark::CatchEffector,
             spark::PanTiltEffector,
             // monitors and trainers
             spark::GameStateItem, spark::SoccerRuleItem, spark::TrainerCommandParser)
