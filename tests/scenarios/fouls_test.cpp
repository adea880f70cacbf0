// The automatic referee in a match: every foul, caused by trainer commands and checked in monitor messages.
#include "stadium.h"

using namespace spark;
using namespace spark::test;

namespace {

constexpr double kLying = 0.2, kCrouching = 0.4, kStanding = 0.6;  // m: heights of robots

/// A match in PlayOn with the ball far away at (0, -9).
struct FoulMatch : Stadium {
  using Stadium::Stadium;
  /// The fouls since the last call: "index type team unum".
  std::vector<std::string> fouls() {
    std::vector<std::string> out;
    for (; seen_ < monitor().fouls().size(); ++seen_) {
      const auto& f = monitor().fouls()[seen_];
      out.push_back(fmt::format("{} {} {} {}", f.index, f.type, f.team, f.unum));
    }
    return out;
  }
  void play() { trainer("(playMode PlayOn)" + ballTo(0, -9)); }
  bool isAt(const Player& p, double x, double y, double tolerance = 0.01) {
    run(1);  // a move by the referee shows in the next cycle
    const Vec3 here = at(p);
    INFO("number " << p.unum << " is at " << here.transpose());
    CHECK(std::abs(here.x() - x) < tolerance);
    CHECK(std::abs(here.y() - y) < tolerance);
    return true;
  }

 private:
  std::size_t seen_ = 0;
};

using Fouls = std::vector<std::string>;

/// `count` records of one foul, starting at index `from`.
Fouls records(int from, int count, const std::string& rest) {
  Fouls out;
  for (int i = 0; i < count; ++i) out.push_back(std::to_string(from + i) + " " + rest);
  return out;
}

}  // namespace

TEST_CASE("A player on the ground for 15 s is lifted for half a second and then moved off the field") {
  FoulMatch s({{"Soccer.GoalieGroundMaxTime", 17}});
  Player& goalie = s.join("A", 1, kLying);
  Player& a = s.join("A", 4, kLying);
  Player& b = s.join("B", 4, kLying);
  s.trainer("(playMode PlayOn)" + s.ballTo(0, -9) + s.put(goalie, -10, 0, 0.1) + s.put(a, -5, 3, 0.1) +
            s.put(b, 5, 3, 0.1));
  const double from = s.time();
  s.run(749);
  CHECK(s.fouls().empty());
  s.run(1);
  CHECK(s.fouls() == Fouls{"1 4 1 4", "2 4 2 4"});
  CHECK(s.time() - from == Approx(15.0).margin(0.001));
  // Monitors see the pose one step of free fall later.
  s.run(1);
  CHECK(s.at(a).z() == Approx(1.006).margin(0.001));
  s.run(23);
  CHECK(s.fouls().size() == 48);
  s.run(1);
  CHECK(s.at(a).z() == Approx(1.246).margin(0.001));
  CHECK(s.at(a).x() == Approx(-5).margin(0.01));
  CHECK(s.fouls().empty());
  s.isAt(a, -1.8, 10.5);
  s.isAt(b, 1.8, 10.5);
  // The goalie has more time; players off the field are not judged.
  s.run(850 - 778);
  CHECK(s.fouls().empty());
  s.run(1);
  CHECK(s.fouls() == Fouls{"51 4 1 1"});
  CHECK(s.time() - from == Approx(17.0));
}

TEST_CASE("A player that does not stand up in time is removed, and half a second of standing prevents it") {
  FoulMatch s({{"Soccer.NotStandingMaxTime", 6}, {"Soccer.GoalieNotStandingMaxTime", 12}});
  Player& a = s.join("A", 2, kCrouching);
  Player& lucky = s.join("A", 3, kCrouching);
  Player& goalie = s.join("B", 1, kCrouching);
  s.trainer("(playMode PlayOn)" + s.ballTo(0, -9) + s.put(goalie, 10, 0, 0.2) + s.put(a, -5, 3, 0.2) +
            s.put(lucky, -5, -3, 0.2));
  s.run(200);
  for (int i = 0; i < 27; ++i) s.trainer(s.put(lucky, -5, -3, 0.5));
  s.run(299 - 227);
  CHECK(s.fouls().empty());
  s.run(1);
  CHECK(s.fouls() == Fouls{"1 4 1 2"});
  s.run(24);
  CHECK(s.fouls() == records(2, 24, "4 1 2"));
  s.run(228 + 302 - 326);
  CHECK(s.fouls().empty());
  s.run(20);
  CHECK(s.fouls().at(0) == "26 4 1 3");
  s.run(600 - 549);
  CHECK(s.fouls().size() < 25);
  s.run(1);
  CHECK(s.fouls() == Fouls{"51 4 2 1"});
}

TEST_CASE("The fourth player in its own area is moved across the nearest edge, and another when the goalie enters") {
  FoulMatch s;
  std::deque<Player*> a;
  for (int n = 1; n <= 5; ++n) a.push_back(&s.join("A", n, kStanding));
  s.play();
  s.trainer(s.put(*a[1], -13.6, 1) + s.put(*a[2], -14.5, 0) + s.put(*a[3], -14.5, -1.5) + s.put(*a[4], -10, 0) +
            s.put(*a[0], -10, 2));
  s.seconds(1);
  CHECK(s.fouls().empty());
  s.trainer(s.put(*a[4], -13.5, -0.5));
  CHECK(s.fouls() == Fouls{"1 2 1 5"});
  s.isAt(*a[4], -12.8, -0.5);
  s.trainer(s.put(*a[0], -13.4, 0));
  CHECK(s.fouls() == Fouls{"2 2 1 2"});
  s.isAt(*a[1], -12.8, 1);
  s.seconds(1);
  CHECK(s.fouls().empty());
  s.trainer(s.put(*a[4], -14, 2.9));
  CHECK(s.fouls() == Fouls{"3 2 1 5"});
  s.isAt(*a[4], -14, 3.4);
}

TEST_CASE("The third player in a group of touching players must leave it") {
  FoulMatch s;
  Player& a2 = s.join("A", 2, kStanding);
  Player& a3 = s.join("A", 3, kStanding);
  Player& b2 = s.join("B", 2, kStanding);
  s.play();
  const auto stand = [&](Player* third) {
    s.trainer(s.put(a2, 0, 0) + s.put(third == &b2 ? a3 : b2, 0.298, 0) +
              (third ? s.put(*third, -0.298, 0) : std::string()));
  };
  SECTION("the last to join is moved if its team has two of three") {
    stand(nullptr), stand(nullptr), stand(&a3);
    CHECK(s.fouls() == Fouls{"1 1 1 3"});
    s.isAt(a3, -0.698, 0, 0.02);
  }
  SECTION("an opponent of the last to join is moved if the last one's team has one of three") {
    s.trainer(s.put(a2, 0, 0) + s.put(a3, 0.298, 0));
    stand(&b2);
    const Fouls fouls = s.fouls();
    REQUIRE(fouls.size() == 1);
    CHECK((fouls[0] == "1 1 1 2" || fouls[0] == "1 1 1 3"));
  }
}

namespace {
/// `runner` flies from +x at `speed` m/s into `other` at the origin; they touch in the last of these cycles.
void flyInto(FoulMatch& s, Player& runner, Player& other, double speed) {
  s.command(s.put(runner, 0.3 + 2.5 * speed * FoulMatch::kStep, 0, 0.4) + s.put(other, 0, 0));
  s.run(1);
  s.act(runner, fmt::format("(force {} 0 0)", -4 * speed / FoulMatch::kStep));
  s.run(4);
}
}  // namespace

TEST_CASE("A player that runs into an opponent is sent off unless it is slow or has just played the ball") {
  FoulMatch s;
  Player& a = s.join("A", 2, kStanding);
  Player& b = s.join("B", 3, kStanding);
  s.play();
  SECTION("far from the ball") {
    flyInto(s, b, a, 1.0);
    const Fouls fouls = s.fouls();
    REQUIRE(!fouls.empty());
    CHECK(fouls[0] == "1 6 2 3");
    s.run(25);
    s.isAt(b, 2.4, 10.5);
  }
  SECTION("slowly") {
    flyInto(s, b, a, 0.3);
    CHECK(s.fouls().empty());
  }
  SECTION("after a touch of the ball") {
    s.trainer(s.ballTo(5, 0));
    s.trainer(s.against(b, 1));
    s.trainer(s.ballTo(0, -9));
    s.run(20);
    flyInto(s, b, a, 1.0);
    CHECK(s.fouls().empty());
    s.trainer(s.put(b, 5, 0));
    s.run(30);
    flyInto(s, b, a, 1.0);
    CHECK(s.fouls().at(0) == "1 6 2 3");
  }
  SECTION("after a trainer moved the opponent") {
    s.trainer("(repos (unum 2)(team Left))");
    flyInto(s, b, a, 1.0);
    CHECK(s.fouls().empty());
  }
}

TEST_CASE("With the historic distances the second player of a team near a contested ball is sent off") {
  FoulMatch s({{"Soccer.MinOppDistance", 0.8}, {"Soccer.Min2PlDistance", 0.4}, {"Soccer.Min3PlDistance", 1.0}});
  Player& a2 = s.join("A", 2, kStanding);
  Player& a3 = s.join("A", 3, kStanding);
  Player& b2 = s.join("B", 2, kStanding);
  s.play();
  s.trainer(s.put(a2, -0.3, -9) + s.put(b2, 0.6, -9) + s.put(a3, 0, -8.4));
  CHECK(s.fouls().empty());
  s.trainer(s.put(a3, 0, -8.62));
  CHECK(s.fouls() == Fouls{"1 0 1 3"});
  s.run(25);
  s.isAt(a3, -2.4, 10.5);
}

TEST_CASE("In later server versions a player may hold the ball near an opponent for 5 s") {
  FoulMatch s(Stadium::Settings{{"compat", "L"}});
  Player& a = s.join("A", 2, kStanding);
  Player& b = s.join("B", 2, kStanding);
  s.trainer("(playMode PlayOn)" + s.put(b, 0.6, 0));
  for (int i = 0; i < 250; ++i) s.trainer(s.put(a, 0, 0, 0.4) + s.ballTo(0.1, 0));  // the ball is below the player
  CHECK(s.fouls().empty());
  s.trainer(s.put(a, 0, 0, 0.4) + s.ballTo(0.1, 0));
  CHECK(s.fouls() == Fouls{"1 8 1 2"});
}

TEST_CASE("No foul is judged before the kick-off and after a goal, and the timers restart") {
  FoulMatch s({{"Soccer.GroundMaxTime", 4}});
  Player& a = s.join("A", 2, kLying);
  s.trainer(s.put(a, -5, 0, 0.1));
  s.seconds(5);
  CHECK(s.fouls().empty());
  s.play();
  s.seconds(3.5);
  s.trainer("(playMode Goal_Left)");
  CHECK(s.until("KickOff_Right", 4) > 0);
  s.trainer("(playMode PlayOn)");
  s.seconds(3.5);
  CHECK(s.fouls().empty());
  s.seconds(0.5);
  CHECK(s.fouls().at(0) == "1 4 1 2");
}

TEST_CASE("A removed player whose target is occupied is placed one radius further away") {
  FoulMatch s({{"Soccer.GroundMaxTime", 4}});
  Player& a = s.join("A", 4, kLying);
  Player& b = s.join("B", 2, kStanding);
  s.trainer("(playMode PlayOn)" + s.ballTo(0, -9) + s.put(a, -5, 3, 0.1) + s.put(b, -1.8, 10.5));
  s.run(200 + 25);
  s.isAt(a, -2.6, 10.5);
}

namespace {
/// The angle of a hinge in the last message [deg].
double hinge(const Player& p, const std::string& name) {
  Predicates percepts;
  readSexp(p.last, percepts);
  for (const Element e : percepts)
    if (e.head() == "HJ" && e.named("n").at(1).text() == name) return e.named("ax").at(1).number();
  FAIL("no hinge " << name);
  return 0;
}
}  // namespace

TEST_CASE("A Nao whose feet collide has its legs frozen for 1 s and is exempt for the next 2 s") {
  FoulMatch s;
  Player& p = s.connect();
  s.act(p, "(scene rsg/agent/nao/nao.rsg)");
  s.run(3);
  s.act(p, "(init (unum 2)(teamname A))");
  s.run(3);
  p.side = Side::left, p.unum = 2;
  s.play();
  // The robot is held in the air, so only its legs move.
  const auto cycle = [&](const std::string& actions) {
    s.act(p, actions);
    s.trainer(s.put(p, -5, 0, 1));
  };
  s.trainer("(time 20)");  // from 16 s to 64 s the single-precision time of play does not lag
  int cycles = 0;
  for (; s.fouls().empty() && cycles < 100; ++cycles) cycle("(rle2 2)(lle2 -2)(rle1 -2)(lle3 2)");
  REQUIRE(cycles < 100);
  CHECK(s.monitor().fouls().back().type == 7);
  CHECK(s.monitor().fouls().back().unum == 2);
  const double away = hinge(p, "rlj2") > 0 ? -2 : 2;
  const auto apart = [&] { cycle(fmt::format("(rle2 {})(lle2 {})(rle1 0)(lle3 0)", away, -away)); };
  apart(), apart();
  const double frozen = hinge(p, "rlj2");
  for (int i = 0; i < 48; ++i) apart();
  CHECK(hinge(p, "rlj2") == Approx(frozen).margin(0.5));
  for (int i = 0; i < 4; ++i) apart();
  CHECK(std::abs(hinge(p, "rlj2") - frozen) > 2);
  // Together again: exempt for 2 s after the legs are released.
  for (int i = 0; i < 90; ++i) cycle("(rle2 1)(lle2 -1)");
  CHECK(s.fouls().empty());
  for (int i = 0; i < 10; ++i) cycle("(rle2 1)(lle2 -1)");
  CHECK(s.fouls() == Fouls{"2 7 1 2"});
}
