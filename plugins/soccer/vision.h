#pragma once
/// \file
/// What both kinds of vision share: the visible objects of the scene, polar coordinates, noise.

#include <utility>
#include <vector>

#include "agent_state.h"
#include "api/agents.h"
#include "soccer_settings.h"
#include "spark/random.h"

namespace spark::soccer {

/// A direction and distance as agents get it.
struct Polar {
  double distance = 0;    ///< m
  double horizontal = 0;  ///< deg, positive to the left
  double vertical = 0;    ///< deg, positive up
};

/// Polar coordinates of a point in a frame with x forward, y to the left, z up.
Polar polarOf(const Vec3f& relative);
/// `(pol d h v)`.
void writePolar(Predicates& out, const Polar& p);

/// The installed base's noise: distance in proportion, angles absolute, and a constant calibration error.
class VisionNoise {
 public:
  explicit VisionNoise(const Leaf& eye) : random(eye, "vision") {}
  bool on = true;       ///< as the robot's scene file says
  bool allowed = true;  ///< as the league says
  RandomStream random;
  bool active() const { return on && allowed; }
  /// The installed base's setNoiseParams: distance [%], phi (vertical) [deg], theta (horizontal) [deg], calibration error [m].
  void set(double distance, double phi, double theta, double error) {
    sigmaDistance_ = distance, sigmaPhi_ = phi, sigmaTheta_ = theta, error_ = error;
  }
  /// Once for each eye; zero while noise is off.
  const Vec3f& calibration() {
    if (active() && !std::exchange(calibrated_, true))
      for (int i = 0; i < 3; ++i) calibration_[i] = static_cast<float>(random.uniform(-error_, error_));
    return active() ? calibration_ : kNone;
  }
  void apply(Polar& p) {
    if (!active()) return;
    p.distance += random.normal(0, sigmaDistance_) * p.distance / 100;
    p.horizontal += random.normal(0, sigmaTheta_);
    p.vertical += random.normal(0, sigmaPhi_);
  }
  void save(StateWriter& out) const {
    out.write(calibrated_);
    for (int i = 0; i < 3; ++i) out.write(double(calibration_[i]));
  }
  void load(StateReader& in) {
    calibrated_ = in.readBool();
    for (int i = 0; i < 3; ++i) calibration_[i] = static_cast<float>(in.readNumber());
  }

 private:
  inline static const Vec3f kNone = Vec3f::Zero();
  double sigmaDistance_ = 0.0965, sigmaPhi_ = 0.1225, sigmaTheta_ = 0.1480, error_ = 0.005;
  bool calibrated_ = false;
  Vec3f calibration_ = Vec3f::Zero();
};

/// What can be seen, collected when the shape of the tree changes.
class VisibleObjects {
 public:
  /// A robot: its state, and the marked parts (none: it is seen by its state alone).
  struct Robot {
    AgentAspect* agent = nullptr;
    AgentState* state = nullptr;
    std::vector<ObjectState*> parts;
  };
  void refresh(const SceneNode& eye);
  /// Flags, goals, ball, in scene order.
  const std::vector<ObjectState*>& field() const { return field_; }
  /// In scene order.
  const std::vector<Robot>& robots() const { return robots_; }
  const std::vector<Line*>& lines() const { return lines_; }
  /// The agent of the eye, nullptr when it belongs to none.
  AgentAspect* agent() const { return agent_; }
  /// Its state, nullptr when it has none.
  AgentState* state() const { return state_; }
  /// The ball's mark, nullptr where there is no ball.
  const ObjectState* ball() const;
  /// The league's settings, nullptr where there are none.
  const SoccerSettings* settings() const { return settings_; }

 private:
  std::uint64_t version_ = 0;
  std::vector<ObjectState*> field_;
  std::vector<Robot> robots_;
  std::vector<Line*> lines_;
  AgentAspect* agent_ = nullptr;
  AgentState* state_ = nullptr;
  const SoccerSettings* settings_ = nullptr;
};

/// World position of a mark.
inline Vec3f placeOf(const SceneNode& node) { return node.transform() ? positionOf(node.transform()->world()) : Vec3f(Vec3f::Zero()); }
/// x and y turned as the side sees the field.
inline Vec3f seenBy(Side side, const Vec3f& v) {
  const float d = static_cast<float>(direction(side));
  return {d * v.x(), d * v.y(), v.z()};
}
/// `(mypos x y z)` in the side's view.
void writePoint(Predicates& out, std::string_view name, const Vec3f& p);

}  // namespace spark::soccer
