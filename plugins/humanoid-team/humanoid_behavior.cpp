#include <optional>

#include "api/agents.h"
#include "humanoid/player.h"
#include "spark/plugin.h"
#include "spark/state_fields.h"

namespace spark {

/// A humanoid player inside the host: the player of the demo team as a behaviour node.
class HumanoidBehavior : public Behavior {
  SPARK_CLASS(HumanoidBehavior, Behavior)
 public:
  static void describe(Description<HumanoidBehavior>& d) {
    using B = HumanoidBehavior;
    d.doc(
        "Plays soccer with a Nao inside the host, as the external demo team does. Properties count when the agent is "
        "made.");
    d.property("team", &B::team_).doc("Name of its team.");
    d.property("unum", &B::unum_).range(1, 11).doc("Its number; 1 keeps the goal.");
    d.property("type", &B::type_)
        .range(-1, 4)
        .doc("Type of its robot; -1: the one that the demo team has for this number; all five types play.");
  }
  void start(Predicates& actions) override { makePlayer().start(actions); }
  void think(const Predicates& percepts, Predicates& actions) override { player_->think(percepts, actions); }

 protected:
  void saveState(StateWriter& out) const override {
    out.write(player_.has_value());
    if (player_) saveFields(out, *player_);
  }
  void loadState(StateReader& in) override {
    player_.reset();
    if (in.readBool()) loadFields(in, makePlayer());
  }

 private:
  humanoid::HumanoidPlayer& makePlayer() {
    return player_.emplace(team_, unum_, type_ >= 0 ? type_ : humanoid::robotType(unum_));
  }
  std::string team_ = "Spark";
  int unum_ = 1, type_ = -1;
  std::optional<humanoid::HumanoidPlayer> player_;
};

}  // namespace spark

SPARK_PLUGIN("humanoid-team", "1.0", "A team of humanoids that plays inside the host.", spark::HumanoidBehavior)
