#pragma once

#include "soccer_rule_aspect.h"

namespace spark {

/// Base of the rules of play. A rule stands below the referee (SoccerRuleAspect), or beside and after it, and judges
/// once a cycle, in tree order. It acts on the referee's `mode()`, and asks `holds()` or `playing()` whether a rule
/// before it has ended that mode already.
class SoccerRule : public ControlAspect {
  SPARK_CLASS(SoccerRule, ControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;

  static void describe(Description<SoccerRule>& d) {
    d.doc("Base of the rules of play.");
    d.abstract();
    d.link(&SoccerRule::above_, Above<SoccerRuleAspect>());
    d.link(&SoccerRule::beside_, Beside<SoccerRuleAspect>());
  }
  void rule(const Event& event) final {
    if (findReferee() && referee_->ready()) judge(event);
  }
  void rest(const Event&) final {
    if (findReferee() && referee_->ready()) skip();
  }

 protected:
  /// Everything below may be called.
  virtual void judge(const Event& event) = 0;
  /// Instead of judge() while the rule is switched off.
  virtual void skip() {}

  SoccerRuleAspect& referee() const { return *referee_; }
  GameStateAspect& game() const { return referee_->game(); }
  BallStateAspect& ball() const { return referee_->ball(); }
  soccer::Pitch& pitch() const { return referee_->pitch(); }
  const SoccerSettings& settings() const { return referee_->settings(); }
  RandomStream& random() const { return game().random(); }
  PlayMode mode() const { return referee_->mode(); }
  /// The team that the mode names.
  Side side() const { return sideOf(mode()); }
  /// mode() is that kind of mode, for either side (`left`: its left variant), and still holds.
  bool in(PlayMode left) const { return (mode() == left || mode() == forSide(left, Side::right)) && referee_->holds(); }

  void onLink() override {
    if (!findReferee())
      kernel().log().warning(
          "{} judges nothing: expected a SoccerRuleAspect above or beside it, found none. Create one before it.",
          path());
  }

 private:
  bool findReferee() {
    referee_ = above_ ? above_.get() : beside_.get();
    return referee_ != nullptr;
  }

  Link<SoccerRuleAspect> above_, beside_;
  SoccerRuleAspect* referee_ = nullptr;
};

}  // namespace spark
