#include "rows.h"

// The rows of a contact: non-penetration along the normal and a friction box or pyramid along two tangents (Smith, ODE
// manual, "Friction Approximation").

namespace spark::articulated {

namespace {

/// Target velocity of the normal row [m/s], positive for separation: it reduces the penetration, and returns a fraction
/// of the approach velocity where the surfaces bounce. `separation` is the present velocity.
double normalTarget(const engine::Contact& contact, double separation, const StepConstants& constants) {
  const engine::Surface& s = contact.surface;
  const double erp = s.softErpOn ? s.softErp : constants.erp;
  double target = constants.inverseDt * erp * std::max(0.0, contact.depth - constants.contactSurfaceLayer);
  if (s.bounceOn && s.bounceVelocity >= 0 && -separation > s.bounceVelocity)
    target = std::max(target, -s.bounce * separation);
  return target;
}

}  // namespace

Index writeContactRows(const engine::Contact& contact, bool reversed, const RigidBodyState& a, const RigidBodyState* b,
                       const StepConstants& constants, Row* out) {
  const engine::Surface& s = contact.surface;
  // The normal, which points into a, and two tangents.
  Vec3 directions[3];
  directions[0] = reversed ? Vec3(-contact.normal) : contact.normal;
  const Vec3 armA = contact.position - a.position, armB = b ? Vec3(contact.position - b->position) : Vec3(Vec3::Zero());
  const Index count = s.mu > 0 ? 3 : 1;
  if (count == 3) perpendicularBasis(directions[0], directions[1], directions[2]);
  for (Index i = 0; i < count; ++i) {
    const Vec3& d = directions[i];
    Row& row = out[i];
    row = {};
    row.jacobianA = SpatialVector::of(d, armA.cross(d));
    if (b) row.jacobianB = SpatialVector::of(-d, d.cross(armB));
    double cfm = constants.cfm;
    if (i == 0) {
      // Normal: pushes the bodies apart, never together.
      const double separation = dot(row.jacobianA, SpatialVector::of(a.linearVelocity, a.angularVelocity)) +
                                (b ? dot(row.jacobianB, SpatialVector::of(b->linearVelocity, b->angularVelocity)) : 0);
      row.target = normalTarget(contact, separation, constants) * constants.inverseDt;
      row.low = 0;
      if (s.softCfmOn) cfm = s.softCfm;
    } else {
      // Friction: no slip, up to mu newtons (box) or mu times the normal force (pyramid). Slip is a CFM.
      row.low = -s.mu, row.high = s.mu;
      if (s.pyramid) row.normalRow = 0;
      if (s.slipOn) cfm = i == 1 ? s.slip1 : s.slip2;
    }
    row.softness = cfm * constants.inverseDt;
  }
  return count;
}

}  // namespace spark::articulated
