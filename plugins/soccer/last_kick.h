#pragma once

#include "ball_state_aspect.h"

namespace spark::soccer {

/// The taker of the last restart, until another player touches the ball: detects double touches and goals scored
/// directly from a restart.
class LastKick {
 public:
  /// The restart was taken with this touch. `indirect`: no goal may be scored directly from it.
  void taken(const BallStateAspect::Touch& touch, bool indirect) {
    taker_ = touch.agent;
    contact_ = touch.time;
    indirect_ = indirect;
    direct_ = true;
    doubleTouch_ = false;
  }
  /// Forgets the restart.
  void reset() { *this = {}; }
  /// Follows the touches; called once in each cycle, before the rules.
  void update(const BallStateAspect& ball) {
    doubleTouch_ = false;
    if (taker_ == 0 || !ball.touched()) return;
    if (ball.last().agent != taker_) return reset();
    doubleTouch_ = ball.last().time - contact_ >= BallStateAspect::kContactGap;
    direct_ &= !doubleTouch_;
    contact_ = ball.last().time;
  }
  /// True when the taker touches the ball again in this cycle, before any other player has.
  bool doubleTouch() const { return doubleTouch_; }
  /// True when the last touch of the match is still the one that took the restart: a goal now comes directly from it.
  bool isDirectFromRestart() const { return taker_ != 0 && direct_; }
  /// True when a goal directly from the restart does not count.
  bool indirect() const { return indirect_; }

  void save(StateWriter& out) const {
    out.write(taker_);
    out.write(contact_);
    for (bool b : {indirect_, direct_, doubleTouch_}) out.write(b);
  }
  void load(StateReader& in) {
    taker_ = static_cast<int>(in.readInteger());
    contact_ = in.readNumber();
    for (bool* b : {&indirect_, &direct_, &doubleTouch_}) *b = in.readBool();
  }

 private:
  int taker_ = 0;       ///< the agent's number; 0: none
  double contact_ = 0;  ///< simulated time of its last contact [s]
  bool indirect_ = false, direct_ = false, doubleTouch_ = false;
};

}  // namespace spark::soccer
