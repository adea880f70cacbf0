#include "restricted_vision_perceptor.h"

#include <cstring>

namespace spark {

using soccer::kTooNear;
using soccer::Sights;
using soccer::writePoint;

namespace {
constexpr std::size_t kMostGlances = 512;

/// Cuts a segment to what a camera that looks along y sees: y >= kTooNear and a window of the given half widths at y
/// = 1. False when nothing is left.
bool clip(Vec3f& begin, Vec3f& end, float halfX, float halfZ) {
  const Vec3f from = begin, way = end - begin;
  float first = 0, last = 1;
  // each plane: n . p >= c
  const std::pair<Vec3f, float> planes[] = {
      {{0, 1, 0}, kTooNear}, {{-1, halfX, 0}, 0}, {{1, halfX, 0}, 0}, {{0, halfZ, -1}, 0}, {{0, halfZ, 1}, 0}};
  for (const auto& [n, c] : planes) {
    const float at = n.dot(from) - c, slope = n.dot(way);
    if (slope == 0) {
      if (at < 0) return false;
      continue;
    }
    const float t = -at / slope;
    if (slope > 0)
      first = std::max(first, t);
    else
      last = std::min(last, t);
  }
  if (first >= last) return false;
  begin = from + first * way;
  end = from + last * way;
  return true;
}

}  // namespace

void RestrictedVisionPerceptor::describe(Description<RestrictedVisionPerceptor>& d) {
  using V = RestrictedVisionPerceptor;
  d.doc("Sees within a cone: flags, goals, ball, parts of players, lines.");
  d.implements<ISharedView>();
  d.implements<IEye>();
  d.implements<ISightReader>();
  d.on<&V::prepare>(phase::kPrepare);
  d.property("range", &V::range_)
      .unit("m")
      .min(0)
      .doc("Flags, goals, ball and players farther away are not seen, lines are; infinite by default.");
  d.property("staticSenseAxis", &V::staticAxis_)
      .doc("Angles from the field's x axis as the team sees it, less pan and tilt; else in the head's frame.");
  d.property("senseMyPos", &V::senseMyPos_).doc("Tells its own position too.");
  d.property("senseMyOrien", &V::senseMyOrien_).doc("Tells its own heading too.");
  d.property("senseBallPos", &V::senseBallPos_).doc("Tells the ball's position too.");
  d.property("senseLine", &V::senseLine_).doc("Sees field lines, where Soccer.FieldLinesSeen lets it.");
  d.property("senseLineName", &V::senseLineName_).doc("Accepted; lines have no names.");
  d.property("viewCones", &V::cones).unit("deg").doc("Full horizontal and vertical cone.");
  d.property("noise", &V::noisy).doc("Noise is on.");
  d.property("random", &V::randomState, &V::setRandomState).state().doc("Its noise.");
  d.method("setViewCones", &V::setViewCones)
      .parameters({"horizontal [deg]", "vertical [deg]"})
      .doc("Full cones in the head's frame; half cones with static axes.");
  d.method("setPanRange", &V::setPanRange)
      .parameters({"low [deg]", "high [deg]"})
      .doc("How far it may be turned aside.");
  d.method("setTiltRange", &V::setTiltRange)
      .parameters({"low [deg]", "high [deg]"})
      .doc("How far it may be turned up and down.");
  d.method("addNoise", &V::setNoise).parameters({"on"}).doc("Noise on or off.");
  d.method("setNoiseParams", &V::setNoiseParameters)
      .parameters({"distance [%]", "phi [deg]", "theta [deg]", "error [m]"})
      .doc("Standard deviations of distance, vertical and horizontal angle; half width of the calibration error.");
}

/// Into the frame in which it looks: the head's, or the field's as the team sees it.
Vec3f RestrictedVisionPerceptor::toView(const Vec3f& way) const {
  if (inField()) return soccer::seenBy(side(), way);
  return transform()->world().block<3, 3>(0, 0).transpose() * way;
}

soccer::Polar RestrictedVisionPerceptor::direction(const Vec3f& view) const {
  soccer::Polar p = soccer::polarOf(view);
  if (!staticAxis_) {
    p.horizontal = normalizeDeg(p.horizontal - 90);  // heads look along y
  } else if (const AgentState* s = outlook_.state()) {
    p.horizontal = normalizeDeg(p.horizontal - s->pan());
    p.vertical = normalizeDeg(p.vertical - s->tilt());
  }
  return p;
}

bool RestrictedVisionPerceptor::inCone(const soccer::Polar& p) const {
  const int divisor = staticAxis_ ? 1 : 2;
  return std::abs(p.horizontal) <= cone_[0] / divisor && std::abs(p.vertical) <= cone_[1] / divisor;
}

/// True for most of what is outside of the cone, without an angle computed: sin(angle - half) > 0, with room for
/// rounding. What it lets pass inCone judges.
bool RestrictedVisionPerceptor::isPlainlyOutside(const Vec3f& view) const {
  constexpr double kRounding = 1e-9;
  if (staticAxis_) return false;
  const double aside = std::abs(double(view.x())), ahead = view.y(), up = std::abs(double(view.z()));
  if (aside * halfWidth_.cos - ahead * halfWidth_.sin > kRounding * (aside + std::abs(ahead))) return true;
  const double level = std::sqrt(aside * aside + ahead * ahead);
  return up * halfHeight_.cos - level * halfHeight_.sin > kRounding * (up + level);
}

/// False when it is outside of the cone.
bool RestrictedVisionPerceptor::find(const Vec3f& view, soccer::Polar& out) {
  if (isPlainlyOutside(view)) return false;
  // with static axes pan and tilt count too
  if (staticAxis_ || glance_ == glances_.size()) return out = direction(view), inCone(out);
  Glance& last = glances_[glance_++];
  if (std::memcmp(last.view.data(), view.data(), 3 * sizeof(float)) != 0) {  // zeros have signs, and angles know them
    last.view = view;
    last.polar = direction(view);
    last.seen = inCone(last.polar);
  }
  out = last.polar;
  return last.seen;
}

bool RestrictedVisionPerceptor::look(const Vec3f& place, soccer::Polar& out) {
  const Vec3f way = place - here_;
  const float distance = way.norm();
  if (distance <= kTooNear || distance > outlook_.range()) return false;
  if (!find(toView(way) + noise_.calibration(), out)) return false;
  // after the cone: values slightly outside can appear
  noise_.apply(out);
  return true;
}

/// The visible part of a line. With static axes a line is seen whole or not at all.
bool RestrictedVisionPerceptor::lookAtLine(const Sights::Stroke& line, soccer::Polar& begin, soccer::Polar& end) {
  Vec3f a = toView(line.begin - here_) + noise_.calibration(), b = toView(line.end - here_) + noise_.calibration();
  const auto visible = [this](const Vec3f& p, soccer::Polar& polar) { return p.norm() > kTooNear && find(p, polar); };
  if (!visible(a, begin) || !visible(b, end)) {
    if (staticAxis_ || !clip(a, b, window_[0], window_[1])) return false;
    begin = direction(a), end = direction(b);
  }
  noise_.apply(begin), noise_.apply(end);
  return true;
}

void RestrictedVisionPerceptor::seeRobot(const Sights::Robot& robot, Predicates& out) {
  if (robot.state->side() == soccer::Side::none) return;
  soccer::Polar polar;
  bool seen = false;
  const auto begin = [&] {
    if (!std::exchange(seen, true))
      out.open(robot.state->perceptName())
          .pair("team", std::string_view(robot.state->team()))
          .pair("id", robot.state->unum());
  };
  for (const Sights::Mark& part : outlook_.sights().partsOf(robot)) {
    if (!look(part.place, polar)) continue;
    begin();
    out.open(part.object->id());
    writePolar(out, polar);
    out.close();
  }
  if (robot.parts == 0 && robot.agent != outlook_.agent() && look(robot.place, polar)) {
    begin();
    writePolar(out, polar);
  }
  if (seen) out.close();
}

void RestrictedVisionPerceptor::openEye() {
  outlook_.open(*this, range_);
  noise_.allowed = !outlook_.settings() || outlook_.settings()->visionNoise;
  here_ = soccer::placeOf(*this);
  glances_.resize(std::min(outlook_.sights().size(), kMostGlances));
  glance_ = 0;
  const double width = degToRad(std::min(cone_[0], 360) / 2), height = degToRad(std::min(cone_[1], 360) / 2);
  halfWidth_ = {std::sin(width), std::cos(width)};
  halfHeight_ = {std::sin(height), std::cos(height)};
  for (std::size_t i = 0; i < 2; ++i) window_[i] = std::tan(static_cast<float>(degToRad(std::min(cone_[i], 178) / 2)));
}

void RestrictedVisionPerceptor::sense(Predicates& out, const Event&) {
  openEye();
  const Sights& sights = outlook_.sights();
  soccer::Polar polar;
  out.open(predicateName_);
  for (const Sights::Mark& m : sights.field()) {
    if (!look(m.place, polar)) continue;
    out.open(m.object->perceptName());
    writePolar(out, polar);
    out.close();
  }
  for (const std::uint32_t i : outlook_.robotsNear(here_)) seeRobot(sights.robots()[i], out);
  const bool cheats = outlook_.settings() && outlook_.settings()->cheats;
  if (senseMyPos_ || cheats) writePoint(out, "mypos", soccer::seenBy(side(), here_));
  if ((senseMyOrien_ || cheats) && transform()) soccer::writeHeading(out, transform()->world(), side());
  if (const Sights::Mark* ball = senseBallPos_ || cheats ? sights.ball() : nullptr)
    writePoint(out, "ballpos", soccer::seenBy(side(), ball->place));
  if (senseLine_ && (!outlook_.settings() || outlook_.settings()->fieldLinesSeen)) seeLines(out);
  out.close();
}

void RestrictedVisionPerceptor::seeLines(Predicates& out) {
  soccer::Polar begin, end;
  for (const Sights::Stroke& line : outlook_.sights().lines()) {
    if (!lookAtLine(line, begin, end)) continue;
    out.open("L");
    writePolar(out, begin);
    writePolar(out, end);
    out.close();
  }
}

Matrix RestrictedVisionPerceptor::view() {
  outlook_.bring(*this, range_);
  if (!inField()) return soccer::headView(*transform());
  Matrix frame = soccer::fieldView(soccer::placeOf(*this), side());
  if (const AgentState* s = outlook_.state())
    frame = frame * rotationDeg(0, 0, static_cast<float>(s->pan())) * rotationDeg(0, static_cast<float>(-s->tilt()), 0);
  return frame;
}

std::array<double, 2> RestrictedVisionPerceptor::cone() {
  const auto full = [this](int cone, double most) { return std::min(most, 2.0 * (staticAxis_ ? cone : cone / 2)); };
  return {full(cone_[0], 360), full(cone_[1], 180)};
}

double RestrictedVisionPerceptor::range() {
  outlook_.bring(*this, range_);
  return outlook_.range();
}

/// With static axes pan and tilt are taken from the angles, which is no rotation.
Vec3f RestrictedVisionPerceptor::placeOf(double distance, double horizontalDeg, double verticalDeg) {
  if (!inField()) {
    const Matrix frame = view();
    return positionOf(frame) + frame.block<3, 3>(0, 0) * soccer::pointOf({distance, horizontalDeg, verticalDeg});
  }
  outlook_.bring(*this, range_);
  const AgentState* s = outlook_.state();
  const double pan = s ? s->pan() : 0, tilt = s ? s->tilt() : 0;
  return soccer::placeOf(*this) +
         soccer::seenBy(side(), soccer::pointOf({distance, horizontalDeg + pan, verticalDeg + tilt}));
}

void RestrictedVisionPerceptor::sights(std::vector<Sight>& out) {
  outlook_.bring(*this, range_);
  soccer::tellSights(outlook_.sights(), out);
}

void RestrictedVisionPerceptor::prepare(const Event&) {
  outlook_.refresh(*this);
  if (const SoccerSettings* league = outlook_.settings(); league && league->visionInterval > 0)
    interval_ = league->visionInterval;
}

}  // namespace spark
