#pragma once
/// \file
/// Helpers of effectors: reading numbers from an action, clamping joint speeds.
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

/// Reads the arguments of `(predicate arguments...)` as finite numbers and keeps a remark on the first that is not one.
/// Lives during one call of act(); `action` must outlive it. Allocates only for a remark.
class NumberArguments {
 public:
  explicit NumberArguments(const Element& action) : action_(action) {}

  /// Reads argument `index`, from 0, into `out`. Returns false when the argument is missing, a list or not finite:
  /// `out` is then unchanged, and the command should have no effect. Text that is no number is converted as C's atof
  /// does, as in the installed base ("abc" is 0, "1.5x" is 1.5), and causes a remark.
  bool operator()(std::size_t index, double& out) {
    count_ = std::max(count_, index + 1);
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
  /// The return value of act(): the remark, or "" when all arguments were numbers and there were no others. Call it
  /// once, after all arguments were read.
  std::string remark() {
    if (action_.at(count_ + 1))
      refuse(fmt::format("expected {} argument{}, found {}: the others are ignored", count_, count_ == 1 ? "" : "s",
                         action_.size() - 1));
    return std::move(remark_);
  }

 private:
  static constexpr std::size_t kShown = 60;  // bytes of a bad argument in the remark
  /// Keeps the first remark. Returns false.
  bool refuse(std::string text) {
    if (remark_.empty()) remark_ = std::move(text);
    return false;
  }
  Element action_;
  std::size_t count_ = 0;  ///< arguments that were read
  std::string remark_;
};

/// The return value of act() for an action without arguments: "", or a remark that it has some, which are ignored.
inline std::string expectNoArguments(const Element& action) {
  return action.at(1) ? fmt::format("expected no arguments, found {}: they are ignored", action.size() - 1)
                      : std::string();
}

/// `speed` [rad/s] clamped to the joint's IJoint::maxSpeed(); 0 there: not clamped.
inline double clampSpeed(const IJoint& joint, int axis, double speed) {
  const double max = joint.maxSpeed(axis);
  return max > 0 ? std::clamp(speed, -max, max) : speed;
}

}  // namespace spark
