#include "vision_perceptor.h"

namespace spark {

using soccer::placeOf;
using soccer::writePoint;

namespace {
constexpr float kTooNear = 0.1f;  ///< m: what is nearer is the eye's own body
}

/// False when the object is too near to be seen.
bool VisionPerceptor::look(const SceneNode& object, soccer::Polar& out) {
  const soccer::Side side = objects_.state() ? objects_.state()->side() : soccer::Side::none;
  const Vec3f way = placeOf(object) - placeOf(*this);
  if (way.norm() <= kTooNear) return false;
  Vec3f relative = soccer::seenBy(side, way);
  if (!staticAxis_ && transform()) relative = transform()->world().block<3, 3>(0, 0).transpose() * way;
  out = soccer::polarOf(relative + noise_.calibration());
  // robots look along their own y axis
  if (!staticAxis_) out.horizontal = normalizeDeg(out.horizontal - 90);
  if (randomNoise_) noise_.apply(out);
  return true;
}

void VisionPerceptor::sense(Predicates& out, const Event&) {
  objects_.refresh(*this);
  noise_.allowed = !objects_.settings() || objects_.settings()->visionNoise;
  soccer::Polar polar;
  out.open(predicateName_);
  for (const ObjectState* o : objects_.field()) {
    if (!look(*o, polar)) continue;
    out.open(o->perceptName());
    writePolar(out, polar);
    out.close();
  }
  for (const soccer::VisibleObjects::Robot& r : objects_.robots()) {
    if (r.agent == objects_.agent() || r.state->side() == soccer::Side::none || !look(*r.state, polar)) continue;
    out.open(r.state->perceptName()).pair("team", std::string_view(r.state->team())).pair("id", r.state->unum());
    writePolar(out, polar);
    out.close();
  }
  if (senseMyPos_)
    writePoint(out, "mypos", soccer::seenBy(objects_.state() ? objects_.state()->side() : soccer::Side::none, placeOf(*this)));
  out.close();
}

}  // namespace spark
