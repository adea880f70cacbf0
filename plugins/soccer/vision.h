#pragma once
/// \file
/// Code shared by both vision perceptors: the objects that they test, polar coordinates, noise.

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/scene_calls.h"
#include "soccer_settings.h"
#include "spark/random.h"
#include "visible_objects.h"

namespace spark::soccer {

/// Objects at most this near are parts of the eye's own body and are not seen, as in the installed base [m].
inline constexpr float kMinDistance = 0.1f;

/// Polar coordinates as percepts have them.
struct Polar {
  double distance = 0;    ///< m
  double horizontal = 0;  ///< deg, positive to the left
  double vertical = 0;    ///< deg, positive up
};

/// Polar coordinates of a point [m] in a frame with x forward, y to the left, z up.
Polar toPolar(const Vec3f& point);
/// The point [m] with these polar coordinates, in that frame.
Vec3f toCartesian(const Polar& polar);
/// Writes `(pol d h v)`.
inline void writePolar(Predicates& out, const Polar& p) {
  out.open("pol").add(p.distance).add(p.horizontal).add(p.vertical).close();
}

/// The vision noise of the installed base: normal noise on distance (relative) and angles (absolute), and a constant
/// calibration error, drawn once for each eye.
class VisionNoise {
 public:
  explicit VisionNoise(const Leaf& eye) : random(eye, "vision") {}
  bool on = true;       ///< the robot's scene file has noise on
  bool allowed = true;  ///< the league has noise on
  RandomStream random;
  /// True when there is noise.
  bool active() const { return on && allowed; }
  /// The parameters of setNoiseParams in the installed base: standard deviations of distance [%], phi (vertical angle
  /// [deg]) and theta (horizontal angle [deg]); half width of the uniform calibration error [m].
  void set(double distance, double phi, double theta, double error) {
    sigmaDistance_ = distance, sigmaPhi_ = phi, sigmaTheta_ = theta, error_ = error;
  }
  /// Constant offset of all points, in the eye's frame [m]. Zero without noise.
  const Vec3f& calibration() {
    if (active() && !std::exchange(calibrated_, true))
      for (int i = 0; i < 3; ++i) calibration_[i] = static_cast<float>(random.uniform(-error_, error_));
    return active() ? calibration_ : kNone;
  }
  /// Adds noise to a measurement.
  void apply(Polar& p) {
    if (!active()) return;
    p.distance += random.normal(0, sigmaDistance_) * p.distance / 100;
    p.horizontal += random.normal(0, sigmaTheta_);
    p.vertical += random.normal(0, sigmaPhi_);
  }
  /// The calls that set it.
  std::vector<SceneCall> sceneCalls() const {
    return {{"addNoise", {on}}, {"setNoiseParams", {sigmaDistance_, sigmaPhi_, sigmaTheta_, error_}}};
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

/// The context of an eye: the visible objects, its agent, the settings. Without settings it has visible objects of its
/// own.
class EyeContext {
 public:
  /// Looks up agent and settings again when the shape of the tree changed.
  void refresh(const SceneNode& eye);
  /// ISharedView::share(): updates the visible objects once for each `round`. `range`: of the eye's scene file [m].
  void share(const SceneNode& eye, std::uint64_t round, float range);
  /// Called at the start of sense(). Updates the visible objects itself if share() was not called before, as when a
  /// perceptor senses outside of the sense phase.
  void beginSense(const SceneNode& eye, float range);
  /// Updates the visible objects; between cycles, in the simulation's thread.
  void update(const SceneNode& eye, float range);
  /// `on`: objects behind a collider are not seen. Call it before share().
  void setOcclusion(bool on) { occlusion_ = on; }
  bool occlusion() const { return occlusion_; }
  /// True if an object at `point`, with that body (nullptr: none), is hidden from `eye` (world frame [m]).
  bool isHidden(const Vec3f& eye, const Vec3f& point, const IRigidBody* body) const {
    return hides_ && physics_->isHidden(eye.cast<double>(), point.cast<double>(), body, object_);
  }
  /// True if something may be hidden in this sense phase.
  bool hides() const { return hides_; }
  /// Range of the eye, limited by Soccer.VisionRange [m].
  float range() const { return range_; }

  const VisibleObjects& objects() const { return *objects_; }
  /// Indices of the robots that may be within range() of `position` [m], in scene order. Valid until the next call.
  std::span<const std::uint32_t> robotsNear(const Vec3f& position);
  /// The agent of the eye (outermost aspect); nullptr if there is none.
  AgentAspect* agent() const { return agent_; }
  /// The agent's state; nullptr if it has none.
  AgentState* state() const { return state_; }
  /// nullptr if there are none.
  const SoccerSettings* settings() const { return settings_; }

 private:
  void findState();
  /// Decides whether objects can be hidden, and prepares for the rays.
  void prepareOcclusion();
  float limitRange(float range) const {
    return settings_ && settings_->visionRange > 0 ? std::min(range, static_cast<float>(settings_->visionRange))
                                                   : range;
  }
  TreeWatch tree_;
  bool stateFound_ = false;
  bool shared_ = false;  ///< share() was called for this sense phase
  float range_ = VisibleObjects::kUnlimited;
  std::unique_ptr<VisibleObjects> own_;  ///< without settings
  VisibleObjects* objects_ = nullptr;
  AgentAspect* agent_ = nullptr;
  const Node* object_ = nullptr;  ///< AgentAspect::object() of the agent
  AgentState* state_ = nullptr;
  SoccerSettings* settings_ = nullptr;
  IPhysicsServer* physics_ = nullptr;
  bool occlusion_ = false, hides_ = false;
  std::vector<std::uint32_t> near_;
};

/// IEye::sights(): appends all visible objects.
void appendSights(const VisibleObjects& objects, std::vector<IEye::Sight>& out);

/// A vector of the field in the frame of a team, and back: for the right team x and y are mirrored, so that the
/// opponents' goal is towards +x.
inline Vec3f toTeamFrame(Side side, const Vec3f& v) {
  const float d = static_cast<float>(direction(side));
  return {d * v.x(), d * v.y(), v.z()};
}
/// Pose of an eye at `position` [m] whose axes are those of its team's frame: x towards the opponents' goal.
Matrix teamView(const Vec3f& position, Side side);
/// Pose of an eye that looks in the direction of `head`, x forward. Heads look along their y axis.
Matrix headView(const Transform& head);
/// Writes `(myorien deg)`: heading of the frame's y axis in the team's frame.
inline void writeHeading(Predicates& out, const Matrix& frame, Side side) {
  const double heading = radToDeg(std::atan2(frame(1, 1), frame(0, 1)));
  out.pair("myorien", normalizeDeg(side == Side::right ? heading - 180 : heading));
}
/// Writes `(name x y z)`.
void writePoint(Predicates& out, std::string_view name, const Vec3f& p);

}  // namespace spark::soccer
