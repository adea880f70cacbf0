#include "vision_perceptor.h"

namespace spark {

using soccer::Sights;

/// False when the object is too near or too far to be seen.
bool VisionPerceptor::look(const Vec3f& place, soccer::Polar& out) {
  const Vec3f way = place - here_;
  const float distance = way.norm();
  if (distance <= soccer::kTooNear || distance > outlook_.range()) return false;
  Vec3f relative = soccer::seenBy(side(), way);
  if (!staticAxis_ && transform()) relative = transform()->world().block<3, 3>(0, 0).transpose() * way;
  out = soccer::polarOf(relative + noise_.calibration());
  // robots look along their own y axis
  if (!staticAxis_) out.horizontal = normalizeDeg(out.horizontal - 90);
  if (randomNoise_) noise_.apply(out);
  return true;
}

void VisionPerceptor::sense(Predicates& out, const Event&) {
  outlook_.open(*this, range_);
  here_ = soccer::placeOf(*this);
  const Sights& sights = outlook_.sights();
  noise_.allowed = !outlook_.settings() || outlook_.settings()->visionNoise;
  soccer::Polar polar;
  out.open(predicateName_);
  for (const Sights::Mark& m : sights.field()) {
    if (!look(m.place, polar)) continue;
    out.open(m.object->perceptName());
    writePolar(out, polar);
    out.close();
  }
  for (const std::uint32_t i : outlook_.robotsNear(here_)) {
    const Sights::Robot& r = sights.robots()[i];
    if (r.agent == outlook_.agent() || r.state->side() == soccer::Side::none || !look(r.place, polar)) continue;
    out.open(r.state->perceptName()).pair("team", std::string_view(r.state->team())).pair("id", r.state->unum());
    writePolar(out, polar);
    out.close();
  }
  const bool cheats = outlook_.settings() && outlook_.settings()->cheats;
  if (senseMyPos_ || cheats) soccer::writePoint(out, "mypos", soccer::seenBy(side(), here_));
  if (cheats && transform()) soccer::writeHeading(out, transform()->world(), side());
  if (const Sights::Mark* ball = cheats ? sights.ball() : nullptr)
    soccer::writePoint(out, "ballpos", soccer::seenBy(side(), ball->place));
  out.close();
}

Matrix VisionPerceptor::view() {
  outlook_.bring(*this, range_);
  return inField() ? soccer::fieldView(soccer::placeOf(*this), side()) : soccer::headView(*transform());
}

double VisionPerceptor::range() {
  outlook_.bring(*this, range_);
  return outlook_.range();
}

Vec3f VisionPerceptor::placeOf(double distance, double horizontalDeg, double verticalDeg) {
  const Matrix frame = view();
  return positionOf(frame) + frame.block<3, 3>(0, 0) * soccer::pointOf({distance, horizontalDeg, verticalDeg});
}

void VisionPerceptor::sights(std::vector<Sight>& out) {
  outlook_.bring(*this, range_);
  soccer::tellSights(outlook_.sights(), out);
}

}  // namespace spark
