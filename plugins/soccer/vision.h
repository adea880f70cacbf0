#pragma once
/// \file
/// What both kinds of vision share: what they look at, polar coordinates, noise.

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "sights.h"
#include "soccer_settings.h"
#include "spark/random.h"

namespace spark::soccer {

inline constexpr float kTooNear = 0.1f;  ///< m: what is nearer is the eye's own body

/// A direction and distance as agents get it.
struct Polar {
  double distance = 0;    ///< m
  double horizontal = 0;  ///< deg, positive to the left
  double vertical = 0;    ///< deg, positive up
};

/// Polar coordinates of a point in a frame with x forward, y to the left, z up.
Polar polarOf(const Vec3f& relative);
/// `(pol d h v)`.
inline void writePolar(Predicates& out, const Polar& p) {
  out.open("pol").add(p.distance).add(p.horizontal).add(p.vertical).close();
}

/// The installed base's noise: distance in proportion, angles absolute, and a constant calibration error.
class VisionNoise {
 public:
  explicit VisionNoise(const Leaf& eye) : random(eye, "vision") {}
  bool on = true;       ///< as the robot's scene file says
  bool allowed = true;  ///< as the league says
  RandomStream random;
  bool active() const { return on && allowed; }
  /// The installed base's setNoiseParams: distance [%], phi (vertical) [deg], theta (horizontal) [deg], calibration
  /// error [m].
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

/// What one eye looks at: the sights of the league, or its own where there is no league.
class Outlook {
 public:
  /// Finds agent and league again when the shape of the tree changed.
  void refresh(const SceneNode& eye);
  /// Before the sense phase, in the simulation's thread; `range` of the eye itself [m].
  void share(const SceneNode& eye, std::uint64_t round, float range);
  /// In the sense phase, before all below. Who is asked outside of it brings the sights up to date himself.
  void open(const SceneNode& eye, float range);
  /// As open, at any time between the phases.
  void bring(const SceneNode& eye, float range);
  /// How far it sees in this phase [m].
  float range() const { return range_; }

  const Sights& sights() const { return *sights_; }
  /// The robots of which something may be within its range of `place`, in scene order; indices into sights().
  std::span<const std::uint32_t> robotsNear(const Vec3f& place);
  /// The agent of the eye, nullptr when it belongs to none.
  AgentAspect* agent() const { return agent_; }
  /// Its state, nullptr when it has none.
  AgentState* state() const { return state_; }
  /// The league's settings, nullptr where there are none.
  const SoccerSettings* settings() const { return settings_; }

 private:
  void findState();
  float limited(float range) const {
    return settings_ && settings_->visionRange > 0 ? std::min(range, static_cast<float>(settings_->visionRange))
                                                   : range;
  }
  TreeWatch tree_;
  bool stateFound_ = false;
  bool shared_ = false;
  float range_ = Sights::kUnlimited;
  std::unique_ptr<Sights> own_;
  Sights* sights_ = nullptr;
  AgentAspect* agent_ = nullptr;
  AgentState* state_ = nullptr;
  SoccerSettings* settings_ = nullptr;
  std::vector<std::uint32_t> near_;
};

/// The point that polar coordinates mean, in the frame in which they were measured.
Vec3f pointOf(const Polar& polar);
/// Appends all that there is to be seen, as IEye wants it.
void tellSights(const Sights& sights, std::vector<IEye::Sight>& out);

/// x and y turned as the side sees the field.
inline Vec3f seenBy(Side side, const Vec3f& v) {
  const float d = static_cast<float>(direction(side));
  return {d * v.x(), d * v.y(), v.z()};
}
/// The frame, x forward, of an eye that looks along the field as its side sees it.
Matrix fieldView(const Vec3f& place, Side side);
/// The frame, x forward, of an eye that looks as its head does: heads look along their y axis.
Matrix headView(const Transform& head);
/// `(myorien deg)`: the heading of what a frame's y axis points at, as the side sees the field.
inline void writeHeading(Predicates& out, const Matrix& frame, Side side) {
  const double heading = radToDeg(std::atan2(frame(1, 1), frame(0, 1)));
  out.pair("myorien", normalizeDeg(side == Side::right ? heading - 180 : heading));
}
/// `(mypos x y z)` in the side's view.
void writePoint(Predicates& out, std::string_view name, const Vec3f& p);

}  // namespace spark::soccer
