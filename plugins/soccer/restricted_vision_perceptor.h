#pragma once

#include <array>

#include "see_reader.h"
#include "vision.h"

namespace spark {

/// Sees within a cone, in the frame of the head or along the field's axes:
/// `(See (G1R (pol ...)) (B (pol ...)) (P (team A) (id 3) (rlowerarm (pol ...)) ...))`.
class RestrictedVisionPerceptor : public Perceptor, public ISharedView, public IEye, public soccer::SeeReader {
  SPARK_CLASS(RestrictedVisionPerceptor, Perceptor)
 public:
  RestrictedVisionPerceptor() { predicateName_ = "See"; }
  static void describe(Description<RestrictedVisionPerceptor>& d);
  void sense(Predicates& out, const Event& event) override;
  void share(std::uint64_t round) override { outlook_.share(*this, round, range_); }

  Matrix view() override;
  std::array<double, 2> cone() override;
  double range() override;
  Vec3f placeOf(double distance, double horizontalDeg, double verticalDeg) override;
  void sights(std::vector<Sight>& out) override;
  /// deg, of the static axis mode.
  const std::array<int, 2>& panRange() const { return pan_; }
  const std::array<int, 2>& tiltRange() const { return tilt_; }

 protected:
  void saveState(StateWriter& out) const override { noise_.save(out); }
  void loadState(StateReader& in) override { noise_.load(in); }

 private:
  /// The league may look more or less often than the robot's scene file says.
  void prepare(const Event&);
  void setViewCones(int horizontal, int vertical) {
    cone_ = {horizontal, vertical};
    glances_.clear();
  }
  void setPanRange(int low, int high) { pan_ = {std::min(low, high), std::max(low, high)}; }
  void setTiltRange(int low, int high) { tilt_ = {std::min(low, high), std::max(low, high)}; }
  void setNoise(bool on) { noise_.on = on; }
  bool noisy() const { return noise_.on; }
  std::vector<int> cones() const { return {cone_[0], cone_[1]}; }
  void setNoiseParameters(double distance, double phi, double theta, double error) {
    noise_.set(distance, phi, theta, error);
  }
  const RandomStream& randomState() const { return noise_.random; }
  void setRandomState(RandomStream r) { noise_.random = r; }
  soccer::Side side() const { return outlook_.state() ? outlook_.state()->side() : soccer::Side::none; }
  bool inField() const { return staticAxis_ || !transform(); }
  Vec3f toView(const Vec3f& way) const;
  soccer::Polar direction(const Vec3f& view) const;
  bool inCone(const soccer::Polar& p) const;
  bool isPlainlyOutside(const Vec3f& view) const;
  bool find(const Vec3f& view, soccer::Polar& out);
  bool look(const Vec3f& place, soccer::Polar& out);
  bool lookAtLine(const soccer::Sights::Stroke& line, soccer::Polar& begin, soccer::Polar& end);
  void openEye();
  void seeLines(Predicates& out);
  void seeRobot(const soccer::Sights::Robot& robot, Predicates& out);

  soccer::Outlook outlook_;
  soccer::VisionNoise noise_{*this};
  std::array<int, 2> cone_{90, 90}, pan_{-90, 90}, tilt_{-20, 20};
  bool staticAxis_ = true, senseMyPos_ = false, senseMyOrien_ = false, senseBallPos_ = false, senseLine_ = false,
       senseLineName_ = false;
  float range_ = soccer::Sights::kUnlimited;
  /// What stood where in its view when it looked last: robots at rest see the same again, and angles are what seeing
  /// costs.
  struct Glance {
    Vec3f view = Vec3f::Constant(std::numeric_limits<float>::quiet_NaN());  ///< in the frame in which it looks [m]
    bool seen = false;
    soccer::Polar polar;  ///< without noise
  };
  std::vector<Glance> glances_;  ///< in the order of looking
  std::size_t glance_ = 0;       ///< the next one
  // while it looks
  Vec3f here_ = Vec3f::Zero();  ///< m
  struct {
    double sin = 0, cos = 1;
  } halfWidth_, halfHeight_;           ///< of the cone
  std::array<float, 2> window_{1, 1};  ///< half width and height of what it sees, 1 m ahead
};

}  // namespace spark
