#pragma once
/// \file
/// Effectors of the sphere robots of 2004, besides the kick: drive, catch, pan and tilt. Formulas are those of the
/// installed base, those of catch and its values are the manual's.

#include "match_lookup.h"
#include "restricted_vision_perceptor.h"

namespace spark {

/// `(drive x y z)`: a force in the team's frame that acts in every step until the next command.
class DriveEffector : public Effector {
  SPARK_CLASS(DriveEffector, Effector)
 public:
  static void describe(Description<DriveEffector>& d) {
    using E = DriveEffector;
    d.doc("Drives the sphere: (drive x y z), length up to maxPower, until the next command; acts on the ground only.");
    d.property("forceFactor", &E::forceFactor_).unit("N").min(0).doc("Force per unit of power.");
    d.property("maxPower", &E::maxPower_)
        .unit("1")
        .min(0)
        .doc("Largest length of (x y z): longer vectors are shortened.");
    d.property("sigma", &E::sigma_).min(0).doc("Relative standard deviation of each component.");
    d.property("consumption", &E::consumption_).unit("%/(N s)").min(0).doc("Energy used per unit of force and time.");
    d.property("force", &E::force_).unit("N").readOnly().state().doc("The force, in the team's frame.");
    d.property("random", &E::random_).state().doc("Its noise.");
    d.on<&E::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "drive"; }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double v[3];
    if (!readNumbers(read, v, 3)) return read.remark();
    Vec3 power(v[0], v[1], v[2]);
    // norm() would overflow for 1e300.
    if (const double length = power.stableNorm(); length > maxPower_) power *= maxPower_ / length;
    for (int i = 0; i < 3; ++i) force_[i] = power[i] * (sigma_ > 0 ? random_.normal(1, sigma_) : 1) * forceFactor_;
    return read.remark();
  }

 protected:
  void saveState(StateWriter& out) const override {
    for (int i = 0; i < 3; ++i) out.write(force_[i]);
  }
  void loadState(StateReader& in) override {
    for (int i = 0; i < 3; ++i) force_[i] = in.readNumber();
  }

 private:
  void prepare(const Event& event) {
    if (force_.isZero()) return;
    const soccer::Player* player = match_.player(*this);
    if (!player) return refuse(0, [&] { return match_.whyNoPlayer(); });
    if (player->position().z() > match_.settings()->agentRadius + 0.001) return;
    if (!player->state->drain(force_.norm() * consumption_ * event.step))
      return refuse(1, [&] {
        return fmt::format("expected a battery with enough energy, found {:.2f} % left", player->state->battery());
      });
    const double d = direction(player->side());
    player->torso->enable();
    player->torso->addForce(Vec3(d * force_.x(), d * force_.y(), force_.z()));
  }

  MatchLookup match_;
  RandomStream random_{*this, "drive"};
  double forceFactor_ = 60, maxPower_ = 100, sigma_ = 0, consumption_ = 1.0 / 18000;
  Vec3 force_ = Vec3::Zero();
};

/// `(catch)`: the goalie catches the ball inside its penalty area and places it in front of itself.
class CatchEffector : public Effector, public soccer::IBallAction {
  SPARK_CLASS(CatchEffector, Effector)
 public:
  static void describe(Description<CatchEffector>& d) {
    d.doc("The goalie (number 1) catches the ball inside its penalty area: (catch).");
    d.property("catchMargin", &CatchEffector::margin_)
        .unit("m")
        .min(0)
        .doc("Largest distance between the surfaces of goalie and ball.");
    d.on<&CatchEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "catch"; }
  std::string act(const Element& action) override {
    match_.refresh(*this);
    if (auto* state = match_.ball(); state && !pending_) state->announce(*this, *this);
    pending_ = true;
    return expectNoArguments(action);
  }
  Kind kind() const override { return Kind::catching; }
  const soccer::Player* reaches() override {
    const soccer::Player* goalie = match_.player(*this);
    return pending_ && goalie && fault(*goalie) == 0 ? goalie : nullptr;
  }

 private:
  static constexpr double kClearRadius = 2, kClearDistance = 5, kGap = 0.07;  ///< of the installed base [m]

  /// The number of what is against a catch, 0: nothing.
  int fault(const soccer::Player& goalie) const {
    const soccer::Pitch& pitch = match_.game()->pitch();
    const Vec3 ball = pitch.ballPosition();
    if (goalie.state->unum() != 1) return 1;
    if (!pitch.ball() || !pitch.penaltyArea(goalie.side()).contains(ball.x(), ball.y())) return 2;
    if (goalie.position().z() > pitch.settings().agentRadius + 0.01) return 3;
    return (ball - goalie.position()).norm() > reach(pitch.settings()) ? 4 : 0;
  }
  double reach(const SoccerSettings& s) const { return s.agentRadius + s.ballRadius + margin_; }

  void prepare(const Event&) {
    if (!pending_) return;
    const soccer::Player* goalie = match_.player(*this);
    const bool wins = !match_.ball() || match_.ball()->mayAct(Kind::catching);
    pending_ = false;
    if (!goalie) return refuse(0, [&] { return match_.whyNoPlayer(); });
    const soccer::Pitch& pitch = match_.game()->pitch();
    const SoccerSettings& s = pitch.settings();
    const Vec3 from = goalie->position();
    switch (fault(*goalie)) {
      case 1:
        return refuse(
            1, [&] { return fmt::format("expected the goalie, number 1, found number {}", goalie->state->unum()); });
      case 2:
        return refuse(2, [] { return "expected the ball in the own penalty area, found it elsewhere"; });
      case 3:
        return refuse(3, [] { return "expected the goalie on the ground, found it in the air"; });
      case 4:
        return refuse(4, [&] {
          return fmt::format("expected the ball within {:.2f} m, found it at {:.2f} m", reach(s),
                             (pitch.ballPosition() - from).norm());
        });
      default:
        break;
    }
    if (!wins) {
      if (Log& log = kernel().log(); log.enabled(Level::debug))
        log.debug("agent {}: catch: a player kicks the ball before", goalie->agent->number());
      return;
    }

    // Players near the new position of the ball are moved away.
    const Vec3 target = from + Vec3(direction(goalie->side()) * (s.agentRadius + s.ballRadius + kGap), 0, 0);
    for (const soccer::Player& p : pitch.players())
      if (&p != goalie && p.torso && p.side() != soccer::Side::none)
        pitch.clearSphere(p, target, kClearRadius, kClearDistance);
    pitch.placeBall(target);
    if (auto* state = match_.ball()) state->kickedBy(*goalie->agent);
  }

  MatchLookup match_;
  double margin_ = 1.0;
  bool pending_ = false;
};

/// `(pantilt dpan dtilt)`: turns the direction of view of the cone vision [deg].
class PanTiltEffector : public Effector {
  SPARK_CLASS(PanTiltEffector, Effector)
 public:
  static void describe(Description<PanTiltEffector>& d) {
    using E = PanTiltEffector;
    d.doc("Turns the agent's view: (pantilt dpan dtilt), deg.");
    d.property("maxPanAngleDelta", &E::maxPan_).unit("deg").min(0).doc("Largest change of pan by one command.");
    d.property("maxTiltAngleDelta", &E::maxTilt_).unit("deg").min(0).doc("Largest change of tilt by one command.");
    d.property("sigma", &E::sigma_).unit("deg").min(0).doc("Standard deviation of a change.");
    d.property("random", &E::random_).state().doc("Its noise.");
    d.on<&E::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "pantilt"; }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    double v[2];
    if (!readNumbers(read, v, 2)) return read.remark();
    pan_ = v[0], tilt_ = v[1];
    pending_ = true;
    return read.remark();
  }

 private:
  void prepare(const Event&) {
    if (!std::exchange(pending_, false)) return;
    match_.refresh(*this);
    AgentState* state = match_.state();
    if (!state) return refuse(0, [] { return "expected a player, found a robot without an AgentState"; });

    // The ranges are those of the robot's cone vision; without one the installed base's defaults.
    std::array<int, 2> pan{-90, 90}, tilt{-20, 20};
    if (auto* eye = match_.agent() ? eyeOf(*match_.agent()) : nullptr) pan = eye->panRange(), tilt = eye->tiltRange();
    const auto turned = [this](double current, double wanted, int limit, const std::array<int, 2>& range) {
      const double delta = std::clamp(wanted, -double(limit), double(limit)) + random_.normal(0, sigma_);
      return std::clamp(current + delta, double(range[0]), double(range[1]));
    };
    const double newPan = turned(state->pan(), pan_, maxPan_, pan);
    state->setView(newPan, turned(state->tilt(), tilt_, maxTilt_, tilt));
  }
  /// The first cone vision below `node`; nullptr if there is none.
  static RestrictedVisionPerceptor* eyeOf(const Node& node) {
    for (const auto& c : node.children()) {
      if (auto eye = c->as<RestrictedVisionPerceptor>()) return eye;
      if (Node* inner = c->asNode())
        if (auto* eye = eyeOf(*inner)) return eye;
    }
    return nullptr;
  }

  MatchLookup match_;
  RandomStream random_{*this, "pantilt"};
  int maxPan_ = 90, maxTilt_ = 10;
  double sigma_ = 0.25, pan_ = 0, tilt_ = 0;
  bool pending_ = false;
};

}  // namespace spark
