#pragma once

#include "foul_aspect.h"

namespace spark {

/// Illegal defence: more than MaxPlayersInsideOwnArea players of a team are in its own penalty area. The player that
/// entered last has to leave; if that is the goalie, the player farthest from the goal.
class IllegalDefenceAspect : public FoulAspect {
  SPARK_CLASS(IllegalDefenceAspect, FoulAspect)
 public:
  static void describe(Description<IllegalDefenceAspect>& d) {
    d.doc("Being one player too many in the own penalty area is a foul.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { records_.reset(); }
  void saveState(StateWriter& out) const override { records_.save(out); }
  void loadState(StateReader& in) override { records_.load(in); }

 private:
  /// The player is in its own penalty area.
  struct Inside {
    bool before = false;  ///< in the last cycle
    bool now = false;
    void save(StateWriter& out) const { out.write(before); }
    void load(StateReader& in) { before = in.readBool(); }
  };
  /// The player of `side` that has to leave the area; -1 when only goalies are inside.
  int findOffender(Side side) const;
  void penalise(std::size_t player);
  /// A point one AgentRadius outside of the nearest edge of the area that is not the goal line [m].
  Vec3 exitPosition(const soccer::Player& player) const;
  soccer::PlayerRecords<Inside> records_;
};

}  // namespace spark
