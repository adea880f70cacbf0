#include <fmt/format.h>

#include "sphere/player.h"
#include "team.h"

// A team of spheres in one process and one thread, with one connection per player.

namespace {
using spark::Predicates;

class Sphere : public spark::agent::Player {
 public:
  Sphere(const std::string& team, int unum, const std::string& robot) : team_(team), player_(team, unum) {
    player_.setScene(robot);
  }
  void start(Predicates& actions) override { player_.start(actions); }
  void think(const Predicates& percepts, Predicates& actions) override { player_.think(percepts, actions); }
  bool placed() const override { return !player_.side().empty(); }
  std::string name() const override { return fmt::format("{} {}", team_, player_.unum()); }
  std::string result() const override {
    return fmt::format("{} ({}): {}:{} after {:.2f} s", team_, player_.side(), player_.ownScore(), player_.otherScore(),
                       player_.time());
  }

 private:
  std::string team_;
  spark::SpherePlayer player_;
};
}  // namespace

int main(int argc, char** argv) {
  spark::agent::TeamProgram program("sphere-team", "A team of spheres that plays 2004-style soccer against a server.");
  std::string robot = "rsg/agent/sphere.rsg";
  program.addText("--robot", robot, "Scene file of the robot");
  return program.run(argc, argv,
                     [&](int unum) { return std::make_unique<Sphere>(program.options().team, unum, robot); });
}
