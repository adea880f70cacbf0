#include "vision_perceptor.h"

#include "long_names.h"

namespace spark {

using soccer::VisibleObjects;

bool VisionPerceptor::see(const Vec3f& point, const IRigidBody* body, soccer::Polar& out) {
  const Vec3f offset = point - origin_;
  const float distance = offset.norm();
  if (distance <= soccer::kMinDistance || distance > eye_.range() || eye_.isHidden(origin_, point, body)) return false;
  Vec3f relative = soccer::toTeamFrame(side(), offset);
  if (!staticAxis_ && transform()) relative = transform()->world().block<3, 3>(0, 0).transpose() * offset;
  out = soccer::toPolar(relative + noise_.calibration());
  // Robots look along their y axis.
  if (!staticAxis_) out.horizontal = normalizeDeg(out.horizontal - 90);
  if (randomNoise_) noise_.apply(out);
  return true;
}

void VisionPerceptor::sense(Predicates& out, const Event&) {
  eye_.beginSense(*this, range_);
  origin_ = soccer::worldPosition(*this);
  const VisibleObjects& objects = eye_.objects();
  noise_.allowed = !eye_.settings() || eye_.settings()->visionNoise;
  soccer::Polar polar;
  const bool longNames = eye_.settings() && eye_.settings()->longNames;
  out.open(longNames && predicateName_ == "See" ? "Vision" : std::string_view(predicateName_));
  for (const VisibleObjects::Object& o : objects.field()) {
    if (!see(o.position, o.body, polar)) continue;
    soccer::openSeen(out, o.state->perceptName(), longNames);
    writePolar(out, polar);
    out.close();
  }
  for (const std::uint32_t i : eye_.robotsNear(origin_)) {
    const VisibleObjects::Robot& r = objects.robots()[i];
    if (r.agent == eye_.agent() || r.state->side() == soccer::Side::none || !see(r.position, r.body, polar)) continue;
    soccer::openSeen(out, r.state->perceptName(), longNames)
        .pair("team", std::string_view(r.state->team()))
        .pair("id", r.state->unum());
    writePolar(out, polar);
    out.close();
  }
  const bool cheats = eye_.settings() && eye_.settings()->cheats;
  if (senseMyPos_ || cheats) soccer::writePoint(out, "mypos", soccer::toTeamFrame(side(), origin_));
  if (cheats && transform()) soccer::writeHeading(out, transform()->world(), side());
  if (const VisibleObjects::Object* ball = cheats ? objects.ball() : nullptr)
    soccer::writePoint(out, "ballpos", soccer::toTeamFrame(side(), ball->position));
  out.close();
}

Matrix VisionPerceptor::view() {
  eye_.update(*this, range_);
  return usesTeamFrame() ? soccer::teamView(soccer::worldPosition(*this), side()) : soccer::headView(*transform());
}

double VisionPerceptor::range() {
  eye_.update(*this, range_);
  return eye_.range();
}

Vec3f VisionPerceptor::placeOf(double distance, double horizontalDeg, double verticalDeg) {
  const Matrix frame = view();
  return positionOf(frame) + frame.block<3, 3>(0, 0) * soccer::toCartesian({distance, horizontalDeg, verticalDeg});
}

void VisionPerceptor::sights(std::vector<Sight>& out) {
  eye_.update(*this, range_);
  soccer::appendSights(eye_.objects(), out);
}

}  // namespace spark
