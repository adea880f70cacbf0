-- Soccer on the Standard Platform League's field, 9 x 6 m, with the Nao V4 (rsg/agent/naov4/nao.rsg); the rules are the
-- 3D league's.
--
--     sparkhost --config soccer-spl.lua
--
-- Options: --set /sys/server/physics.jointHeating=true (motors heat up) and --set
-- /sys/server/physics.batteryDischarge=true (motors discharge the battery).
league = {
  compat = "F",                                  -- percepts are those of the SPL's server
  variables = {
    FieldLength = 9, FieldWidth = 6, GoalWidth = 1.5, GoalDepth = 0.4, GoalHeight = 0.8, PenaltyLength = 0.6, PenaltyWidth = 2.2,
    FreeKickDistance = 0.75, FreeKickMoveDist = 1, GoalKickDist = 0.6, BallRadius = 0.05, BallMass = 0.05,
    SayMsgSize = 512, RuleHalfTime = 600, ChangeSidesInSecondHalf = true, MinOppDistance = 0.8, Min2PlDistance = 0.4, Min3PlDistance = 1,
    MaxRobotTypeCount = 11, MinRobotTypesCount = 1, MaxSumTwoRobotTypes = 22,   -- all robots are of one type
  },
}
include "soccer.lua"
