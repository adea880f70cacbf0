#include "sphere/player.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "absence.h"

// Only the player's decisions: percepts in, actions out.

using namespace spark;
using spark::test::lacks;

namespace {

/// The percepts of a player at (x, y) without noise, in the team's own frame: the marks of its own side are behind.
struct World {
  bool right = false;  ///< the player's team defends the right goal
  double now = 1, x = -5, y = 0, ballX = 0, ballY = 0;
  std::string mode = "PlayOn", announce, others;

  static std::string pol(double dx, double dy) {
    return "(pol " + std::to_string(std::hypot(dx, dy)) + " " + std::to_string(std::atan2(dy, dx) * 180 / M_PI) + " 0)";
  }
  std::string mark(const std::string& name, double mx, double my) const {
    return "(" + name + " " + pol(mx - x, my - y) + ")";
  }
  void other(const std::string& team, int unum, double px, double py) {
    others += "(P (team " + team + ") (id " + std::to_string(unum) + ") " + pol(px - x, py - y) + ")";
  }
  std::string text() const {
    const double own = right ? 52 : -52;  // where the marks of the left goal are
    return "(time (now " + std::to_string(now) + "))(GS " + announce + "(sl 2) (sr 1) (t 1) (pm " + mode + "))(See " +
           mark("F1L", own, -own * 34 / 52) + mark("F2L", own, own * 34 / 52) + mark("F1R", -own, -own * 34 / 52) +
           mark("F2R", -own, own * 34 / 52) + mark("G1L", own, -own * 3.66 / 52) + mark("G2L", own, own * 3.66 / 52) +
           mark("G1R", -own, -own * 3.66 / 52) + mark("G2R", -own, own * 3.66 / 52) + mark("B", ballX, ballY) + others +
           ")";
  }
};

std::string think(SpherePlayer& player, const World& world) {
  Predicates percepts, actions;
  REQUIRE(readSexp(world.text(), percepts).message.empty());
  player.think(percepts, actions);
  std::string out;
  writeSexp(actions, 2, out);
  return out;
}

/// The argument `i` of the action `name`, NaN if the player did not choose this action.
double argument(const std::string& actions, std::string_view name, std::size_t i) {
  Predicates p;
  readSexp(actions, p);
  for (const Element e : p)
    if (e.head() == name) return e.at(i).number();
  return NAN;
}

/// A player that has received its side.
SpherePlayer playing(int unum, World& world, const std::string& side = "left") {
  SpherePlayer player("A", unum);
  world.right = side == "right";
  world.announce = "(unum " + std::to_string(unum) + ") (team " + side + ") ";
  think(player, world);
  world.announce.clear();
  world.now += 0.02;
  return player;
}

}  // namespace

TEST_CASE("a player requests its robot, then its number and team, and repeats that after a while", "[sphere-team]") {
  SpherePlayer player("A", 7);
  player.setScene("rsg/agent/other.rsg");
  Predicates actions;
  player.start(actions);
  std::string text;
  writeSexp(actions, 2, text);
  CHECK(text == "(scene rsg/agent/other.rsg)");
  World w;
  CHECK(think(player, w) == "(init (unum 7) (teamname A))");
  w.now += 0.5;
  CHECK(think(player, w).empty());
  w.now += 0.6;
  CHECK(think(player, w) == "(init (unum 7) (teamname A))");
}

TEST_CASE("a player knows the score from its own side", "[sphere-team]") {
  World w;
  const SpherePlayer left = playing(3, w), right = playing(3, w, "right");
  CHECK(left.ownScore() == 2);
  CHECK(left.otherScore() == 1);
  CHECK(right.ownScore() == 1);
  CHECK(right.otherScore() == 2);
  CHECK(right.side() == "right");
}

TEST_CASE("before the kick-off a player beams to its position once", "[sphere-team]") {
  World w;
  w.mode = "BeforeKickOff";
  SpherePlayer player("A", 2);
  w.announce = "(unum 2) (team left) ";
  const std::string first = think(player, w);
  CHECK(argument(first, "beam", 1) < -30);
  CHECK(argument(first, "beam", 2) > 10);
  CHECK(lacks(think(player, w), "beam", first));
}

TEST_CASE("the nearest player runs to the ball, another one does not", "[sphere-team]") {
  World w;
  w.x = -10;
  SpherePlayer near = playing(10, w);
  w.other("A", 9, -30, 10);
  const std::string running = think(near, w);
  CHECK(argument(running, "drive", 1) > 50);
  // At its position in the formation, with a team-mate nearer to the ball.
  w.others.clear();
  w.x = -4.5, w.y = 0.5;
  w.other("A", 9, -2, 0);
  CHECK(argument(think(near, w), "drive", 1) < 10);
}

TEST_CASE("behind the ball a player kicks towards the goal, and in front of it runs around the ball", "[sphere-team]") {
  World w;
  w.ballX = 35, w.x = 34.66;
  SpherePlayer player = playing(9, w);
  const std::string shot = think(player, w);
  CHECK(argument(shot, "kick", 2) > 5);
  w.x = 35.5;
  const std::string round = think(player, w);
  CHECK(lacks(round, "kick", shot));
  CHECK(argument(round, "drive", 1) < 0);
}

TEST_CASE("at the opponents' restart a player keeps away from the ball", "[sphere-team]") {
  World w;
  w.mode = "KickIn_Right";
  w.ballX = -20, w.ballY = 33, w.x = -22, w.y = 30;
  SpherePlayer player = playing(5, w);
  CHECK(argument(think(player, w), "drive", 2) < 0);
  w.x = -20.31, w.y = 33.14;  // where it kicks in play
  const std::string away = think(player, w);
  w.mode = "PlayOn";
  CHECK(lacks(away, "kick", think(player, w)));
}

TEST_CASE("the player that took a restart leaves the ball to a team-mate", "[sphere-team]") {
  World w;
  w.mode = "KickIn_Left";
  w.ballX = -20, w.ballY = 33, w.x = -20.31, w.y = 33.14;
  SpherePlayer taker = playing(7, w);
  w.other("A", 8, -40, 20);
  think(taker, w);
  w.mode = "PlayOn";
  w.now += 0.06;
  const std::string rest = think(taker, w);
  SpherePlayer other = playing(7, w);  // did not take it
  CHECK(lacks(rest, "kick", think(other, w)));
  // It may approach the ball again later.
  w.now += 4;
  w.y = 30;
  CHECK(argument(think(taker, w), "drive", 2) > 10);
}

TEST_CASE("the goalie moves between ball and goal and catches a close ball", "[sphere-team]") {
  World w;
  w.x = -48, w.y = -10, w.ballX = -20, w.ballY = 20;
  SpherePlayer goalie = playing(1, w);
  const std::string home = think(goalie, w);
  CHECK(argument(home, "drive", 1) < 0);
  CHECK(argument(home, "drive", 2) > 20);
  w.ballX = -47.4, w.ballY = -10;
  w.now += 0.06;
  CHECK(think(goalie, w) == "(catch )");
}

TEST_CASE("after the match a player does not move", "[sphere-team]") {
  World w;
  SpherePlayer player = playing(4, w);
  w.mode = "GameOver";
  CHECK(think(player, w) == "(drive 0.00 0.00 0.00)");
}
