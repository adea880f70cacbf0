#pragma once

#include "foul_aspect.h"

namespace spark {

/// Ball holding: a player keeps the ball within BallHoldRadius for longer than BallHoldMaxTime (a goalie in its own
/// area: BallHoldGoalieMaxTime) while an opponent is within BallHoldOppDist of the ball. A rule of servers after 0.7.5;
/// off unless Soccer.UseBallHolding is set.
class BallHoldingAspect : public FoulAspect {
  SPARK_CLASS(BallHoldingAspect, FoulAspect)
 public:
  static void describe(Description<BallHoldingAspect>& d) {
    d.doc("Holding the ball for too long is a foul; on with Soccer.UseBallHolding.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { holders_.reset(); }
  void saveState(StateWriter& out) const override { holders_.save(out); }
  void loadState(StateReader& in) override { holders_.load(in); }

 private:
  struct Holder {
    int cyclesHeld = 0;  ///< with the ball, under pressure
    int cyclesAway = 0;  ///< since the player last had the ball
    void save(StateWriter& out) const { out.write(cyclesHeld), out.write(cyclesAway); }
    void load(StateReader& in) {
      cyclesHeld = static_cast<int>(in.readInteger());
      cyclesAway = static_cast<int>(in.readInteger());
    }
  };
  /// True when an opponent of `side` is near the ball.
  bool underPressure(Side side) const;
  soccer::PlayerRecords<Holder> holders_;
};

}  // namespace spark
