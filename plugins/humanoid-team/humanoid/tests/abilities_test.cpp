#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "api/physics.h"
#include "humanoid/nao.h"
#include "spark/script_server.h"
#include "test_support.h"

// The abilities of a single player of each type on the field of lua/soccer.lua. Physics by the articulated solver, no
// real time, no sockets: every run is the same.

using namespace spark;

namespace {
enum class LyingOn { belly, back, left, right };

class Solo : public test::TestHost {
 public:
  explicit Solo(int type) {
    kernel.log().setLevel(Level::warning);
    ScriptServer& lua = scripts(kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = {}, alone = true }", "abilities");
    for (const char* port : {"agents", "monitors"}) lua.addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
    lua.addOverride("/sys/server/simulation.rate", "max");
    lua.addOverride("solver", "articulated");
    lua.runConfig("soccer.lua");
    lua.run(fmt::format("plugin 'humanoid-team' local p = new('HumanoidBehavior', '/usr/agent/one') p.team, p.unum, "
                        "p.type = 'Red', 10, {}",
                        type),
            "abilities");
    run(1);  // it has beamed to its start position
    kernel.root().require<IPhysicsServer>("/sys/server/physics").bodies(kernel.root(), bodies_);
    ball_ = &kernel.root().require<IRigidBody>("/usr/scene/Ball/physics");
    std::erase(bodies_, ball_);
    for (IRigidBody* b : bodies_)
      if (b->leaf().path().ends_with("/body/boxBody")) torso_ = b;
    setProperty(game(), "playMode", "PlayOn");
  }
  void run(double seconds) {
    callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles",
               std::vector<Value>{Value(static_cast<std::int64_t>(seconds / 0.02 + 0.5))});
  }
  Vec3 position() const { return torso_->state().position; }
  bool stands() const { return position().z() > 0.29 && torso_->state().rotation(2, 2) > 0.8; }
  Vec3 ball() const { return ball_->state().position; }
  void placeBall(const Vec3& where) {
    spark::Pose pose;
    pose.position = where;
    ball_->setPose(pose);
    ball_->setVelocity(Vec3::Zero());
    ball_->setAngularVelocity(Vec3::Zero());
  }
  std::string mode() { return getProperty(game(), "playMode").toString(); }

  /// Rotates the robot about its torso without changing its joints, and drops it from a low height.
  void layDown(LyingOn lyingOn) {
    constexpr double quarter = humanoid::kPi / 2;
    const Vec3 middle = position(), forward = torso_->state().rotation.col(1), right = torso_->state().rotation.col(0);
    const auto turn = lyingOn == LyingOn::belly ? Eigen::AngleAxisd(-quarter, right)
                      : lyingOn == LyingOn::back
                          ? Eigen::AngleAxisd(quarter, right)
                          : Eigen::AngleAxisd(lyingOn == LyingOn::right ? quarter : -quarter, forward);
    std::vector<spark::Pose> poses;
    double lowest = 1;
    for (IRigidBody* b : bodies_) {
      spark::Pose& pose = poses.emplace_back();
      pose.position = middle + turn * (b->state().position - middle);
      pose.rotation = turn.toRotationMatrix() * b->state().rotation;
      lowest = std::min(lowest, pose.position.z());
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      poses[i].position.z() += 0.12 - lowest;
      bodies_[i]->setPose(poses[i]);
      bodies_[i]->setVelocity(Vec3::Zero());
      bodies_[i]->setAngularVelocity(Vec3::Zero());
    }
  }

 private:
  Leaf& game() { return kernel.root().require<Leaf>("/sys/server/gamecontrol/GameStateAspect"); }
  std::vector<IRigidBody*> bodies_;
  IRigidBody *torso_ = nullptr, *ball_ = nullptr;
};

/// Time from lying until it has been upright for one second [s]; 99: not within 15 s.
double secondsToStand(Solo& solo, LyingOn lyingOn) {
  solo.layDown(lyingOn);
  solo.run(0.4);
  double standing = 0, t = 0.4;
  for (; t < 15 && standing < 1; t += 0.1) {
    solo.run(0.1);
    standing = solo.stands() ? standing + 0.1 : 0;
  }
  return standing < 1 ? 99 : t - standing;
}
}  // namespace

TEST_CASE("Each type gets up from belly, back and both sides") {
  const int type = GENERATE(0, 1, 2, 3, 4);
  Solo solo(type);
  solo.placeBall({0, 9, 0.042});
  solo.run(1);
  REQUIRE(solo.stands());
  for (const LyingOn lyingOn : {LyingOn::belly, LyingOn::back, LyingOn::left, LyingOn::right}) {
    const double took = secondsToStand(solo, lyingOn);
    CAPTURE(type, static_cast<int>(lyingOn), took);
    CHECK(took < 12);
  }
}

TEST_CASE("Each type walks seven meters without a fall, dribbles the ball and scores") {
  const int type = GENERATE(0, 1, 2, 3, 4);
  Solo solo(type);
  solo.placeBall({6, 0.5, 0.042});
  double t = 0, lowest = 1;
  for (; t < 150 && solo.mode() != "Goal_Left"; t += 0.1) {
    solo.run(0.1);
    if (solo.position().x() < 5) lowest = std::min(lowest, solo.position().z());
  }
  CAPTURE(type, t, lowest, solo.position().transpose(), solo.ball().transpose());
  CHECK(lowest > 0.28);
  CHECK(solo.mode() == "Goal_Left");
}
