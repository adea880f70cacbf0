#include <catch2/catch.hpp>

#include "message.h"
#include "recording.h"
#include "test_support.h"

// The `compat` option, which selects a version of the original server, from a client's view.

using namespace spark::test;

namespace {

/// Joins in the host's first cycles; returns the player's messages, from the first one with its robot.
std::vector<std::string> listen(const std::vector<std::string>& settings, int messages = 24) {
  LockstepHost host(settings);
  Client client(host.agentPort);
  client.send("(scene rsg/agent/nao/nao.rsg)(syn)");
  std::vector<std::string> out;
  for (int i = 0; i < messages; ++i) {
    out.push_back(client.receive());
    client.send(i == 0 ? "(init (unum 3)(teamname Reds))(syn)" : "(syn)");
  }
  host.end();
  return out;
}

bool holds(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

/// The number of messages from one with See to the next.
int interval(const std::vector<std::string>& messages) {
  std::vector<int> at;
  for (int i = 0; i < static_cast<int>(messages.size()); ++i)
    if (holds(messages[static_cast<std::size_t>(i)], "(See ")) at.push_back(i);
  return at.size() > 1 ? at[1] - at[0] : 0;
}

std::string all(const std::vector<std::string>& messages) {
  std::string out;
  for (const std::string& m : messages) out += m + "\n";
  return out;
}

Finished check(const std::vector<std::string>& settings) {
  std::vector<std::string> command{
      (binFolder() / "sparkhost").string(), "--config", "soccer.lua", "--check", "--log-level", "warning"};
  for (const std::string& s : settings) command.insert(command.end(), {"--set", s});
  return runToEnd(command);
}

}  // namespace

TEST_CASE("By default the host sends the messages of the mainline server") {
  const auto messages = listen({});
  const std::string text = all(messages);
  CHECK(holds(text, "(GS (unum 3) (team left) (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))"));
  CHECK(holds(messages.back(), "(GS (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))(GYR (n torso) (rt "));
  CHECK(holds(text, " (L (pol "));
  CHECK(interval(messages) == 3);
  CHECK(shape(all(listen({"compat=M"}))) == shape(text));
}

TEST_CASE("compat=F sends the messages of the SPL's server") {
  const auto messages = listen({"compat=F"});
  const std::string text = all(messages);
  CHECK(holds(messages.front(), "(GS (sl 0) (sr 0) (t 0.000) (pm BeforeKickOff) (k left) (ti () ()))"));
  CHECK(holds(text,
              "(GS (unum 3) (team left) (sl 0) (sr 0) (t 0.000) (pm BeforeKickOff) (k left) (ti ((3 penalty_none "
              "0.000)) ()))"));
  CHECK(holds(text, "(See "));
  CHECK_FALSE(holds(text, "(L "));
  CHECK(interval(messages) == 3);
}

TEST_CASE("With compat=L vision has an interval of two cycles, and the rest is as in the mainline") {
  const auto messages = listen({"compat=L"});
  CHECK(interval(messages) == 2);
  CHECK(holds(all(messages), "(GS (unum 3) (team left) (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))"));
  CHECK(holds(all(messages), " (L (pol "));
}

TEST_CASE("Individual settings take precedence over compat") {
  const auto messages = listen({"compat=F", "Soccer.FieldLinesSeen=true", "Soccer.VisionInterval=4",
                                "/sys/server/gamecontrol/parser.decimals=1"});
  CHECK(holds(all(messages), " (L (pol "));
  CHECK(holds(messages.back(), "(t 0.0) (pm BeforeKickOff) (k left)"));
  CHECK(interval(messages) == 4);
}

TEST_CASE("An unknown version is an error that lists the known ones") {
  const Finished f = check({"compat=G"});
  CHECK(f.code == 2);
  CHECK(holds(f.errors, "\"M\", \"F\", \"L\""));
}

TEST_CASE("Every variable of the original league can be set by its name") {
  std::vector<std::string> settings;
  for (const char* number : {"FieldLength",
                             "FieldWidth",
                             "FieldHeight",
                             "GoalWidth",
                             "GoalDepth",
                             "GoalHeight",
                             "PenaltyLength",
                             "PenaltyWidth",
                             "FreeKickDistance",
                             "FreeKickMoveDist",
                             "KickRepelDist",
                             "GoalKickDist",
                             "BorderSize",
                             "WaitBeforeKickOff",
                             "KeepawayCenterX",
                             "KeepawayCenterY",
                             "KeepawayLength",
                             "KeepawayWidth",
                             "KeepawayLengthReductionRate",
                             "KeepawayWidthReductionRate",
                             "AgentRadius",
                             "MaxRobotTypeCount",
                             "MinRobotTypesCount",
                             "MaxSumTwoRobotTypes",
                             "BallMass",
                             "RuleGoalPauseTime",
                             "RuleKickInPauseTime",
                             "RuleHalfTime",
                             "RuleDropBallTime",
                             "MaxTouchGroupSize",
                             "ChargingMinSpeed",
                             "ChargingMinBallSpeedAngle",
                             "ChargingMinDeltaDist",
                             "ChargingMinDeltaAng",
                             "ChargingImmunityTime",
                             "ChargingCollisionMinTime",
                             "ChargingMaxBallRulesDist",
                             "ChargingMinCollBallDist",
                             "ChargingMinCollisionSpeed",
                             "SelfCollisionsTolerance",
                             "SelfCollisionJointFrozenTime",
                             "SelfCollisionJointThawTime",
                             "SelfCollisionBeamCooldownTime",
                             "NotStandingMaxTime",
                             "GoalieNotStandingMaxTime",
                             "GroundMaxTime",
                             "GoalieGroundMaxTime",
                             "MaxPlayersInsideOwnArea",
                             "MinOppDistance",
                             "Min2PlDistance",
                             "Min3PlDistance",
                             "FoulHoldTime",
                             "BeamNoiseXY",
                             "BeamNoiseAngle",
                             "MaxNumSafeRepositionAttempts",
                             "PassModeMaxBallSpeed",
                             "PassModeMaxBallDist",
                             "PassModeMinOppBallDist",
                             "PassModeDuration",
                             "PassModeScoreWaitTime",
                             "PassModeRetryWaitTime"})
    settings.push_back(std::string("Soccer.") + number + "=2");
  for (const char* flag :
       {"AutomaticKickOff", "CoinTossForKickOff", "PenaltyShootout", "StartAnyFieldPosition", "AutomaticQuit",
        "ChangeSidesInSecondHalf", "Keepaway", "SingleHalfTime", "UseOffside", "TouchingFoulBeamPenalty", "UseCharging",
        "PrintSelfCollisions", "FoulOnSelfCollisions", "SelfCollisionBeamPenalty", "WriteSelfCollisionsToFile",
        "IllegalDefenseBeamPenalty", "ReportScore", "LabelMessages"})
    settings.push_back(std::string("Soccer.") + flag + "=true");
  for (const char* text : {"SelfCollisionRecordFilename", "BallRecorder", "LeftGoalRecorder", "RightGoalRecorder"})
    settings.push_back(std::string("Soccer.") + text + "=x");
  settings.push_back("Soccer.BallRadius=0.05");  // the goals must be wide enough for the ball
  const Finished f = check(settings);
  CHECK(f.errors == "");
  CHECK(f.code == 0);
  const Finished misspelt = check({"Soccer.FieldLenght=1"});
  CHECK(misspelt.code == 2);
  CHECK_THAT(misspelt.errors, Catch::Contains("FieldLenght"));
}
