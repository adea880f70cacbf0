#include "soccer_settings.h"

namespace spark {

void SoccerSettings::describe(Description<SoccerSettings>& d) {
  using S = SoccerSettings;
  d.doc("The variables Soccer.*: what scene files read, rules obey and monitors show.");
  d.implements<IVariables>();
  d.method("define", &S::define)
      .parameters({"name", "value"})
      .doc("Adds a variable that no rule knows, for scene files of other leagues.");

  d.property("FieldLength", &S::fieldLength).unit("m").min(0.1).doc("Length of the field, along x.");
  d.property("FieldWidth", &S::fieldWidth).unit("m").min(0.1).doc("Width of the field, along y.");
  d.property("FieldHeight", &S::fieldHeight)
      .unit("m")
      .min(0)
      .doc("Height of the space above the field; told to monitors.");
  d.property("GoalWidth", &S::goalWidth).unit("m").min(0).doc("Inner width of the goals.");
  d.property("GoalDepth", &S::goalDepth).unit("m").min(0).doc("Depth of the goals behind the goal line.");
  d.property("GoalHeight", &S::goalHeight).unit("m").min(0).doc("Inner height of the goals.");
  d.property("PenaltyLength", &S::penaltyLength)
      .unit("m")
      .min(0)
      .doc("Extent of the penalty areas from the goal line into the field.");
  d.property("PenaltyWidth", &S::penaltyWidth)
      .unit("m")
      .min(0)
      .doc("Width of the penalty areas beyond the goal's width, both sides together.");
  d.property("PenaltyWidthBeyondGoal", &S::penaltyWidthBeyondGoal)
      .doc("Rules add the goal's width to PenaltyWidth, as field files do; false: rules take PenaltyWidth alone.");
  d.property("BorderSize", &S::borderSize).unit("m").min(0).doc("Border around the field; told to monitors.");

  d.property("BallRadius", &S::ballRadius).unit("m").min(0.001).doc("Radius of the ball.");
  d.property("BallMass", &S::ballMass).unit("kg").min(0.001).doc("Mass of the ball.");
  d.property("BallLinearDrag", &S::ballLinearDrag).unit("N s/m").min(0).doc("Drag force of the ball per speed.");
  d.property("BallAngularDrag", &S::ballAngularDrag)
      .unit("N m s")
      .min(0)
      .doc("Drag torque of the ball per angular speed.");
  d.property("BallMaxSpeed", &S::ballMaxSpeed)
      .unit("m/s")
      .min(0)
      .doc("Speed to which the ball is cut before each step; 0: none.");
  d.property("AgentRadius", &S::agentRadius)
      .unit("m")
      .min(0.01)
      .doc("Radius of an agent: start positions, repositioning, kicks.");
  d.property("AgentMass", &S::agentMass).unit("kg").min(0.001).doc("Mass of a sphere agent.");
  d.property("AgentMaxSpeed", &S::agentMaxSpeed).unit("m/s").min(0).doc("Greatest speed of a sphere agent.");
  d.property("AgentLinearDrag", &S::agentLinearDrag)
      .unit("N s/m")
      .min(0)
      .doc("Drag force of a sphere agent per speed.");
  d.property("TeamSize", &S::teamSize)
      .range(11, 1000)
      .doc("Greatest number of a player. Pass mode and offside know 11 a team, a match of soccer has no more.");
  d.property("StartDistance", &S::startDistance)
      .unit("m")
      .min(0)
      .doc(
          "Between neighbouring start positions of a team; 0: as in the installed base, one and a half and one "
          "diameter of an agent.");
  d.property("MaxRobotTypeCount", &S::maxRobotTypeCount).min(0).doc("At most so many robots of one type in a team.");
  d.property("MinRobotTypesCount", &S::minRobotTypesCount).min(0).doc("At least so many types in a team of 11.");
  d.property("MaxSumTwoRobotTypes", &S::maxSumTwoRobotTypes)
      .min(0)
      .doc("At most so many robots of any two types together.");

  d.property("FreeKickDistance", &S::freeKickDistance)
      .unit("m")
      .min(0)
      .doc("Opponents stay so far from the ball at restarts; radius of the centre circle.");
  d.property("FreeKickMoveDist", &S::freeKickMoveDist)
      .unit("m")
      .min(0)
      .doc("So far players are moved away at restarts.");
  d.property("KickRepelDist", &S::kickRepelDist)
      .unit("m")
      .min(0)
      .doc("At a restart the kicking team is once pushed so far from the ball.");
  d.property("GoalKickDist", &S::goalKickDist)
      .unit("m")
      .min(0)
      .doc("Distance of the goal kick's ball from the goal line.");
  d.property("RuleGoalPauseTime", &S::ruleGoalPauseTime).unit("s").min(0).doc("Pause after a goal.");
  d.property("RuleKickInPauseTime", &S::ruleKickInPauseTime)
      .unit("s")
      .min(0)
      .doc("Pause between an award and the restart.");
  d.property("RuleDropBallTime", &S::ruleDropBallTime)
      .unit("s")
      .min(0)
      .doc("A restart that nobody takes becomes a drop ball.");
  d.property("RuleHalfTime", &S::ruleHalfTime).unit("s").min(0).doc("Length of a half.");
  d.property("WaitBeforeKickOff", &S::waitBeforeKickOff)
      .unit("s")
      .min(0)
      .doc("With AutomaticKickOff: from the first agent's coming to the kick-off.");
  d.property("AutomaticKickOff", &S::automaticKickOff).doc("The match kicks off by itself.");
  d.property("CoinTossForKickOff", &S::coinTossForKickOff)
      .doc("A coin decides the first kick-off; else the left team has it.");
  d.property("SingleHalfTime", &S::singleHalfTime).doc("The match has one half.");
  d.property("ChangeSidesInSecondHalf", &S::changeSidesInSecondHalf).doc("Teams swap sides at half time.");
  d.property("PenaltyShootout", &S::penaltyShootout)
      .doc(
          "Penalty shoot-out: kick-off restrictions are off, the right team stays in its penalty area, a goal ends "
          "it.");
  d.property("StartAnyFieldPosition", &S::startAnyFieldPosition).doc("Beams and starts anywhere on the field.");
  d.property("AutomaticQuit", &S::automaticQuit).doc("The host ends 10 s after the match.");
  d.property("UseOffside", &S::useOffside)
      .doc("Without effect, as in the installed base: offside is a control aspect (OffsideAspect).");
  d.property("MaxNumSafeRepositionAttempts", &S::maxNumSafeRepositionAttempts)
      .min(0)
      .doc("So many places are tried when a player is moved.");

  d.property("ReportScore", &S::reportScore).doc("Agents are told the score.");
  d.property("LabelMessages", &S::labelMessages).doc("Heard messages carry the speaker's team.");
  d.property("BeamNoiseXY", &S::beamNoiseXY).unit("m").min(0).doc("Half width of the uniform noise of beam positions.");
  d.property("BeamNoiseAngle", &S::beamNoiseAngle)
      .unit("deg")
      .min(0)
      .doc("Half width of the uniform noise of beam angles.");
  d.property("BeamWithinFieldWidth", &S::beamWithinFieldWidth).doc("Beams end between the touch lines.");
  d.property("SayMsgSize", &S::sayMsgSize).unit("bytes").range(1, 512).doc("Longer messages of players are not heard.");
  d.property("ExtraGameState", &S::extraGameState)
      .doc(
          "GS also tells who kicks the half off and every player's penalty: (k left) (ti ((1 penalty_none 0.00)) ()).");
  d.property("ConstantTemperature", &S::constantTemperature)
      .doc("Agents are told 23 degC, whatever their temperature is.");
  d.property("VisionInterval", &S::visionInterval)
      .unit("cycles")
      .range(0, 1000)
      .doc("Cycles between two looks through a RestrictedVisionPerceptor; 0: as the robot's scene file says.");
  d.property("VisionRange", &S::visionRange)
      .unit("m")
      .min(0)
      .doc("Objects and players farther away are not seen, by nobody; 0: as the robots' files say.");
  d.property("VisionNoise", &S::visionNoise)
      .doc("False: what robots see has no noise, whatever their scene files say.");
  d.property("Cheats", &S::cheats)
      .doc(
          "For training: robots see the truth, too: (mypos x y z), (myorien deg), (ballpos x y z), in the view of "
          "their side.");
  d.property("FieldLinesSeen", &S::fieldLinesSeen).doc("Robots whose vision senses lines see the field's.");

  d.property("PassModeMaxBallSpeed", &S::passModeMaxBallSpeed)
      .unit("m/s")
      .min(0)
      .doc("Pass mode: the ball must not be faster.");
  d.property("PassModeMaxBallDist", &S::passModeMaxBallDist)
      .unit("m")
      .min(0)
      .doc("Pass mode: the player must be as near to the ball.");
  d.property("PassModeMinOppBallDist", &S::passModeMinOppBallDist)
      .unit("m")
      .min(0)
      .doc("Pass mode: opponents must be as far from the ball.");
  d.property("PassModeDuration", &S::passModeDuration).unit("s").min(0).doc("Pass mode ends by itself.");
  d.property("PassModeScoreWaitTime", &S::passModeScoreWaitTime)
      .unit("s")
      .min(0)
      .doc("Goals do not count so long after pass mode.");
  d.property("PassModeRetryWaitTime", &S::passModeRetryWaitTime)
      .unit("s")
      .min(0)
      .doc("Pass mode is not given again before.");

  d.property("NotStandingMaxTime", &S::notStandingMaxTime).unit("s").min(0).doc("A field player may be down so long.");
  d.property("GoalieNotStandingMaxTime", &S::goalieNotStandingMaxTime)
      .unit("s")
      .min(0)
      .doc("A goalie may be down so long.");
  d.property("GroundMaxTime", &S::groundMaxTime).unit("s").min(0).doc("A field player may lie so long.");
  d.property("GoalieGroundMaxTime", &S::goalieGroundMaxTime).unit("s").min(0).doc("A goalie may lie so long.");
  d.property("FoulHoldTime", &S::foulHoldTime).unit("s").min(0).doc("A penalised player is held so long.");
  d.property("MinOppDistance", &S::minOppDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: the opponent's distance to the ball; 0: off.");
  d.property("Min2PlDistance", &S::min2PlDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: the second player's distance; 0: off.");
  d.property("Min3PlDistance", &S::min3PlDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: the third player's distance; 0: off.");
  d.property("MaxPlayersInsideOwnArea", &S::maxPlayersInsideOwnArea)
      .min(0)
      .doc("At most so many players in their own penalty area.");
  d.property("MaxTouchGroupSize", &S::maxTouchGroupSize).min(1).doc("At most so many players may touch each other.");
  d.property("IllegalDefenseBeamPenalty", &S::illegalDefenseBeamPenalty).doc("Illegal defence is penalised by a beam.");
  d.property("TouchingFoulBeamPenalty", &S::touchingFoulBeamPenalty).doc("Touching is penalised by a beam.");
  d.property("UseCharging", &S::useCharging).doc("Charging is a foul.");
  d.property("ChargingMinSpeed", &S::chargingMinSpeed).unit("m/s").min(0).doc("Charging: least speed.");
  d.property("ChargingMinBallSpeedAngle", &S::chargingMinBallSpeedAngle)
      .unit("deg")
      .min(0)
      .doc("Charging: least angle between motion and ball.");
  d.property("ChargingMinDeltaDist", &S::chargingMinDeltaDist)
      .unit("m")
      .min(0)
      .doc("Charging: least difference of the distances to the ball.");
  d.property("ChargingMinDeltaAng", &S::chargingMinDeltaAng)
      .unit("deg")
      .min(0)
      .doc("Charging: least difference of the angles to the opponent.");
  d.property("ChargingImmunityTime", &S::chargingImmunityTime)
      .unit("s")
      .min(0)
      .doc("Charging: immunity after a touch of the ball.");
  d.property("ChargingCollisionMinTime", &S::chargingCollisionMinTime)
      .unit("s")
      .min(0)
      .doc("Charging: quiet time after a harmless contact.");
  d.property("ChargingMaxBallRulesDist", &S::chargingMaxBallRulesDist)
      .unit("m")
      .min(0)
      .doc("Charging: the ball counts within this distance.");
  d.property("ChargingMinCollBallDist", &S::chargingMinCollBallDist)
      .unit("m")
      .min(0)
      .doc("Charging: contacts nearer to the ball are none.");
  d.property("ChargingMinCollisionSpeed", &S::chargingMinCollisionSpeed)
      .unit("m/s")
      .min(0)
      .doc("Charging: least speed towards the contact.");
  d.property("SelfCollisionsTolerance", &S::selfCollisionsTolerance)
      .unit("m")
      .min(0)
      .doc("Overlap of a robot's own parts that is tolerated.");
  d.property("SelfCollisionJointFrozenTime", &S::selfCollisionJointFrozenTime)
      .unit("s")
      .min(0)
      .doc("Joints of a self-collision are frozen so long.");
  d.property("SelfCollisionJointThawTime", &S::selfCollisionJointThawTime)
      .unit("s")
      .min(0)
      .doc("And immune so long afterwards.");
  d.property("SelfCollisionBeamCooldownTime", &S::selfCollisionBeamCooldownTime)
      .unit("s")
      .min(0)
      .doc("Least time between two beam penalties.");
  d.property("PrintSelfCollisions", &S::printSelfCollisions).doc("Self-collisions are logged.");
  d.property("FoulOnSelfCollisions", &S::foulOnSelfCollisions).doc("Self-collisions are fouls.");
  d.property("SelfCollisionBeamPenalty", &S::selfCollisionBeamPenalty).doc("Self-collisions are penalised by a beam.");
  d.property("WriteSelfCollisionsToFile", &S::writeSelfCollisionsToFile).doc("Self-collisions are recorded in a file.");
  d.property("SelfCollisionRecordFilename", &S::selfCollisionRecordFilename).doc("That file.");

  d.property("UseBallHolding", &S::useBallHolding).doc("Holding the ball is a foul, as in later servers.");
  d.property("BallHoldRadius", &S::ballHoldRadius)
      .unit("m")
      .min(0)
      .doc("Ball holding: who has the ball so near holds it.");
  d.property("BallHoldOppDist", &S::ballHoldOppDist)
      .unit("m")
      .min(0)
      .doc("Ball holding: it counts while an opponent is so near to the ball; 0: always.");
  d.property("BallHoldMaxTime", &S::ballHoldMaxTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: a player may hold the ball so long.");
  d.property("BallHoldGoalieMaxTime", &S::goalieBallHoldMaxTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: a goalie in the own penalty area may hold the ball so long.");
  d.property("BallHoldResetTime", &S::ballHoldResetTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: so long without the ball ends a hold.");

  d.property("Keepaway", &S::keepaway).doc("Keep-away instead of soccer.");
  d.property("KeepawayCenterX", &S::keepawayCenterX).unit("m").doc("Centre of the keep-away field.");
  d.property("KeepawayCenterY", &S::keepawayCenterY).unit("m").doc("Centre of the keep-away field.");
  d.property("KeepawayLength", &S::keepawayLength).unit("m").min(0).doc("Length of the keep-away field at the start.");
  d.property("KeepawayWidth", &S::keepawayWidth).unit("m").min(0).doc("Width of the keep-away field at the start.");
  d.property("KeepawayLengthReductionRate", &S::keepawayLengthReductionRate)
      .unit("m/min")
      .min(0)
      .doc("It shrinks so fast.");
  d.property("KeepawayWidthReductionRate", &S::keepawayWidthReductionRate)
      .unit("m/min")
      .min(0)
      .doc("It shrinks so fast.");

  d.property("BallRecorder", &S::ballRecorder).doc("Path of the ball's collision recorder below the scene.");
  d.property("LeftGoalRecorder", &S::leftGoalRecorder)
      .doc("Path of the left goal box's collision recorder below the scene.");
  d.property("RightGoalRecorder", &S::rightGoalRecorder)
      .doc("Path of the right goal box's collision recorder below the scene.");
}

Value SoccerSettings::variable(std::string_view name) const {
  if (const Property* known = classObject()->property(name)) return known->get(*this);
  const auto other = others_.find(name);
  return other == others_.end() ? Value() : other->second;
}

}  // namespace spark
