#pragma once

#include "match_lookup.h"
#include "pass_mode_rule.h"

namespace spark {

/// `(pass)`: requests pass mode. PassModeRule grants it when the ball rests near the player and no opponent is near.
class PassEffector : public Effector {
  SPARK_CLASS(PassEffector, Effector)
 public:
  static void describe(Description<PassEffector>& d) {
    d.doc("Requests pass mode: (pass).");
    d.on<&PassEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "pass"; }
  std::string act(const Element& action) override {
    pending_ = true;
    return expectNoArguments(action);
  }

 private:
  void prepare(const Event&) {
    if (!std::exchange(pending_, false)) return;
    const soccer::Player* player = match_.player(*this);
    PassModeRule* rule = player && match_.referee() ? match_.referee()->passMode() : nullptr;
    if (!player) return refuse(0, [&] { return match_.whyNoPlayer(); });
    if (!rule) return refuse(1, [] { return "expected a PassModeRule below the referee, found none"; });
    const PassModeRule::Refusal why = rule->request(*player);
    if (why != PassModeRule::Refusal::none) refuse(1 + static_cast<int>(why), [&] { return PassModeRule::text(why); });
  }

  MatchLookup match_;
  bool pending_ = false;
};

}  // namespace spark
