#pragma once
/// \file
/// Two against two, the start of most scenarios.

#include "stadium.h"

namespace spark::test {

/// A1, A2 of the left team and B1, B2 of the right one, each in a corner of its half; PlayOn with the ball at rest at
/// the center.
struct Match : Stadium {
  explicit Match(const Settings& settings = {})
      : Stadium(settings), a1(join("A", 1)), a2(join("A", 2)), b1(join("B", 1)), b2(join("B", 2)) {
    trainer("(playMode PlayOn)" + apart() + ballTo(0, 0));
    run(5);
  }
  Player &a1, &a2, &b1, &b2;

  std::string apart() const { return put(a1, -8, 7) + put(a2, -8, -7) + put(b1, 8, 7) + put(b2, 8, -7); }
  /// The player touches the ball once. Then all players are apart and the commands act.
  void touchThen(const Player& p, const std::string& commands) {
    trainer(against(p));
    trainer(apart() + commands);
  }
  /// The player is moved against the ball and stays there.
  void touch(const Player& p, double side = -1) { trainer(against(p, side)); }
  void checkAt(const Player& p, double x, double y, double margin = 0.06) {
    const Vec3 where = at(p);
    CHECK(where.x() == Approx(x).margin(margin));
    CHECK(where.y() == Approx(y).margin(margin));
  }
  void checkBall(double x, double y, double margin = 0.02) {
    const Vec3 where = ball();
    CHECK(where.x() == Approx(x).margin(margin));
    CHECK(where.y() == Approx(y).margin(margin));
  }
  /// Checks that all players receive the mode, one cycle after it began.
  void checkModeSent(const std::string& mode) {
    run(1);
    for (const Player* p : {&a1, &a2, &b1, &b2}) CHECK(p->gs("pm") == mode);
  }
};

/// Moves the ball behind the goal line.
inline const std::string kInRightGoal = Match::ballTo(15.3, 0.2, 0.1), kInLeftGoal = Match::ballTo(-15.3, 0.2, 0.1);

}  // namespace spark::test
