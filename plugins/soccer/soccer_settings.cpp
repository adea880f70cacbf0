#include "soccer_settings.h"

#include "spark/state_fields.h"

namespace spark {

void SoccerSettings::describe(Description<SoccerSettings>& d) {
  using S = SoccerSettings;
  d.doc("The variables Soccer.*, which scene files, rules and monitors read.");
  d.implements<IVariables>();
  d.method("define", &S::define)
      .parameters({"name", "value"})
      .doc("Adds a variable that no rule reads, for scene files of other leagues.");

  d.property("FieldLength", &S::fieldLength).unit("m").min(0.1).doc("Length of the field, along x.");
  d.property("FieldWidth", &S::fieldWidth).unit("m").min(0.1).doc("Width of the field, along y.");
  d.property("FieldHeight", &S::fieldHeight)
      .unit("m")
      .min(0)
      .doc("Height of the space above the field; sent to monitors.");
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
      .doc("Rules add the goal's width to PenaltyWidth, as field files do; false: they use PenaltyWidth alone.");
  d.property("BorderSize", &S::borderSize).unit("m").min(0).doc("Border around the field; sent to monitors.");

  d.property("BallRadius", &S::ballRadius).unit("m").min(0.001).doc("Radius of the ball.");
  d.property("BallMass", &S::ballMass).unit("kg").min(0.001).doc("Mass of the ball.");
  d.property("BallLinearDrag", &S::ballLinearDrag)
      .unit("N s/m")
      .min(0)
      .doc("Drag force of the ball per unit of speed.");
  d.property("BallAngularDrag", &S::ballAngularDrag)
      .unit("N m s")
      .min(0)
      .doc("Drag torque of the ball per unit of angular speed.");
  d.property("BallMaxSpeed", &S::ballMaxSpeed)
      .unit("m/s")
      .min(0)
      .doc("Largest speed of the ball, enforced before each step; 0: no limit.");
  d.property("AgentRadius", &S::agentRadius)
      .unit("m")
      .min(0.01)
      .doc("Radius of an agent: start positions, repositioning, kicks.");
  d.property("AgentMass", &S::agentMass).unit("kg").min(0.001).doc("Mass of a sphere agent.");
  d.property("AgentMaxSpeed", &S::agentMaxSpeed).unit("m/s").min(0).doc("Largest speed of a sphere agent.");
  d.property("AgentLinearDrag", &S::agentLinearDrag)
      .unit("N s/m")
      .min(0)
      .doc("Drag force of a sphere agent per unit of speed.");
  d.property("TeamSize", &S::teamSize)
      .range(11, 1000)
      .doc("Largest uniform number. Pass mode and offside handle numbers up to 11 only.");
  d.property("StartDistance", &S::startDistance)
      .unit("m")
      .min(0)
      .doc(
          "Distance between neighbouring start positions of a team; 0: as in the installed base, one and a half "
          "diameters of an agent in y and one in x.");
  d.property("MaxRobotTypeCount", &S::maxRobotTypeCount).min(0).doc("Largest number of robots of one type in a team.");
  d.property("MinRobotTypesCount", &S::minRobotTypesCount).min(0).doc("Smallest number of types in a team of 11.");
  d.property("MaxSumTwoRobotTypes", &S::maxSumTwoRobotTypes)
      .min(0)
      .doc("Largest number of robots of any two types together.");

  d.property("FreeKickDistance", &S::freeKickDistance)
      .unit("m")
      .min(0)
      .doc("Smallest distance of opponents from the ball at restarts; radius of the centre circle.");
  d.property("FreeKickMoveDist", &S::freeKickMoveDist)
      .unit("m")
      .min(0)
      .doc("Distance to which players are moved at restarts.");
  d.property("KickRepelDist", &S::kickRepelDist)
      .unit("m")
      .min(0)
      .doc("Distance to which players of the kicking team are moved from the ball, once at each restart.");
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
      .doc("A restart that is not taken within this time becomes a drop ball.");
  d.property("RuleHalfTime", &S::ruleHalfTime).unit("s").min(0).doc("Length of a half.");
  d.property("WaitBeforeKickOff", &S::waitBeforeKickOff)
      .unit("s")
      .min(0)
      .doc("With AutomaticKickOff: time from the first agent to the kick-off.");
  d.property("AutomaticKickOff", &S::automaticKickOff).doc("The match kicks off without a trainer.");
  d.property("CoinTossForKickOff", &S::coinTossForKickOff)
      .doc("A coin toss decides the first kick-off; false: the left team has it.");
  d.property("SingleHalfTime", &S::singleHalfTime).doc("The match has one half.");
  d.property("ChangeSidesInSecondHalf", &S::changeSidesInSecondHalf).doc("Teams swap sides at half time.");
  d.property("PenaltyShootout", &S::penaltyShootout)
      .doc(
          "Penalty shoot-out: kick-off restrictions are off, the right team stays in its penalty area, a goal ends "
          "it.");
  d.property("StartAnyFieldPosition", &S::startAnyFieldPosition)
      .doc("Players may beam to and start at any position of the field.");
  d.property("AutomaticQuit", &S::automaticQuit).doc("The host ends 10 s after the match.");
  d.property("UseOffside", &S::useOffside)
      .doc("Without effect, as in the installed base: offside is a control aspect (OffsideAspect).");
  d.property("MaxNumSafeRepositionAttempts", &S::maxNumSafeRepositionAttempts)
      .min(0)
      .doc("Number of positions that are tried when a player is moved.");

  d.property("ReportScore", &S::reportScore).doc("GS contains the score.");
  d.property("LabelMessages", &S::labelMessages).doc("hear contains the speaker's team.");
  d.property("BeamNoiseXY", &S::beamNoiseXY).unit("m").min(0).doc("Half width of the uniform noise of beam positions.");
  d.property("BeamNoiseAngle", &S::beamNoiseAngle)
      .unit("deg")
      .min(0)
      .doc("Half width of the uniform noise of beam angles.");
  d.property("BeamWithinFieldWidth", &S::beamWithinFieldWidth).doc("Beams end between the touch lines.");
  d.property("SayMsgSize", &S::sayMsgSize).unit("bytes").range(1, 512).doc("Longer messages of players are dropped.");
  d.property("ExtraGameState", &S::extraGameState)
      .doc(
          "GS also contains the kick-off side of the half and each player's penalty: (k left) (ti ((1 penalty_none "
          "0.00)) ()).");
  d.property("LongNames", &S::longNames)
      .doc(
          "Percepts have the names of 2004: Vision with Flag, Goal, Ball and Player, GameState with time and playmode "
          "and, once, the sizes of the field. RestrictedVisionPerceptors keep theirs.");
  d.property("AnnounceSides", &S::announceSides)
      .doc(
          "Agents get number and side again in their next GS when their team has changed sides; false: as in the "
          "installed base, they are not notified.");
  d.property("ConstantTemperature", &S::constantTemperature)
      .doc("AgentState always contains 23 degC, whatever the temperature is.");
  d.property("VisionInterval", &S::visionInterval)
      .unit("cycles")
      .range(0, 1000)
      .doc("Cycles between two percepts of a RestrictedVisionPerceptor; 0: as in the robot's scene file.");
  d.property("VisionRange", &S::visionRange)
      .unit("m")
      .min(0)
      .doc("Objects and players farther away are not seen by any robot; 0: as in the robots' scene files.");
  d.property("VisionOcclusion", &S::visionOcclusion)
      .doc("What is behind a collider is not seen; false: as the robots' scene files say, which is everything.");
  d.property("VisionNoise", &S::visionNoise).doc("False: vision has no noise, whatever the robots' scene files say.");
  d.property("Cheats", &S::cheats)
      .doc(
          "For training: See also contains the ground truth (mypos x y z), (myorien deg), (ballpos x y z), in the "
          "team's frame.");
  d.property("FieldLinesSeen", &S::fieldLinesSeen).doc("Robots whose vision senses lines see those of the field.");

  d.property("PassModeMaxBallSpeed", &S::passModeMaxBallSpeed)
      .unit("m/s")
      .min(0)
      .doc("Pass mode: largest speed of the ball.");
  d.property("PassModeMaxBallDist", &S::passModeMaxBallDist)
      .unit("m")
      .min(0)
      .doc("Pass mode: largest distance of the player to the ball.");
  d.property("PassModeMinOppBallDist", &S::passModeMinOppBallDist)
      .unit("m")
      .min(0)
      .doc("Pass mode: smallest distance of opponents to the ball.");
  d.property("PassModeDuration", &S::passModeDuration).unit("s").min(0).doc("Pass mode ends after this time.");
  d.property("PassModeScoreWaitTime", &S::passModeScoreWaitTime)
      .unit("s")
      .min(0)
      .doc("Time after pass mode in which goals do not count.");
  d.property("PassModeRetryWaitTime", &S::passModeRetryWaitTime)
      .unit("s")
      .min(0)
      .doc("Smallest time between two pass modes of a team.");

  d.property("NotStandingMaxTime", &S::notStandingMaxTime)
      .unit("s")
      .min(0)
      .doc("Longest time that a field player may not stand.");
  d.property("GoalieNotStandingMaxTime", &S::goalieNotStandingMaxTime)
      .unit("s")
      .min(0)
      .doc("Longest time that a goalie may not stand.");
  d.property("GroundMaxTime", &S::groundMaxTime)
      .unit("s")
      .min(0)
      .doc("Longest time that a field player may lie on the ground.");
  d.property("GoalieGroundMaxTime", &S::goalieGroundMaxTime)
      .unit("s")
      .min(0)
      .doc("Longest time that a goalie may lie on the ground.");
  d.property("FoulHoldTime", &S::foulHoldTime).unit("s").min(0).doc("Time that a penalised player is held.");
  d.property("MinOppDistance", &S::minOppDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: distance of the opponent to the ball; 0: off.");
  d.property("Min2PlDistance", &S::min2PlDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: smallest distance of the second player; 0: off.");
  d.property("Min3PlDistance", &S::min3PlDistance)
      .unit("m")
      .min(0)
      .doc("Crowding: smallest distance of the third player; 0: off.");
  d.property("MaxPlayersInsideOwnArea", &S::maxPlayersInsideOwnArea)
      .min(0)
      .doc("Largest number of players in their own penalty area.");
  d.property("MaxTouchGroupSize", &S::maxTouchGroupSize)
      .min(1)
      .doc("Largest number of players that may touch each other.");
  d.property("IllegalDefenseBeamPenalty", &S::illegalDefenseBeamPenalty).doc("Illegal defence is penalised by a beam.");
  d.property("TouchingFoulBeamPenalty", &S::touchingFoulBeamPenalty).doc("Touching is penalised by a beam.");
  d.property("UseCharging", &S::useCharging).doc("Charging is a foul.");
  d.property("ChargingMinSpeed", &S::chargingMinSpeed).unit("m/s").min(0).doc("Charging: smallest speed.");
  d.property("ChargingMinBallSpeedAngle", &S::chargingMinBallSpeedAngle)
      .unit("deg")
      .min(0)
      .doc("Charging: smallest angle between the velocity and the direction to the ball.");
  d.property("ChargingMinDeltaDist", &S::chargingMinDeltaDist)
      .unit("m")
      .min(0)
      .doc("Charging: smallest difference of the distances to the ball.");
  d.property("ChargingMinDeltaAng", &S::chargingMinDeltaAng)
      .unit("deg")
      .min(0)
      .doc("Charging: smallest difference of the angles to the opponent.");
  d.property("ChargingImmunityTime", &S::chargingImmunityTime)
      .unit("s")
      .min(0)
      .doc("Charging: immunity after a touch of the ball.");
  d.property("ChargingCollisionMinTime", &S::chargingCollisionMinTime)
      .unit("s")
      .min(0)
      .doc("Charging: gap after which a contact no longer continues a harmless one.");
  d.property("ChargingMaxBallRulesDist", &S::chargingMaxBallRulesDist)
      .unit("m")
      .min(0)
      .doc("Charging: within this distance the ball is taken into account.");
  d.property("ChargingMinCollBallDist", &S::chargingMinCollBallDist)
      .unit("m")
      .min(0)
      .doc("Charging: contacts nearer to the ball are no fouls.");
  d.property("ChargingMinCollisionSpeed", &S::chargingMinCollisionSpeed)
      .unit("m/s")
      .min(0)
      .doc("Charging: smallest speed towards the contact.");
  d.property("SelfCollisionsTolerance", &S::selfCollisionsTolerance)
      .unit("m")
      .min(0)
      .doc("Tolerated overlap of parts of one robot.");
  d.property("SelfCollisionJointFrozenTime", &S::selfCollisionJointFrozenTime)
      .unit("s")
      .min(0)
      .doc("Time that joints are frozen after a self-collision.");
  d.property("SelfCollisionJointThawTime", &S::selfCollisionJointThawTime)
      .unit("s")
      .min(0)
      .doc("Time that they are immune afterwards.");
  d.property("SelfCollisionBeamCooldownTime", &S::selfCollisionBeamCooldownTime)
      .unit("s")
      .min(0)
      .doc("Smallest time between two beam penalties.");
  d.property("PrintSelfCollisions", &S::printSelfCollisions).doc("Self-collisions are logged.");
  d.property("FoulOnSelfCollisions", &S::foulOnSelfCollisions).doc("Self-collisions are fouls.");
  d.property("SelfCollisionBeamPenalty", &S::selfCollisionBeamPenalty).doc("Self-collisions are penalised by a beam.");
  d.property("WriteSelfCollisionsToFile", &S::writeSelfCollisionsToFile).doc("Self-collisions are recorded in a file.");
  d.property("SelfCollisionRecordFilename", &S::selfCollisionRecordFilename).doc("Name of that file.");

  d.property("UseBallHolding", &S::useBallHolding).doc("Holding the ball is a foul, as in servers after 0.7.5.");
  d.property("BallHoldRadius", &S::ballHoldRadius)
      .unit("m")
      .min(0)
      .doc("Ball holding: largest distance at which a player holds the ball.");
  d.property("BallHoldOppDist", &S::ballHoldOppDist)
      .unit("m")
      .min(0)
      .doc("Ball holding: time counts while an opponent is this near to the ball; 0: always.");
  d.property("BallHoldMaxTime", &S::ballHoldMaxTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: longest time that a player may hold the ball.");
  d.property("BallHoldGoalieMaxTime", &S::goalieBallHoldMaxTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: longest time that a goalie may hold the ball in its own penalty area.");
  d.property("BallHoldResetTime", &S::ballHoldResetTime)
      .unit("s")
      .min(0)
      .doc("Ball holding: time without the ball after which a hold ends.");

  d.property("Keepaway", &S::keepaway).doc("Keep-away instead of soccer.");
  d.property("KeepawayCenterX", &S::keepawayCenterX).unit("m").doc("Centre of the keep-away field.");
  d.property("KeepawayCenterY", &S::keepawayCenterY).unit("m").doc("Centre of the keep-away field.");
  d.property("KeepawayLength", &S::keepawayLength).unit("m").min(0).doc("Length of the keep-away field at the start.");
  d.property("KeepawayWidth", &S::keepawayWidth).unit("m").min(0).doc("Width of the keep-away field at the start.");
  d.property("KeepawayLengthReductionRate", &S::keepawayLengthReductionRate)
      .unit("m/min")
      .min(0)
      .doc("Rate at which the keep-away field gets shorter.");
  d.property("KeepawayWidthReductionRate", &S::keepawayWidthReductionRate)
      .unit("m/min")
      .min(0)
      .doc("Rate at which the keep-away field gets narrower.");

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

void SoccerSettings::saveState(StateWriter& out) const { saveFields(out, others_); }
void SoccerSettings::loadState(StateReader& in) { loadFields(in, others_); }

}  // namespace spark
