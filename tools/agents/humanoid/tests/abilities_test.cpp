#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "api/physics.h"
#include "humanoid/nao.h"
#include "spark/script_server.h"
#include "test_support.h"

// What one player of each type can do, alone on the field of lua/soccer.lua. Physics by the articulated solver, no
// clock, no sockets: the same in every run.

using namespace spark;

namespace {
enum class Lie { belly, back, left, right };

class Solo : public test::House {
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
    run(1);  // it has found its place
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
  Vec3 place() const { return torso_->state().position; }
  bool stands() const { return place().z() > 0.29 && torso_->state().rotation(2, 2) > 0.8; }
  Vec3 ball() const { return ball_->state().position; }
  void placeBall(const Vec3& where) {
    spark::Pose pose;
    pose.position = where;
    ball_->setPose(pose);
    ball_->setVelocity(Vec3::Zero());
    ball_->setAngularVelocity(Vec3::Zero());
  }
  std::string mode() { return getProperty(game(), "playMode").toString(); }

  /// Turns the robot as it is about its torso, and drops it from a hand's breadth.
  void lay(Lie lie) {
    constexpr double quarter = humanoid::kPi / 2;
    const Vec3 middle = place(), forward = torso_->state().rotation.col(1), right = torso_->state().rotation.col(0);
    const auto turn = lie == Lie::belly  ? Eigen::AngleAxisd(-quarter, right)
                      : lie == Lie::back ? Eigen::AngleAxisd(quarter, right)
                                         : Eigen::AngleAxisd(lie == Lie::right ? quarter : -quarter, forward);
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

/// s from being laid down until it has stood for one; 99: not within 15 s.
double secondsToStand(Solo& solo, Lie lie) {
  solo.lay(lie);
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
  for (const Lie lie : {Lie::belly, Lie::back, Lie::left, Lie::right}) {
    const double took = secondsToStand(solo, lie);
    CAPTURE(type, static_cast<int>(lie), took);
    CHECK(took < 12);
  }
}

TEST_CASE("Each type walks seven metres without a fall, takes the ball along and scores") {
  const int type = GENERATE(0, 1, 2, 3, 4);
  Solo solo(type);
  solo.placeBall({6, 0.5, 0.042});
  double t = 0, lowest = 1;
  for (; t < 150 && solo.mode() != "Goal_Left"; t += 0.1) {
    solo.run(0.1);
    if (solo.place().x() < 5) lowest = std::min(lowest, solo.place().z());
  }
  CAPTURE(type, t, lowest, solo.place().transpose(), solo.ball().transpose());
  CHECK(lowest > 0.28);
  CHECK(solo.mode() == "Goal_Left");
}
