#pragma once

#include "foul_aspect.h"

namespace spark {

/// At most MaxTouchGroupSize players may touch each other. The last to join is guilty when his team has at least half
/// of the group (a team-mate when he is the goalie), else a random opponent of the group; goalies are drawn only when
/// there is nobody else.
class TouchingFoulAspect : public FoulAspect {
  SPARK_CLASS(TouchingFoulAspect, FoulAspect)
 public:
  static void describe(Description<TouchingFoulAspect>& d) {
    d.doc("Joining too large a group of players who touch each other is a foul.");
    d.property("random", &TouchingFoulAspect::random_).state().doc("Draws who is guilty among equals.");
  }

 protected:
  void judgePlay(const Event& event) override;
  void reset() override { members_.reset(); }
  void saveState(StateWriter& out) const override { members_.save(out); }
  void loadState(StateReader& in) override { members_.load(in); }

 private:
  struct Member {
    std::int64_t group = 0;   ///< name of the group in the last cycle, 0: alone
    std::int64_t joined = 0;  ///< cycle in which he joined the others
    void save(StateWriter& out) const { out.write(group), out.write(joined); }
    void load(StateReader& in) { group = in.readInteger(), joined = in.readInteger(); }
  };
  void note(int group, std::int64_t cycle);
  void judgeGroup();
  template <class F>
  int draw(F wanted);
  void punish(int player);

  RandomStream random_{*this, "touching"};
  soccer::PlayerRecords<Member> members_;
  // of the group at hand; kept for their capacity
  std::vector<int> group_, candidates_;
};

}  // namespace spark
