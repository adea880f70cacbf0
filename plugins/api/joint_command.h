#pragma once
/// \file
/// What effectors share: numbers out of a message, joints' speeds within their limits.
///
///     std::string act(const Element& action) override {
///       NumberArguments read(action);
///       double speed = 0;
///       if (read(0, speed)) joint_->drive(0, clampSpeed(*joint_, 0, speed));
///       return read.remark();
///     }

#include <algorithm>
#include <cmath>
#include <string>

#include "api/agents.h"
#include "api/joint_above.h"
#include "spark/abi/api/joint_command.h"

namespace spark {

/// Reads the arguments of `(predicate arguments...)` as finite numbers, and remembers what was wrong with the first
/// that is none. Lives in one call of act(). Allocates only when something is wrong.
class NumberArguments {
 public:
  explicit NumberArguments(const Element& action) : action_(action) {}

  /// Argument `index` (from 0). False when it is missing, a list or not finite: `out` is then untouched, and the
  /// command should have no effect. Text that is no number counts as the installed base counts it, by C's atof ("abc"
  /// is 0, "1.5x" is 1.5), and is remarked on.
  bool operator()(std::size_t index, double& out) {
    const Element argument = action_.at(index + 1);
    if (!argument || argument.isList())
      return refuse(fmt::format("expected a number as argument {}, found {}", index + 1, argument ? "a list" : "none"));
    const std::optional<double> exact = argument.asNumber();
    const double v = exact ? *exact : argument.number();
    if (!std::isfinite(v))
      return refuse(fmt::format("expected a finite number as argument {}, found {}", index + 1, v));
    if (!exact)
      refuse(fmt::format("expected a number as argument {}, found '{}', which counts as {}", index + 1,
                         argument.text().substr(0, kShown), v));
    out = v;
    return true;
  }
  /// What act() returns: "" when all was well.
  std::string remark() { return std::move(remark_); }

 private:
  static constexpr std::size_t kShown = 60;  // characters
  bool refuse(std::string text) {
    if (remark_.empty()) remark_ = std::move(text);
    return false;
  }
  Element action_;
  std::string remark_;
};

/// `speed` within the joint's greatest, IJoint::maxSpeed (0: unlimited) [rad/s].
inline double clampSpeed(const IJoint& joint, int axis, double speed) {
  const double most = joint.maxSpeed(axis);
  return most > 0 ? std::clamp(speed, -most, most) : speed;
}

}  // namespace spark
