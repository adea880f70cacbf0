#include "kick.h"

#include <algorithm>
#include <cmath>

namespace humanoid {

namespace {
/// All in m and rad against the stance: the torso's shift over the standing foot; the kicking foot's way forward, up, and its toes up.
struct Frame {
  double seconds, shift, forward, up, pitch;
};
constexpr double kWider = 0.4;   // part of what hips are wider by that the torso shifts more
constexpr double kHipX = 0.055;  // m, of the build that the frames are for
constexpr std::array<Frame, 7> kSwing{{{0, 0, 0, 0, 0},
                                       {0.40, 0.065, 0, 0, 0},
                                       {0.24, 0.075, -0.07, 0.04, 0},
                                       {0.08, 0.075, 0.13, 0.045, 0},
                                       {0.20, 0.075, 0.03, 0.03, 0},
                                       {0.24, 0.055, 0, 0, 0},
                                       {0.30, 0, 0, 0, 0}}};
}  // namespace

void Kick::start(bool right) {
  right_ = right;
  frame_ = 0;
  time_ = 0;
}

void Kick::step(Pose& pose) {
  if (!playing()) return;
  const Frame &a = kSwing[frame_], &b = kSwing[frame_ + 1];
  time_ += kCycle;
  const double t = std::min(1.0, time_ / b.seconds), share = 0.5 - 0.5 * std::cos(kPi * t);
  const auto between = [share](double from, double to) { return from + (to - from) * share; };
  const double side = right_ ? 1 : -1;
  const double shift = side * between(a.shift, b.shift) * (1 + kWider * (build_.hipX / kHipX - 1));
  for (const bool right : {true, false}) {
    Foot foot;
    foot.place = Vec3((right ? 1 : -1) * gait_.spread + shift, gait_.forward, -gait_.height * legLength(build_));
    if (right == right_) {
      foot.place += Vec3(0, between(a.forward, b.forward), between(a.up, b.up));
      foot.pitch = between(a.pitch, b.pitch);
    }
    placeFoot(build_, right, foot, pose);
  }
  if (time_ < b.seconds - 0.5 * kCycle) return;
  ++frame_;
  time_ = 0;
}

}  // namespace humanoid
