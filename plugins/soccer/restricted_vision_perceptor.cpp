#include "restricted_vision_perceptor.h"

#include <cstring>

namespace spark {

using soccer::kMinDistance;
using soccer::VisibleObjects;
using soccer::writePoint;

namespace {
constexpr std::size_t kMaxCached = 512;  // directions

/// Clips a segment to the view frustum of a camera that looks along y: y >= kMinDistance, and a window with the given
/// half width and height at y = 1. Returns false when nothing is left.
bool clip(Vec3f& begin, Vec3f& end, float halfX, float halfZ) {
  const Vec3f from = begin, along = end - begin;
  // The visible part is from + t * along for first <= t <= last. Each plane (n . p >= c) shortens it.
  float first = 0, last = 1;
  const std::pair<Vec3f, float> planes[] = {
      {{0, 1, 0}, kMinDistance}, {{-1, halfX, 0}, 0}, {{1, halfX, 0}, 0}, {{0, halfZ, -1}, 0}, {{0, halfZ, 1}, 0}};
  for (const auto& [n, c] : planes) {
    const float distance = n.dot(from) - c, slope = n.dot(along);
    if (slope == 0) {
      if (distance < 0) return false;
      continue;
    }
    const float t = -distance / slope;
    if (slope > 0)
      first = std::max(first, t);
    else
      last = std::min(last, t);
  }
  if (first >= last) return false;
  begin = from + first * along;
  end = from + last * along;
  return true;
}

}  // namespace

void RestrictedVisionPerceptor::describe(Description<RestrictedVisionPerceptor>& d) {
  using V = RestrictedVisionPerceptor;
  d.doc("Sees within a cone: flags, goals, ball, parts of players, lines.");
  d.implements<ISharedView>();
  d.implements<IEye>();
  d.implements<ISightReader>();
  d.implements<ISceneCalls>();
  d.on<&V::prepare>(phase::kPrepare);
  d.property("range", &V::range_)
      .unit("m")
      .min(0)
      .doc("Flags, goals, ball and players farther away are not seen, lines are; infinite by default.");
  d.property("staticSenseAxis", &V::staticAxis_)
      .doc("Angles are relative to the x axis of the team's frame, minus pan and tilt; false: to the head's frame.");
  d.property("occlusion", &V::occlusion, &V::setOcclusion)
      .doc("What is behind a collider is not seen. Soccer.VisionOcclusion switches it on for all.");
  d.property("senseMyPos", &V::senseMyPos_).doc("Reports its own position, too: (mypos x y z).");
  d.property("senseMyOrien", &V::senseMyOrien_).doc("Reports its own heading, too: (myorien deg).");
  d.property("senseBallPos", &V::senseBallPos_).doc("Reports the ball's true position, too: (ballpos x y z).");
  d.property("senseLine", &V::senseLine_).doc("Sees field lines, if Soccer.FieldLinesSeen is true, too.");
  d.property("senseLineName", &V::senseLineName_).doc("Accepted; lines have no names.");
  d.property("viewCones", &V::cones).unit("deg").doc("Horizontal and vertical angle of the view cone.");
  d.property("noise", &V::noisy).doc("Noise is on.");
  d.property("random", &V::randomState, &V::setRandomState).state().doc("Its noise.");
  d.method("setViewCones", &V::setViewCones)
      .parameters({"horizontal [deg]", "vertical [deg]"})
      .doc("Angles of the view cone: full angles in the head's frame, half angles with static axes.");
  d.method("setPanRange", &V::setPanRange).parameters({"low [deg]", "high [deg]"}).doc("Range of pan angles.");
  d.method("setTiltRange", &V::setTiltRange).parameters({"low [deg]", "high [deg]"}).doc("Range of tilt angles.");
  d.method("addNoise", &V::setNoise).parameters({"on"}).doc("Noise on or off.");
  d.method("setNoiseParams", &V::setNoiseParameters)
      .parameters({"distance [%]", "phi [deg]", "theta [deg]", "error [m]"})
      .doc("Standard deviations of distance, vertical and horizontal angle; half width of the calibration error.");
}

Vec3f RestrictedVisionPerceptor::toView(const Vec3f& point) const {
  const Vec3f offset = point - origin_;
  return (usesTeamFrame_ ? soccer::toTeamFrame(side(), offset) : Vec3f(head_.transpose() * offset)) + calibration_;
}

soccer::Polar RestrictedVisionPerceptor::direction(const Vec3f& view) const {
  soccer::Polar p = soccer::toPolar(view);
  if (!staticAxis_) {
    p.horizontal = normalizeDeg(p.horizontal - 90);  // heads look along their y axis
  } else if (const AgentState* s = eye_.state()) {
    p.horizontal = normalizeDeg(p.horizontal - s->pan());
    p.vertical = normalizeDeg(p.vertical - s->tilt());
  }
  return p;
}

bool RestrictedVisionPerceptor::inCone(const soccer::Polar& p) const {
  // As in the installed base: integer halves in the head's frame, the whole values with static axes.
  const int divisor = staticAxis_ ? 1 : 2;
  const int maxHorizontal = cone_[0] / divisor, maxVertical = cone_[1] / divisor;
  return std::abs(p.horizontal) <= maxHorizontal && std::abs(p.vertical) <= maxVertical;
}

bool RestrictedVisionPerceptor::isClearlyOutside(const Vec3f& view) const {
  constexpr double kRounding = 1e-9;
  if (staticAxis_) return false;
  // sin(angle - half) > 0 by the addition theorem, with a margin for rounding.
  const double lateral = std::abs(double(view.x())), forward = view.y(), vertical = std::abs(double(view.z()));
  if (lateral * halfWidth_.cos - forward * halfWidth_.sin > kRounding * (lateral + std::abs(forward))) return true;
  const double horizontal = std::sqrt(lateral * lateral + forward * forward);
  return vertical * halfHeight_.cos - horizontal * halfHeight_.sin > kRounding * (vertical + horizontal);
}

bool RestrictedVisionPerceptor::measure(const Vec3f& view, soccer::Polar& out) {
  // With static axes the direction depends on pan and tilt, too: it is not cached.
  if (staticAxis_ || nextCached_ == cache_.size()) return out = direction(view), inCone(out);
  CachedDirection& cached = cache_[nextCached_++];
  // Compare bits: angles differ for zeros of different sign.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  if (std::memcmp(cached.view.data(), view.data(), 3 * sizeof(float)) != 0) {
    cached.view = view;
    cached.polar = direction(view);
    cached.inCone = inCone(cached.polar);
  }
  out = cached.polar;
  return cached.inCone;
}

bool RestrictedVisionPerceptor::see(const Vec3f& point, const IRigidBody* body, soccer::Polar& out) {
  // The cheapest test first: most points are outside of the cone.
  const Vec3f view = toView(point);
  if (isClearlyOutside(view)) return false;
  const float distance = (point - origin_).norm();
  if (distance <= kMinDistance || distance > eye_.range()) return false;
  if (!measure(view, out) || eye_.isHidden(origin_, point, body)) return false;
  // After the test of the cone, as in the installed base: reported angles can be slightly outside.
  noise_.apply(out);
  return true;
}

bool RestrictedVisionPerceptor::uncover(Vec3f& begin, Vec3f& end) const {
  constexpr int kPieces = 16;
  const auto at = [&](int i) { return Vec3f(begin + (end - begin) * (static_cast<float>(i) / kPieces)); };
  const auto visible = [&](int i) { return !eye_.isHidden(origin_, at(i), nullptr); };
  int first = 0, last = kPieces;
  while (first < last && !visible(first)) ++first;
  while (last > first && !visible(last)) --last;
  if (first == last) return false;
  const Vec3f from = at(first);
  end = at(last);
  begin = from;
  return true;
}

bool RestrictedVisionPerceptor::seeLine(const VisibleObjects::FieldLine& line, soccer::Polar& begin,
                                        soccer::Polar& end) {
  Vec3f from = line.begin, to = line.end;
  if (eye_.hides() && !uncover(from, to)) return false;
  Vec3f a = toView(from), b = toView(to);
  const auto visible = [this](const Vec3f& p, soccer::Polar& polar) {
    return p.norm() > kMinDistance && !isClearlyOutside(p) && measure(p, polar);
  };
  // With static axes a line is seen entirely or not at all.
  if (!visible(a, begin) || !visible(b, end)) {
    if (staticAxis_ || !clip(a, b, halfWindow_[0], halfWindow_[1])) return false;
    begin = direction(a), end = direction(b);
  }
  noise_.apply(begin), noise_.apply(end);
  return true;
}

void RestrictedVisionPerceptor::writeRobot(const VisibleObjects::Robot& robot, Predicates& out) {
  if (robot.state->side() == soccer::Side::none) return;
  soccer::Polar polar;
  // The list is opened with the first part that is seen.
  bool opened = false;
  const auto open = [&] {
    if (!std::exchange(opened, true))
      out.open(robot.state->perceptName())
          .pair("team", std::string_view(robot.state->team()))
          .pair("id", robot.state->unum());
  };
  for (const VisibleObjects::Object& part : eye_.objects().partsOf(robot)) {
    if (!see(part.position, part.body, polar)) continue;
    open();
    out.open(part.state->id());
    writePolar(out, polar);
    out.close();
  }
  if (robot.parts == 0 && robot.agent != eye_.agent() && see(robot.position, robot.body, polar)) {
    open();
    writePolar(out, polar);
  }
  if (opened) out.close();
}

void RestrictedVisionPerceptor::beginSense() {
  eye_.beginSense(*this, range_);
  noise_.allowed = !eye_.settings() || eye_.settings()->visionNoise;
  origin_ = soccer::worldPosition(*this);
  usesTeamFrame_ = usesTeamFrame();
  if (!usesTeamFrame_) head_ = transform()->world().block<3, 3>(0, 0);
  calibration_ = noise_.calibration();
  cache_.resize(std::min(eye_.objects().size(), kMaxCached));
  nextCached_ = 0;
  const int halfPan = std::min(cone_[0], 360) / 2, halfTilt = std::min(cone_[1], 360) / 2;  // whole degrees
  const double width = degToRad(halfPan), height = degToRad(halfTilt);
  halfWidth_ = {std::sin(width), std::cos(width)};
  halfHeight_ = {std::sin(height), std::cos(height)};
  for (std::size_t i = 0; i < 2; ++i) {
    const int half = std::min(cone_[i], 178) / 2;
    halfWindow_[i] = std::tan(static_cast<float>(degToRad(half)));
  }
}

void RestrictedVisionPerceptor::sense(Predicates& out, const Event&) {
  beginSense();
  const VisibleObjects& objects = eye_.objects();
  soccer::Polar polar;
  out.open(predicateName_);
  for (const VisibleObjects::Object& o : objects.field()) {
    if (!see(o.position, o.body, polar)) continue;
    out.open(o.state->perceptName());
    writePolar(out, polar);
    out.close();
  }
  for (const std::uint32_t i : eye_.robotsNear(origin_)) writeRobot(objects.robots()[i], out);
  const bool cheats = eye_.settings() && eye_.settings()->cheats;
  if (senseMyPos_ || cheats) writePoint(out, "mypos", soccer::toTeamFrame(side(), origin_));
  if ((senseMyOrien_ || cheats) && transform()) soccer::writeHeading(out, transform()->world(), side());
  if (const VisibleObjects::Object* ball = senseBallPos_ || cheats ? objects.ball() : nullptr)
    writePoint(out, "ballpos", soccer::toTeamFrame(side(), ball->position));
  if (senseLine_ && (!eye_.settings() || eye_.settings()->fieldLinesSeen)) writeLines(out);
  out.close();
}

void RestrictedVisionPerceptor::writeLines(Predicates& out) {
  soccer::Polar begin, end;
  for (const VisibleObjects::FieldLine& line : eye_.objects().lines()) {
    if (!seeLine(line, begin, end)) continue;
    out.open("L");
    writePolar(out, begin);
    writePolar(out, end);
    out.close();
  }
}

Matrix RestrictedVisionPerceptor::view() {
  eye_.update(*this, range_);
  if (!usesTeamFrame()) return soccer::headView(*transform());
  Matrix frame = soccer::teamView(soccer::worldPosition(*this), side());
  if (const AgentState* s = eye_.state())
    frame = frame * rotationDeg(0, 0, static_cast<float>(s->pan())) * rotationDeg(0, static_cast<float>(-s->tilt()), 0);
  return frame;
}

std::array<double, 2> RestrictedVisionPerceptor::cone() {
  const auto full = [this](int cone, double max) { return std::min(max, 2.0 * (staticAxis_ ? cone : cone / 2)); };
  return {full(cone_[0], 360), full(cone_[1], 180)};
}

double RestrictedVisionPerceptor::range() {
  eye_.update(*this, range_);
  return eye_.range();
}

/// With static axes pan and tilt are subtracted from the angles, as in the installed base. That is not a rotation, so
/// they are added to the angles here.
Vec3f RestrictedVisionPerceptor::placeOf(double distance, double horizontalDeg, double verticalDeg) {
  if (!usesTeamFrame()) {
    const Matrix frame = view();
    return positionOf(frame) + frame.block<3, 3>(0, 0) * soccer::toCartesian({distance, horizontalDeg, verticalDeg});
  }
  eye_.update(*this, range_);
  const AgentState* s = eye_.state();
  const double pan = s ? s->pan() : 0, tilt = s ? s->tilt() : 0;
  return soccer::worldPosition(*this) +
         soccer::toTeamFrame(side(), soccer::toCartesian({distance, horizontalDeg + pan, verticalDeg + tilt}));
}

void RestrictedVisionPerceptor::sights(std::vector<Sight>& out) {
  eye_.update(*this, range_);
  soccer::appendSights(eye_.objects(), out);
}

void RestrictedVisionPerceptor::prepare(const Event&) {
  eye_.refresh(*this);
  if (const SoccerSettings* s = eye_.settings(); s && s->visionInterval > 0) interval_ = s->visionInterval;
}

}  // namespace spark
