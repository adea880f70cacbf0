#pragma once

#include "foul_aspect.h"

namespace spark {

/// Keeping the ball within BallHoldRadius for too long while an opponent is near it. A rule of later servers, off
/// unless Soccer.UseBallHolding is set.
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
    int held = 0, away = 0;  ///< cycles with the ball under pressure, and since he last had it
    void save(StateWriter& out) const { out.write(held), out.write(away); }
    void load(StateReader& in) { held = static_cast<int>(in.readInteger()), away = static_cast<int>(in.readInteger()); }
  };
  bool underPressure(Side side) const;
  soccer::PlayerRecords<Holder> holders_;
};

}  // namespace spark
