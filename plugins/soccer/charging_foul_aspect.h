#pragma once

#include <array>

#include "foul_aspect.h"

namespace spark {

/// Running into an opponent (protocol section 6.7). For each pair of standing opponents who touch, neither of them just
/// moved by the referee nor under a penalty:
///
///  1. Conduct. With the ball near to one of them, who moves rather towards the opponent than towards the ball charges;
///  if neither does,
///     the one farther from the ball who runs straighter into the other, or into one who stands. Far from the ball both
///     may.
///  2. It takes speed, and speed towards the contact.
///  3. Both, or a contact at the ball: nobody. Also spared: a goalie in his own area, who has just touched the ball,
///  whom such a spared
///     player has just charged; and contacts that go on after a harmless one.
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
  using Meeting = PlayerContactAspect::Meeting;
  static constexpr int kCycles = 3;          ///< over which velocities are averaged
  static constexpr double kMovedTime = 1.0;  ///< s: after a move by the referee nobody charges
  static constexpr double kLongAgo = -1e9;   ///< s

  struct Runner {
    std::array<Vec2, kCycles> velocities{Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)};  ///< m/s, the newest first
    int known = 0;                                                             ///< how many of them
    double touchedBall = kLongAgo, wasPushed = kLongAgo;                       ///< s of the simulated clock
    Vec2 velocity() const { return known ? Vec2((velocities[0] + velocities[1] + velocities[2]) / known) : Vec2(0, 0); }
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  /// One of a pair that touches.
  struct Party {
    std::size_t player;
    Vec2 position, velocity;
    double speed, ballDistance;
    double ballAngle, opponentAngle;  ///< deg, between its velocity and the direction there
  };
  /// A contact that was no foul.
  struct Harmless {
    int a, b;  ///< numbers of agents
    double time;
  };

  void observe(double now);
  void judgeMeeting(const Meeting& meeting, double now);
  bool mayCharge(std::size_t player) const;
  Party party(std::size_t player, std::size_t opponent) const;
  std::array<bool, 2> conduct(const std::array<Party, 2>& pair) const;
  bool runsInto(const Party& self, const Party& other, const Vec2& contact) const;
  bool isImmune(std::size_t player, double now) const;
  bool wentOn(const Meeting& meeting, double now);

  soccer::PlayerRecords<Runner> runners_;
  std::vector<Harmless> harmless_;
};

}  // namespace spark
