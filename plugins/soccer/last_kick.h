#pragma once

#include "ball_state_aspect.h"

namespace spark::soccer {

/// Who took the last restart, as long as nobody else has touched the ball since: double touches and goals straight from
/// a kick.
class LastKick {
 public:
  /// The restart was taken with this touch.
  void taken(const BallStateAspect::Touch& touch, bool indirect) {
    taker_ = touch.agent;
    contact_ = touch.time;
    indirect_ = indirect;
    straight_ = true;
    again_ = false;
  }
  void forget() { *this = {}; }
  /// Once a cycle, before the rules: follows the touches.
  void follow(const BallStateAspect& ball) {
    again_ = false;
    if (taker_ == 0 || !ball.touched()) return;
    if (ball.last().agent != taker_) return forget();
    again_ = ball.last().time - contact_ >= BallStateAspect::kContactGap;
    straight_ &= !again_;
    contact_ = ball.last().time;
  }
  /// The taker touches the ball again in this cycle, before anybody else did.
  bool again() const { return again_; }
  /// The last touch of the match is still the taker's contact with the ball in the restart itself.
  bool straight() const { return taker_ != 0 && straight_; }
  /// A goal straight from it does not count.
  bool indirect() const { return indirect_; }

  void save(StateWriter& out) const {
    out.write(taker_);
    out.write(contact_);
    for (bool b : {indirect_, straight_, again_}) out.write(b);
  }
  void load(StateReader& in) {
    taker_ = static_cast<int>(in.readInteger());
    contact_ = in.readNumber();
    for (bool* b : {&indirect_, &straight_, &again_}) *b = in.readBool();
  }

 private:
  int taker_ = 0;       ///< agent's number, 0: nobody
  double contact_ = 0;  ///< s of the simulated clock, of his last contact
  bool indirect_ = false, straight_ = false, again_ = false;
};

}  // namespace spark::soccer
