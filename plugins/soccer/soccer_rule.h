#pragma once

#include "soccer_rule_aspect.h"

namespace spark {

/// Base of the rules of play. A rule is a child of the referee (SoccerRuleAspect), or its sibling after it. Rules judge
/// once in each cycle, in tree order. A rule judges the referee's mode(), the mode at the start of the cycle; holds()
/// and playing() say whether an earlier rule has already ended it.
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
  void rule(const Event& event) final { findReferee() && referee_->ready() ? judge(event) : idle(); }
  void rest(const Event&) final { findReferee() && referee_->ready() ? skip() : idle(); }

 protected:
  /// Judges a cycle. Only here and in skip() may the accessors below be called.
  virtual void judge(const Event& event) = 0;
  /// Called instead of judge() while the rule is disabled.
  virtual void skip() {}
  /// Called instead of judge() and skip() while there is no match to judge, for instance because the referee is
  /// disabled. None of the accessors below may be called.
  virtual void idle() {}

  SoccerRuleAspect& referee() const { return *referee_; }
  GameStateAspect& game() const { return referee_->game(); }
  BallStateAspect& ball() const { return referee_->ball(); }
  soccer::Pitch& pitch() const { return referee_->pitch(); }
  const SoccerSettings& settings() const { return referee_->settings(); }
  RandomStream& random() const { return game().random(); }
  PlayMode mode() const { return referee_->mode(); }
  /// The side that the mode is for.
  Side side() const { return sideOf(mode()); }
  /// True when mode() is `left` or the same mode for the right side, and still holds.
  bool in(PlayMode left) const { return (mode() == left || mode() == forSide(left, Side::right)) && referee_->holds(); }

  void onLink() override {
    if (!findReferee())
      kernel().log().warning(
          "{} judges nothing: expected a SoccerRuleAspect above or beside it, found none. Create one before it.",
          path());
  }

 private:
  /// Looks up the referee; false when there is none.
  bool findReferee() {
    referee_ = above_ ? above_.get() : beside_.get();
    return referee_ != nullptr;
  }

  Link<SoccerRuleAspect> above_, beside_;
  SoccerRuleAspect* referee_ = nullptr;
};

}  // namespace spark
