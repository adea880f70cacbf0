// Before the kick-off, and the kick-off itself.
#include "stadium.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("Agents join, are told their team once, and stand at the start positions") {
  Stadium s;
  Player& a = s.join("A", 1);
  Player& b = s.join("B", 7);
  CHECK(a.side == Side::left);
  CHECK(b.side == Side::right);
  CHECK(s.monitor().text("team_left") == "A");
  CHECK(s.monitor().text("team_right") == "B");
  CHECK(s.at(a).x() == Approx(-14.2).margin(0.05));
  CHECK(s.at(b).x() == Approx(14.2).margin(0.05));
  CHECK(a.gs("pm") == "BeforeKickOff");
  CHECK(a.gs("unum").empty());
  CHECK(a.gs("t") == "0.00");
}
