#pragma once

#include <array>

#include "see_reader.h"
#include "vision.h"

namespace spark {

/// Vision within a view cone, in the frame of the head or along the axes of the team's frame:
/// `(See (G1R (pol ...)) (B (pol ...)) (P (team A) (id 3) (rlowerarm (pol ...)) ...))`.
class RestrictedVisionPerceptor : public Perceptor,
                                  public ISharedView,
                                  public IEye,
                                  public soccer::SeeReader,
                                  public ISceneCalls {
  SPARK_CLASS(RestrictedVisionPerceptor, Perceptor)
 public:
  RestrictedVisionPerceptor() { predicateName_ = "See"; }
  static void describe(Description<RestrictedVisionPerceptor>& d);
  void sense(Predicates& out, const Event& event) override;
  void share(std::uint64_t round) override { eye_.share(*this, round, range_); }

  Matrix view() override;
  std::array<double, 2> cone() override;
  double range() override;
  Vec3f placeOf(double distance, double horizontalDeg, double verticalDeg) override;
  void sights(std::vector<Sight>& out) override;
  std::vector<SceneCall> sceneCalls() const override {
    std::vector<SceneCall> calls = noise_.sceneCalls();
    calls.push_back({"setViewCones", {cone_[0], cone_[1]}});
    calls.push_back({"setPanRange", {pan_[0], pan_[1]}});
    calls.push_back({"setTiltRange", {tilt_[0], tilt_[1]}});
    return calls;
  }
  /// Smallest and largest pan of a PanTiltEffector [deg].
  const std::array<int, 2>& panRange() const { return pan_; }
  /// Smallest and largest tilt of a PanTiltEffector [deg].
  const std::array<int, 2>& tiltRange() const { return tilt_; }

 protected:
  void saveState(StateWriter& out) const override { noise_.save(out); }
  void loadState(StateReader& in) override { noise_.load(in); }

 private:
  /// Soccer.VisionInterval overrides the interval of the robot's scene file.
  void prepare(const Event&);
  void setViewCones(int horizontal, int vertical) {
    cone_ = {horizontal, vertical};
    cache_.clear();
  }
  void setPanRange(int low, int high) { pan_ = {std::min(low, high), std::max(low, high)}; }
  void setTiltRange(int low, int high) { tilt_ = {std::min(low, high), std::max(low, high)}; }
  bool occlusion() const { return eye_.occlusion(); }
  void setOcclusion(bool on) { eye_.setOcclusion(on); }
  void setNoise(bool on) { noise_.on = on; }
  bool noisy() const { return noise_.on; }
  std::vector<int> cones() const { return {cone_[0], cone_[1]}; }
  void setNoiseParameters(double distance, double phi, double theta, double error) {
    noise_.set(distance, phi, theta, error);
  }
  const RandomStream& randomState() const { return noise_.random; }
  void setRandomState(RandomStream r) { noise_.random = r; }
  soccer::Side side() const { return eye_.state() ? eye_.state()->side() : soccer::Side::none; }
  /// True when angles are relative to the team's frame, false: to the head's.
  bool usesTeamFrame() const { return staticAxis_ || !transform(); }
  /// A point (world frame [m]) in the frame in which angles are measured, with the calibration error [m].
  Vec3f toView(const Vec3f& point) const;
  /// Polar coordinates of a point in that frame [m], without noise.
  soccer::Polar direction(const Vec3f& view) const;
  bool inCone(const soccer::Polar& p) const;
  /// A cheap test that needs no angles: true for most directions outside of the cone, false for all inside.
  bool isClearlyOutside(const Vec3f& view) const;
  /// Polar coordinates of a point in the view frame [m]. Returns false when it is outside of the cone.
  bool measure(const Vec3f& view, soccer::Polar& out);
  /// Measures an object (world frame [m]), with noise. Returns false when it is too near, out of range, outside of the
  /// cone or hidden. `body`: that of the object; nullptr: none.
  bool see(const Vec3f& point, const IRigidBody* body, soccer::Polar& out);
  /// Shortens a line to the part between its first and its last visible point. Returns false when there are none.
  bool uncover(Vec3f& begin, Vec3f& end) const;
  /// Measures the ends of the visible part of a line, with noise. Returns false when nothing of it is visible.
  bool seeLine(const soccer::VisibleObjects::FieldLine& line, soccer::Polar& begin, soccer::Polar& end);
  void beginSense();
  void writeLines(Predicates& out);
  void writeRobot(const soccer::VisibleObjects::Robot& robot, Predicates& out);

  soccer::EyeContext eye_;
  soccer::VisionNoise noise_{*this};
  std::array<int, 2> cone_{90, 90}, pan_{-90, 90}, tilt_{-20, 20};
  bool staticAxis_ = true, senseMyPos_ = false, senseMyOrien_ = false, senseBallPos_ = false, senseLine_ = false,
       senseLineName_ = false;
  float range_ = soccer::VisibleObjects::kUnlimited;
  /// The direction of a tested point, cached from the previous percept: angles are expensive to compute, and many
  /// robots do not move.
  struct CachedDirection {
    Vec3f view = Vec3f::Constant(std::numeric_limits<float>::quiet_NaN());  ///< the point in the view frame [m]
    bool inCone = false;
    soccer::Polar polar;  ///< without noise
  };
  std::vector<CachedDirection> cache_;  ///< in the order of the tests
  std::size_t nextCached_ = 0;          ///< index for the next test
  // During sense():
  Vec3f origin_ = Vec3f::Zero();       ///< own position, world frame [m]
  Vec3f calibration_ = Vec3f::Zero();  ///< VisionNoise::calibration()
  bool usesTeamFrame_ = true;
  Eigen::Matrix3f head_ = Eigen::Matrix3f::Identity();  ///< the head's axes in the world
  struct {
    double sin = 0, cos = 1;
  } halfWidth_, halfHeight_;               ///< of half the angles of the cone
  std::array<float, 2> halfWindow_{1, 1};  ///< half width and half height of the image plane at a distance of 1 m
};

}  // namespace spark
