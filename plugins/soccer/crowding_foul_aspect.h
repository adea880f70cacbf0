#pragma once

#include <array>

#include "foul_aspect.h"

namespace spark {

/// While an opponent is at the ball, not more than one (and not more than two) of a team may be near it. Off with the
/// league's distances of 0. The kicking team may crowd at its own kick-off.
class CrowdingFoulAspect : public FoulAspect {
  SPARK_CLASS(CrowdingFoulAspect, FoulAspect)
 public:
  static void describe(Description<CrowdingFoulAspect>& d) {
    d.doc(
        "Being the second or third of a team too near to a ball that an opponent is at is a foul; off while "
        "MinOppDistance is 0.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override {}

 private:
  /// The three nearest players of a team to the ball.
  struct Nearest {
    std::array<int, 3> player{-1, -1, -1};
    std::array<double, 3> distance{HUGE_VAL, HUGE_VAL, HUGE_VAL};  ///< m
    void take(int player, double distance);
  };
  void judgeRank(const Nearest& team, int rank, double least);
};

}  // namespace spark
