#pragma once

#include <numbers>

#include "api/scene_calls.h"
#include "match_lookup.h"

namespace spark {

/// `(kick elevation power)`: a force on the ball, away from the player, for some steps. The kick of the sphere robots
/// of 2004, with the formulas of the installed base.
class KickEffector : public Effector, public ISceneCalls, public soccer::IBallAction {
  SPARK_CLASS(KickEffector, Effector)
 public:
  static void describe(Description<KickEffector>& d) {
    using K = KickEffector;
    d.doc(
        "Kicks the ball away: (kick elevation power), deg and 1..maxPower. A kick lasts some steps; others are ignored "
        "meanwhile.");
    d.implements<ISceneCalls>();
    d.property("kickMargin", &K::margin_)
        .unit("m")
        .min(0)
        .doc("Largest distance between the surfaces of player and ball.");
    d.property("forceFactor", &K::forceFactor_).unit("N").min(0).doc("Force per unit of power.");
    d.property("torqueFactor", &K::torqueFactor_)
        .unit("m")
        .min(0)
        .doc("Torque per unit of horizontal force, times 2 pi.");
    d.property("steps", &K::steps_).min(1).doc("Number of steps that a kick lasts.");
    d.property("maxPower", &K::maxPower_).unit("1").min(1).doc("Largest power.");
    d.method("setAngleRange", &K::setAngleRange)
        .parameters({"smallest [deg]", "largest [deg]"})
        .doc("Range of elevations.");
    d.method("setNoiseParams", &K::setNoise)
        .parameters({"force [power]", "theta [rad]", "phi at the ends [deg]", "phi in the middle [deg]"})
        .doc("Standard deviations of power, direction and elevation.");
    d.property("stepsLeft", &K::stepsLeft_).readOnly().state().doc("Remaining steps of the current kick.");
    d.property("force", &K::force_).unit("N").readOnly().state().doc("Force of the current kick.");
    d.property("random", &K::random_).state().doc("Its noise.");
    d.on<&K::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "kick"; }
  std::vector<SceneCall> sceneCalls() const override {
    return {{"setAngleRange", {minAngle_, maxAngle_}},
            {"setNoiseParams", {sigmaForce_, sigmaTheta_, sigmaPhiEnd_, sigmaPhiMid_}}};
  }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double v[2];
    if (!readNumbers(read, v, 2)) return read.remark();
    elevation_ = v[0], power_ = v[1];
    match_.refresh(*this);
    if (auto* state = match_.ball(); state && !pending_) state->announce(*this, *this);
    pending_ = true;
    return read.remark();
  }
  Kind kind() const override { return Kind::kick; }
  const soccer::Player* reaches() override {
    const soccer::Player* player = match_.player(*this);
    const IRigidBody* ball = player ? match_.game()->pitch().ball() : nullptr;
    return pending_ && ball && stepsLeft_ == 0 && !isInAir(*player) && distance(*player, *ball) <= reach() ? player
                                                                                                           : nullptr;
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
  void setAngleRange(double smallest, double largest) {
    minAngle_ = std::min(smallest, largest), maxAngle_ = std::max(smallest, largest);
  }
  void setNoise(double force, double theta, double phiEnd, double phiMid) {
    sigmaForce_ = force, sigmaTheta_ = theta, sigmaPhiEnd_ = phiEnd, sigmaPhiMid_ = phiMid;
  }
  void prepare(const Event&) {
    if (!pending_ && stepsLeft_ == 0) return;
    const soccer::Player* player = match_.player(*this);
    IRigidBody* ball = player ? match_.game()->pitch().ball() : nullptr;
    const bool wins = !pending_ || !match_.ball() || match_.ball()->mayAct(Kind::kick);
    if (std::exchange(pending_, false)) {
      if (!player)
        refuse(0, [&] { return match_.whyNoPlayer(); });
      else if (!ball)
        refuse(1, [] { return "expected a ball, found none"; });
      else if (stepsLeft_ > 0)
        miss(*player, "a kick is under way");
      else
        start(*player, *ball, wins);
    }
    if (stepsLeft_ == 0) return;
    --stepsLeft_;
    if (!ball) return;

    // The torque gives the ball the spin of a rolling ball; each step counts as a touch.
    ball->enable();
    ball->addForce(force_);
    ball->addTorque(torqueFactor_ / (2 * std::numbers::pi) * Vec3(-force_.y(), force_.x(), 0));
    if (auto* state = match_.ball()) state->kickedBy(*player->agent);
  }

  /// Notes a kick without effect during play. It is no mistake: a player cannot know it in advance.
  void miss(const soccer::Player& player, const char* why) {
    if (Log& log = kernel().log(); log.enabled(Level::debug))
      log.debug("agent {}: kick: {}", player.agent->number(), why);
  }

  /// Starts a kick if the player is on the ground and near enough to the ball.
  /// `wins`: no goalie catches the ball before.
  void start(const soccer::Player& player, const IRigidBody& ball, bool wins) {
    const Vec3 offset = ball.state().position - player.position();
    if (!wins) return miss(player, "the goalie catches the ball before");
    if (isInAir(player)) return miss(player, "the player is in the air");
    const double most = reach(), found = distance(player, ball);
    if (found > most && found < most + kNear) return miss(player, "the ball is just out of reach");
    if (found > most)
      return refuse(
          4, [&] { return fmt::format("expected the ball within {:.2f} m, found it at {:.2f} m", most, found); });
    const double theta = std::atan2(offset.y(), offset.x()) + noise(sigmaTheta_);
    const double phi = degToRad(noisyElevation());
    const double power = std::clamp(power_, 1.0, maxPower_) + noise(sigmaForce_);
    force_ =
        forceFactor_ * power * Vec3(std::cos(phi) * std::cos(theta), std::cos(phi) * std::sin(theta), std::sin(phi));
    stepsLeft_ = steps_;
  }

  bool isInAir(const soccer::Player& player) const {
    return player.position().z() > match_.settings()->agentRadius + 0.01;
  }
  static double distance(const soccer::Player& player, const IRigidBody& ball) {
    return (ball.state().position - player.position()).norm();
  }
  double reach() const { return match_.settings()->agentRadius + match_.settings()->ballRadius + margin_; }

  /// The elevation with noise [deg]. The standard deviation is interpolated between that in the middle of the range and
  /// that at its ends.
  double noisyElevation() {
    const double phi = std::clamp(elevation_, minAngle_, maxAngle_), range = maxAngle_ - minAngle_;
    const double middle = range > 0 ? 1 - 2 * std::abs((phi - minAngle_) / range - 0.5) : 0;
    return phi + noise(std::max(sigmaPhiEnd_ + middle * (sigmaPhiMid_ - sigmaPhiEnd_), 0.0));
  }
  double noise(double sigma) { return sigma > 0 ? random_.normal(0, sigma) : 0; }

  MatchLookup match_;
  RandomStream random_{*this, "kick"};
  /// A kick that misses by less is no mistake: a fast ball covers this while the command is under way [m].
  static constexpr double kNear = 1;
  double margin_ = 0.04, forceFactor_ = 4.0, torqueFactor_ = 0.1, maxPower_ = 100, minAngle_ = 0, maxAngle_ = 50;
  double sigmaForce_ = 0, sigmaTheta_ = 0, sigmaPhiEnd_ = 0.9, sigmaPhiMid_ = 4.5;
  int steps_ = 10, stepsLeft_ = 0;
  Vec3 force_ = Vec3::Zero();         ///< world frame [N]
  double elevation_ = 0, power_ = 0;  ///< of the command; deg and units of power
  bool pending_ = false;
};

}  // namespace spark
