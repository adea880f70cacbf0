#pragma once

#include <map>
#include <string>

#include "api/scene.h"
#include "visible_objects.h"

namespace spark {

/// The variables `Soccer.*`, which scene files, rules and monitors read. Defaults are those of the 3D league (field of
/// 30 x 20 m). Rules read them in every cycle, so that changes take effect at once; scene files when they are loaded.
/// describe() documents each of them, with unit and range.
class SoccerSettings : public Node, public IVariables {
  SPARK_CLASS(SoccerSettings, Node)
 public:
  static constexpr const char* kPath = "/sys/variables/Soccer";
  static void describe(Description<SoccerSettings>& d);
  Value variable(std::string_view name) const override;
  /// Adds or replaces a variable that no rule reads, for scene files of other leagues.
  void define(std::string name, Value value) { others_[std::move(name)] = std::move(value); }
  /// The visible objects of the scene, shared by all eyes.
  soccer::VisibleObjects& visibleObjects() { return visibleObjects_; }

  // Field [m]
  double fieldLength = 30, fieldWidth = 20, fieldHeight = 40, goalWidth = 2.1, goalDepth = 0.6, goalHeight = 0.8;
  double penaltyLength = 1.8, penaltyWidth = 3.9, borderSize = 0;
  bool penaltyWidthBeyondGoal = true;
  // Ball and agents
  double ballRadius = 0.042, ballMass = 0.026, ballLinearDrag = 0.01, ballAngularDrag = 0.00005, ballMaxSpeed = 0;
  double startDistance = 0, agentRadius = 0.4, agentMass = 75, agentMaxSpeed = 10, agentLinearDrag = 0.1;
  int teamSize = 11, maxRobotTypeCount = 7, minRobotTypesCount = 3, maxSumTwoRobotTypes = 9;
  // Restarts
  double freeKickDistance = 2.0, freeKickMoveDist = 2.5, kickRepelDist = 0.5, goalKickDist = 1.0;
  double ruleGoalPauseTime = 3, ruleKickInPauseTime = 1, ruleDropBallTime = 15, ruleHalfTime = 300,
         waitBeforeKickOff = 30;
  bool automaticKickOff = false, coinTossForKickOff = false, singleHalfTime = false, changeSidesInSecondHalf = false;
  bool penaltyShootout = false, startAnyFieldPosition = false, automaticQuit = false, useOffside = false;
  int maxNumSafeRepositionAttempts = 100;
  // Percepts and noise
  bool announceSides = true, reportScore = true, labelMessages = true, extraGameState = false,
       constantTemperature = true, longNames = false;
  double beamNoiseXY = 0.05, beamNoiseAngle = 10;
  bool beamWithinFieldWidth = true;
  int sayMsgSize = 20;
  bool visionNoise = true, visionOcclusion = false, fieldLinesSeen = true, cheats = false;
  int visionInterval = 0;
  double visionRange = 0;
  // Pass mode
  double passModeMaxBallSpeed = 0.05, passModeMaxBallDist = 0.5, passModeMinOppBallDist = 1, passModeDuration = 4;
  double passModeScoreWaitTime = 10, passModeRetryWaitTime = 3;
  // Fouls
  double notStandingMaxTime = 30, goalieNotStandingMaxTime = 60, groundMaxTime = 15, goalieGroundMaxTime = 30,
         foulHoldTime = 0.5;
  double minOppDistance = 0, min2PlDistance = 0, min3PlDistance = 0;
  int maxPlayersInsideOwnArea = 3, maxTouchGroupSize = 2;
  bool illegalDefenseBeamPenalty = false, touchingFoulBeamPenalty = false;
  bool useCharging = true;
  double chargingMinSpeed = 0.4, chargingMinBallSpeedAngle = 30, chargingMinDeltaDist = 0.05, chargingMinDeltaAng = 15;
  double chargingImmunityTime = 1, chargingCollisionMinTime = 0.2, chargingMaxBallRulesDist = 1,
         chargingMinCollBallDist = 0.1;
  double chargingMinCollisionSpeed = 0.2;
  double selfCollisionsTolerance = 0.04, selfCollisionJointFrozenTime = 1, selfCollisionJointThawTime = 2,
         selfCollisionBeamCooldownTime = 10;
  bool printSelfCollisions = true, foulOnSelfCollisions = true, selfCollisionBeamPenalty = false,
       writeSelfCollisionsToFile = false;
  std::string selfCollisionRecordFilename = "SelfCollisions.txt";
  bool useBallHolding = false;
  double ballHoldRadius = 0.12, ballHoldOppDist = 0.75, ballHoldMaxTime = 5, goalieBallHoldMaxTime = 10,
         ballHoldResetTime = 1;
  // Keep-away
  bool keepaway = false;
  double keepawayCenterX = 0, keepawayCenterY = 0, keepawayLength = 20, keepawayWidth = 20;
  double keepawayLengthReductionRate = 4, keepawayWidthReductionRate = 4;
  // Nodes of the field, relative to the scene
  std::string ballRecorder = "Ball/geometry/recorder";
  std::string leftGoalRecorder = "leftgoal/GoalBox/BoxCollider/recorder",
              rightGoalRecorder = "rightgoal/GoalBox/BoxCollider/recorder";

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  std::map<std::string, Value, std::less<>> others_;  ///< of define()
  soccer::VisibleObjects visibleObjects_;
};

}  // namespace spark
