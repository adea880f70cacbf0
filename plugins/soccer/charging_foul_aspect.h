#pragma once

#include <array>

#include "foul_aspect.h"

namespace spark {

/// Charging: a player runs into an opponent. The rule of the installed base. It judges each pair of opponents that
/// touch while both are upright, neither serves a penalty and the referee has moved neither within the last second:
///
///  1. Conduct. If the ball is within ChargingMaxBallRulesDist of one of them, a player charges when it moves towards
///     the opponent rather than towards the ball. If neither does, the player farther from the ball charges when it
///     moves more directly towards the other, or when the other is slow. If the ball is far away, both may charge.
///  2. Speed. A player that charges has at least ChargingMinSpeed, and ChargingMinCollisionSpeed towards the contact.
///  3. No foul if both charge, or if the contact is within ChargingMinCollBallDist of the ball. Immune for
///     ChargingImmunityTime are players that touched the ball and players that an immune one has charged; always immune
///     is a goalie in its own area. A contact that continues a harmless one is harmless, too.
class ChargingFoulAspect : public FoulAspect {
  SPARK_CLASS(ChargingFoulAspect, FoulAspect)
 public:
  static void describe(Description<ChargingFoulAspect>& d) {
    d.doc("Running into an opponent is a foul; off with Soccer.UseCharging false.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  using Vec2 = Eigen::Vector2d;
  using Pair = PlayerContactAspect::Pair;
  static constexpr int kCycles = 3;          ///< over which velocities are averaged
  static constexpr double kMovedTime = 1.0;  ///< immunity after a move by the referee [s]
  static constexpr double kLongAgo = -1e9;   ///< s

  /// The history of a player. Times are simulated times [s].
  struct History {
    std::array<Vec2, kCycles> velocities{Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)};  ///< of the torso [m/s], newest first
    int known = 0;                                                             ///< number of velocities
    double touchedBall = kLongAgo;                                             ///< last touch of the ball
    double wasCharged = kLongAgo;                                              ///< last charge by an immune player
    Vec2 velocity() const { return known ? Vec2((velocities[0] + velocities[1] + velocities[2]) / known) : Vec2(0, 0); }
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  /// Motion of one player of a pair, on the ground plane.
  struct Motion {
    std::size_t player;       ///< index
    Vec2 position, velocity;  ///< m, m/s
    double speed;             ///< m/s
    double ballDistance;      ///< m
    double ballAngle;         ///< between the velocity and the direction to the ball [deg]
    double opponentAngle;     ///< between the velocity and the direction to the opponent [deg]
  };
  /// A contact that was no foul.
  struct HarmlessContact {
    int a, b;     ///< numbers of the agents
    double time;  ///< simulated time of the last contact [s]
  };

  void updateHistories(double now);
  void judgePair(const Pair& contact, double now);
  /// The player may be judged: it is upright, serves no penalty and was not moved by the referee.
  bool isEligible(std::size_t player) const;
  Motion motion(std::size_t player, std::size_t opponent) const;
  /// Step 1: which of the two charges by its conduct.
  std::array<bool, 2> chargesByConduct(const std::array<Motion, 2>& pair) const;
  /// Step 2: `self` is fast enough, also towards the point midway between `contact` and `other`.
  bool isFastEnough(const Motion& self, const Motion& other, const Vec2& contact) const;
  bool isImmune(std::size_t player, double now) const;
  /// True when the contact continues a harmless one, which is then prolonged.
  bool continuesHarmless(const Pair& contact, double now);

  soccer::PlayerRecords<History> histories_;
  std::vector<HarmlessContact> harmless_;
};

}  // namespace spark
