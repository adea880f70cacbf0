#pragma once

#include "foul_aspect.h"

namespace spark {

/// Who lies on the ground, or does not stand, for too long is taken away. Goalies have more time.
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
  /// Cycles.
  struct Clock {
    int ground = 0, down = 0, standing = 0;
    void save(StateWriter& out) const;
    void load(StateReader& in);
  };
  void advance(Clock& clock, const soccer::Player& player, double step) const;
  bool isOver(const Clock& clock, bool goalie, double step) const;
  soccer::PlayerRecords<Clock> clocks_;
};

}  // namespace spark
