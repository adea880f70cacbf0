#pragma once

#include "foul_aspect.h"

namespace spark {

/// At most MaxPlayersInsideOwnArea of a team in its own penalty area: who just came has to leave, for a goalie the
/// player farthest from the goal.
class IllegalDefenceAspect : public FoulAspect {
  SPARK_CLASS(IllegalDefenceAspect, FoulAspect)
 public:
  static void describe(Description<IllegalDefenceAspect>& d) {
    d.doc("Being one too many in the own penalty area is a foul.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { were_.reset(); }
  void saveState(StateWriter& out) const override { were_.save(out); }
  void loadState(StateReader& in) override { were_.load(in); }

 private:
  /// In the last cycle.
  struct Inside {
    bool was = false, is = false;
    void save(StateWriter& out) const { out.write(was); }
    void load(StateReader& in) { was = in.readBool(); }
  };
  int guilty(Side side) const;
  void punish(std::size_t player);
  Vec3 exitOf(const soccer::Player& player) const;
  soccer::PlayerRecords<Inside> were_;
};

}  // namespace spark
