#pragma once

#include <array>

#include "foul_aspect.h"

namespace spark {

/// Crowding: while an opponent is within MinOppDistance of the ball, the second player of a team must not be within
/// Min2PlDistance and the third not within Min3PlDistance. Distances of 0 (the league's) switch the rule off. Goalies
/// count in the ranking but are not penalised. Not judged for a team at its own kick-off.
class CrowdingFoulAspect : public FoulAspect {
  SPARK_CLASS(CrowdingFoulAspect, FoulAspect)
 public:
  static void describe(Description<CrowdingFoulAspect>& d) {
    d.doc(
        "Being the second or third player of a team near a ball that an opponent has is a foul; off while "
        "MinOppDistance is 0.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override {}

 private:
  /// The three players of a team that are nearest to the ball, nearest first.
  struct Nearest {
    std::array<int, 3> player{-1, -1, -1};                         ///< indices; -1: none
    std::array<double, 3> distance{HUGE_VAL, HUGE_VAL, HUGE_VAL};  ///< m
    void insert(int newPlayer, double newDistance);
  };
  /// Sends off the player of that rank (0: nearest) if it is within `limit` [m] and not the goalie.
  void judgeRank(const Nearest& team, int rank, double limit);
};

}  // namespace spark
