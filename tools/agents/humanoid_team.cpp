#include <fmt/format.h>

#include "humanoid/player.h"
#include "team.h"

// A team of Naos in one process and one thread, with one connection per player.

namespace {
using spark::Predicates;

class Humanoid : public spark::agent::Player {
 public:
  Humanoid(const std::string& team, int unum, int type) : team_(team), player_(team, unum, type) {}
  void start(Predicates& actions) override {
    player_.start(actions);
    actions.open("syn").close();
  }
  void think(const Predicates& percepts, Predicates& actions) override { player_.think(percepts, actions); }
  bool placed() const override { return !player_.percepts().side.empty(); }
  std::string name() const override { return fmt::format("{} {}", team_, player_.unum()); }
  std::string result() const override {
    const humanoid::Percepts& p = player_.percepts();
    const bool right = p.side == "right";
    return fmt::format("{} ({}): {}:{} after {:.2f} s, {}", team_, p.side, right ? p.scoreRight : p.scoreLeft,
                       right ? p.scoreLeft : p.scoreRight, p.gameTime, p.playMode);
  }

 private:
  std::string team_;
  humanoid::HumanoidPlayer player_;
};
}  // namespace

int main(int argc, char** argv) {
  spark::agent::TeamProgram program("humanoid-team", "A team of Naos that plays soccer against a server.");
  int type = -1;
  program.addNumber("--type", type, 0, 4, "Robot type of all players; else mixed within the league's limits");
  return program.run(argc, argv, [&](int unum) {
    return std::make_unique<Humanoid>(program.options().team, unum, type >= 0 ? type : humanoid::robotType(unum));
  });
}
