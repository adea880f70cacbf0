// The variables Soccer.*: names and defaults of the original 3D league server.
#include "match_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("Every variable of the league has its default, is available to rules and scene files, and can be set",
          "[soccer]") {
  SoccerMatch h(false);
  const std::vector<std::pair<const char*, Value>> defaults{
      {"FieldLength", 30.0},
      {"FieldWidth", 20.0},
      {"FieldHeight", 40.0},
      {"GoalWidth", 2.1},
      {"GoalDepth", 0.6},
      {"GoalHeight", 0.8},
      {"PenaltyLength", 1.8},
      {"PenaltyWidth", 3.9},
      {"FreeKickDistance", 2.0},
      {"FreeKickMoveDist", 2.5},
      {"KickRepelDist", 0.5},
      {"GoalKickDist", 1.0},
      {"BorderSize", 0.0},
      {"AutomaticKickOff", false},
      {"WaitBeforeKickOff", 30.0},
      {"CoinTossForKickOff", false},
      {"PenaltyShootout", false},
      {"StartAnyFieldPosition", false},
      {"AutomaticQuit", false},
      {"ChangeSidesInSecondHalf", false},
      {"Keepaway", false},
      {"KeepawayCenterX", 0.0},
      {"KeepawayCenterY", 0.0},
      {"KeepawayLength", 20.0},
      {"KeepawayWidth", 20.0},
      {"KeepawayLengthReductionRate", 4.0},
      {"KeepawayWidthReductionRate", 4.0},
      {"AgentRadius", 0.4},
      {"MaxRobotTypeCount", 7},
      {"MinRobotTypesCount", 3},
      {"MaxSumTwoRobotTypes", 9},
      {"BallRadius", 0.042},
      {"BallMass", 0.026},
      {"RuleGoalPauseTime", 3.0},
      {"RuleKickInPauseTime", 1.0},
      {"RuleHalfTime", 300.0},
      {"RuleDropBallTime", 15.0},
      {"SingleHalfTime", false},
      {"UseOffside", false},
      {"MaxTouchGroupSize", 2},
      {"TouchingFoulBeamPenalty", false},
      {"UseCharging", true},
      {"ChargingMinSpeed", 0.4},
      {"ChargingMinBallSpeedAngle", 30.0},
      {"ChargingMinDeltaDist", 0.05},
      {"ChargingMinDeltaAng", 15.0},
      {"ChargingImmunityTime", 1.0},
      {"ChargingCollisionMinTime", 0.2},
      {"ChargingMaxBallRulesDist", 1.0},
      {"ChargingMinCollBallDist", 0.1},
      {"ChargingMinCollisionSpeed", 0.2},
      {"SelfCollisionsTolerance", 0.04},
      {"PrintSelfCollisions", true},
      {"FoulOnSelfCollisions", true},
      {"SelfCollisionJointFrozenTime", 1.0},
      {"SelfCollisionJointThawTime", 2.0},
      {"SelfCollisionBeamPenalty", false},
      {"SelfCollisionBeamCooldownTime", 10.0},
      {"WriteSelfCollisionsToFile", false},
      {"SelfCollisionRecordFilename", "SelfCollisions.txt"},
      {"NotStandingMaxTime", 30.0},
      {"GoalieNotStandingMaxTime", 60.0},
      {"GroundMaxTime", 15.0},
      {"GoalieGroundMaxTime", 30.0},
      {"MaxPlayersInsideOwnArea", 3},
      {"IllegalDefenseBeamPenalty", false},
      {"MinOppDistance", 0.0},
      {"Min2PlDistance", 0.0},
      {"Min3PlDistance", 0.0},
      {"FoulHoldTime", 0.5},
      {"ReportScore", true},
      {"LabelMessages", true},
      {"BeamNoiseXY", 0.05},
      {"BeamNoiseAngle", 10.0},
      {"MaxNumSafeRepositionAttempts", 100},
      {"PassModeMaxBallSpeed", 0.05},
      {"PassModeMaxBallDist", 0.5},
      {"PassModeMinOppBallDist", 1.0},
      {"PassModeDuration", 4.0},
      {"PassModeScoreWaitTime", 10.0},
      {"PassModeRetryWaitTime", 3.0},
      {"BallRecorder", "Ball/geometry/recorder"},
      {"LeftGoalRecorder", "leftgoal/GoalBox/BoxCollider/recorder"},
      {"RightGoalRecorder", "rightgoal/GoalBox/BoxCollider/recorder"}};
  Leaf& soccer = h.at("/sys/variables/Soccer");
  auto& variables = h.kernel.root().require<IVariables>("/sys/variables/Soccer");
  for (const auto& [name, value] : defaults) {
    INFO(name);
    CHECK(getProperty(soccer, name).text() == value.text());
    CHECK(variables.variable(name).text() == value.text());
    const Value other = value.isBool()     ? Value(!value.toBool())
                        : value.isString() ? Value("elsewhere")
                                           : Value(value.toNumber() + 1);
    h.set(name, other);
    CHECK(variables.variable(name) == getProperty(soccer, name));
    CHECK(variables.variable(name).text() != value.text());
  }
}
