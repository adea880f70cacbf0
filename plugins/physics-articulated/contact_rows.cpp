#include "rows.h"

namespace spark::articulated {

namespace {

/// The velocity that the normal wants: out of the other body, and back when the surfaces bounce.
double wantedAlongNormal(const engine::Contact& contact, double leaving, const RowScale& scale) {
  const engine::Surface& s = contact.surface;
  const double erp = s.softErpOn ? s.softErp : scale.erp;
  double wanted = scale.perSecond * erp * std::max(0.0, contact.depth - scale.contactSurfaceLayer);
  if (s.bounceOn && s.bounceVelocity >= 0 && -leaving > s.bounceVelocity)
    wanted = std::max(wanted, -s.bounce * leaving);
  return wanted;
}

}  // namespace

int contactRows(const engine::Contact& contact, bool reversed, const Frame& a, const Frame* b, const RowScale& scale,
                Row* out) {
  const engine::Surface& s = contact.surface;
  Vec3 directions[3];
  directions[0] = reversed ? Vec3(-contact.normal) : contact.normal;
  const Vec3 a1 = contact.position - a.position, a2 = b ? Vec3(contact.position - b->position) : Vec3(Vec3::Zero());
  const int count = s.mu > 0 ? 3 : 1;
  if (count == 3) planeSpace(directions[0], directions[1], directions[2]);
  for (int i = 0; i < count; ++i) {
    const Vec3& d = directions[i];
    Row& row = out[i];
    row = {};
    row.a = Six::of(d, a1.cross(d));
    if (b) row.b = Six::of(-d, d.cross(a2));
    double cfm = scale.cfm;
    if (i == 0) {
      const double leaving =
          dot(row.a, Six::of(a.velocity, a.spin)) + (b ? dot(row.b, Six::of(b->velocity, b->spin)) : 0);
      row.target = wantedAlongNormal(contact, leaving, scale) * scale.perSecond;
      row.low = 0;
      if (s.softCfmOn) cfm = s.softCfm;
    } else {
      row.low = -s.mu, row.high = s.mu;
      if (s.pyramid) row.frictionOf = 0;
      if (s.slipOn) cfm = i == 1 ? s.slip1 : s.slip2;
    }
    row.softness = cfm * scale.perSecond;
  }
  return count;
}

}  // namespace spark::articulated
