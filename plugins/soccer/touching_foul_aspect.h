#pragma once

#include "foul_aspect.h"

namespace spark {

/// Touching, as in the installed base: more than MaxTouchGroupSize players touch each other. If the team of the player
/// that joined last has at least half of the group, that player is the offender (a team-mate if it is the goalie); else
/// a random opponent. Goalies are chosen only if there is no other player.
class TouchingFoulAspect : public FoulAspect {
  SPARK_CLASS(TouchingFoulAspect, FoulAspect)
 public:
  static void describe(Description<TouchingFoulAspect>& d) {
    d.doc("Joining too large a group of players that touch each other is a foul.");
    d.property("random", &TouchingFoulAspect::random_).state().doc("The stream that chooses among equal offenders.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { members_.reset(); }
  void saveState(StateWriter& out) const override { members_.save(out); }
  void loadState(StateReader& in) override { members_.load(in); }

 private:
  struct Member {
    std::int64_t group = 0;   ///< id of its group in the last cycle (the number of an agent); 0: none
    std::int64_t joined = 0;  ///< cycle in which it joined the group
    void save(StateWriter& out) const { out.write(group), out.write(joined); }
    void load(StateReader& in) { group = in.readInteger(), joined = in.readInteger(); }
  };
  /// Records which members of group_ joined it in this cycle. `first`: index of its first player.
  void updateMembers(int first, std::int64_t cycle);
  void judgeGroup();
  /// A random player of group_ for which accepts(player) is true; -1: there is none.
  template <class F>
  int choose(F accepts);
  void penalise(int player);

  RandomStream random_{*this, "touching"};
  soccer::PlayerRecords<Member> members_;
  // Of the group that is judged; members only to keep their capacity.
  std::vector<int> group_, candidates_;
};

}  // namespace spark
