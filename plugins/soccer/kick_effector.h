#pragma once

#include <numbers>

#include "match_lookup.h"

namespace spark {

/// `(kick elevation power)`: pushes the ball away from the player for some steps (protocol section 7).
class KickEffector : public Effector {
  SPARK_CLASS(KickEffector, Effector)
 public:
  static void describe(Description<KickEffector>& d) {
    using K = KickEffector;
    d.doc(
        "Kicks the ball away: (kick elevation power), deg and 1..maxPower. A kick lasts some steps; another one "
        "meanwhile is ignored.");
    d.property("kickMargin", &K::margin_).unit("m").min(0).doc("So near the surfaces of player and ball must be.");
    d.property("forceFactor", &K::forceFactor_).unit("N").min(0).doc("Force per power.");
    d.property("torqueFactor", &K::torqueFactor_).unit("m").min(0).doc("Torque per horizontal force, times 2 pi.");
    d.property("steps", &K::steps_).min(1).doc("So many steps a kick lasts.");
    d.property("maxPower", &K::maxPower_).unit("1").min(1).doc("Greatest power.");
    d.method("setAngleRange", &K::setAngleRange)
        .parameters({"least [deg]", "greatest [deg]"})
        .doc("Range of elevations.");
    d.method("setNoiseParams", &K::setNoise)
        .parameters({"force [power]", "theta [rad]", "phi at the ends [deg]", "phi in the middle [deg]"})
        .doc("Standard deviations of power, direction, and elevation.");
    d.property("stepsLeft", &K::stepsLeft_).readOnly().state().doc("Steps that the current kick still lasts.");
    d.property("force", &K::force_).unit("N").readOnly().state().doc("Force of the current kick.");
    d.property("random", &K::random_).state().doc("Its noise.");
    d.on<&K::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "kick"; }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double v[2];
    if (!readNumbers(read, v, 2)) return read.remark();
    elevation_ = v[0], power_ = v[1];
    pending_ = true;
    return read.remark();
  }

 protected:
  void saveState(StateWriter& out) const override {
    out.write(stepsLeft_);
    for (int i = 0; i < 3; ++i) out.write(force_[i]);
  }
  void loadState(StateReader& in) override {
    stepsLeft_ = static_cast<int>(in.readInteger());
    for (int i = 0; i < 3; ++i) force_[i] = in.readNumber();
  }

 private:
  void setAngleRange(double least, double greatest) {
    leastAngle_ = std::min(least, greatest), greatestAngle_ = std::max(least, greatest);
  }
  void setNoise(double force, double theta, double phiEnd, double phiMid) {
    sigmaForce_ = force, sigmaTheta_ = theta, sigmaPhiEnd_ = phiEnd, sigmaPhiMid_ = phiMid;
  }
  void prepare(const Event&) {
    if (!pending_ && stepsLeft_ == 0) return;
    const soccer::Player* player = match_.player(*this);
    IRigidBody* ball = player ? match_.game()->pitch().ball() : nullptr;
    if (std::exchange(pending_, false) && stepsLeft_ == 0 && ball) start(*player, *ball);
    if (stepsLeft_ == 0) return;
    --stepsLeft_;
    if (!ball) return;
    ball->enable();
    ball->addForce(force_);
    ball->addTorque(torqueFactor_ / (2 * std::numbers::pi) * Vec3(-force_.y(), force_.x(), 0));
    if (auto* state = match_.ball()) state->kickedBy(*player->agent);
  }

  void start(const soccer::Player& player, const IRigidBody& ball) {
    const SoccerSettings& s = *match_.settings();
    const Vec3 from = player.position(), way = ball.state().position - from;
    if (from.z() > s.agentRadius + 0.01 || way.norm() > s.agentRadius + s.ballRadius + margin_) return;
    const double theta = std::atan2(way.y(), way.x()) + noise(sigmaTheta_);
    const double phi = degToRad(noisyElevation());
    const double power = std::clamp(power_, 1.0, maxPower_) + noise(sigmaForce_);
    force_ =
        forceFactor_ * power * Vec3(std::cos(phi) * std::cos(theta), std::cos(phi) * std::sin(theta), std::sin(phi));
    stepsLeft_ = steps_;
  }

  /// The steadier the nearer to the ends of the range.
  double noisyElevation() {
    const double phi = std::clamp(elevation_, leastAngle_, greatestAngle_), range = greatestAngle_ - leastAngle_;
    const double middle = range > 0 ? 1 - 2 * std::abs((phi - leastAngle_) / range - 0.5) : 0;
    return phi + noise(std::max(sigmaPhiEnd_ + middle * (sigmaPhiMid_ - sigmaPhiEnd_), 0.0));
  }
  double noise(double sigma) { return sigma > 0 ? random_.normal(0, sigma) : 0; }

  MatchLookup match_;
  RandomStream random_{*this, "kick"};
  double margin_ = 0.04, forceFactor_ = 4.0, torqueFactor_ = 0.1, maxPower_ = 100, leastAngle_ = 0, greatestAngle_ = 50;
  double sigmaForce_ = 0, sigmaTheta_ = 0, sigmaPhiEnd_ = 0.9, sigmaPhiMid_ = 4.5;
  int steps_ = 10, stepsLeft_ = 0;
  Vec3 force_ = Vec3::Zero();
  double elevation_ = 0, power_ = 0;
  bool pending_ = false;
};

}  // namespace spark
