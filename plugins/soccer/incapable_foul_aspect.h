#pragma once

#include "foul_aspect.h"

namespace spark {

/// Incapable: a player lies on the ground for longer than GroundMaxTime, or does not stand for longer than
/// NotStandingMaxTime. Goalies have GoalieGroundMaxTime and GoalieNotStandingMaxTime.
class IncapableFoulAspect : public FoulAspect {
  SPARK_CLASS(IncapableFoulAspect, FoulAspect)
 public:
  static void describe(Description<IncapableFoulAspect>& d) { d.doc("Lying or not standing for too long is a foul."); }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { clocks_.reset(); }
  void saveState(StateWriter& out) const override { clocks_.save(out); }
  void loadState(StateReader& in) override { clocks_.load(in); }

 private:
  struct Clock {
    int ground = 0;    ///< cycles on the ground, until the torso is at standing height
    int down = 0;      ///< cycles without standing, until the player has stood for a while
    int standing = 0;  ///< cycles of standing since the player was down
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  void advance(Clock& clock, const soccer::Player& player, double step) const;
  bool isOver(const Clock& clock, bool goalie, double step) const;
  soccer::PlayerRecords<Clock> clocks_;
};

}  // namespace spark
