#include "api/agents.h"
#include "spark/plugin.h"
#include "spark/state_fields.h"
#include "sphere/player.h"

namespace spark {

/// A sphere player inside the host: the player of the demo team as a behaviour node.
class SphereBehavior : public Behavior {
  SPARK_CLASS(SphereBehavior, Behavior)
 public:
  static void describe(Description<SphereBehavior>& d) {
    using B = SphereBehavior;
    d.doc(
        "Plays soccer with a sphere inside the host, as the external demo team does. Properties count when the agent "
        "is made.");
    d.property("team", &B::team_).doc("Name of its team.");
    d.property("unum", &B::unum_).range(1, 11).doc("Its number; 1 keeps the goal.");
    d.property("robot", &B::robot_).doc("Scene file of its robot.");
  }
  void start(Predicates& actions) override {
    player_ = SpherePlayer(team_, unum_);
    player_.setScene(robot_);
    player_.start(actions);
  }
  void think(const Predicates& percepts, Predicates& actions) override { player_.think(percepts, actions); }

 protected:
  void saveState(StateWriter& out) const override { saveFields(out, player_); }
  void loadState(StateReader& in) override { loadFields(in, player_); }

 private:
  std::string team_ = "Spark", robot_ = "rsg/agent/sphere.rsg";
  int unum_ = 1;
  SpherePlayer player_{team_, unum_};
};

}  // namespace spark

SPARK_PLUGIN("sphere-team", "1.0", "A team of spheres that plays inside the host.", spark::SphereBehavior)
