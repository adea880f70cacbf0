#pragma once
/// \file
/// Contacts of geoms.

#include <vector>

#include "api/model.h"
#include "spark/abi/api/contacts.h"

namespace spark::engine {

/// Contact surface of two colliders, combined (scene-language section 3.3). Bounce, soft ERP, soft CFM and slip count
/// only with their flags.
struct Surface {
  bool bounceOn = false, softErpOn = false, softCfmOn = false, slipOn = false;
  /// True: mu is a coefficient, and friction is bounded by mu times the normal force of a solution without friction
  /// (friction pyramid). False: mu is a force.
  bool pyramid = false;
  /// Bound of friction along each tangent: a force [N], or a coefficient. Infinite: what touches does not slide.
  double mu = HUGE_VAL;
  double bounce = 0;            ///< restitution, 0..1
  double bounceVelocity = 0;    ///< smallest approach speed at which the contact bounces [m/s]
  double softErp = 0;           ///< error reduction parameter of the contact
  double softCfm = 0;           ///< constraint force mixing of the contact
  double slip1 = 0, slip2 = 0;  ///< force-dependent slip along the two tangents [m/(N s)]
};

/// One contact point. IDetector::detect() creates it, collision handlers complete it, ISolver::step() solves it.
struct Contact {
  Index geomA = kNone, geomB = kNone;
  Index bodyA = kNone, bodyB = kNone;  ///< of the geoms; kNone: static
  void* ownerA = nullptr;              ///< the owner of geomA
  void* ownerB = nullptr;              ///< the owner of geomB
  Vec3 position, normal;               ///< world frame [m, unit vector]; the normal points into A
  double depth = 0;                    ///< penetration depth [m]
  bool solve = false;                  ///< the solver is to treat it as a constraint; only with a body
  bool feedback = false;               ///< step() is to write forceOnA
  Surface surface;
  Vec3 forceOnA = Vec3::Zero();  ///< force on A, world frame [N]
};

/// True when `a` is the first geom of a contact with `b`: movable geoms come before static ones, planes come last;
/// among equals the younger comes first. So a robot's foot comes before the ground and before older objects on it, and
/// handlers that use only direct contacts get them. `G` is Geom, or has its members `shape`, `body` and `id`.
template <class G>
bool comesFirst(const G& a, const G& b) {
  const auto rank = [](const G& g) { return g.shape.shape == Shape::plane ? 0 : g.body != kNone ? 2 : 1; };
  const int ra = rank(a), rb = rank(b);
  return ra != rb ? ra > rb : a.id > b.id;
}

/// The contacts of one step, grouped by geom pair, in the order of detection. Reused for all steps, to keep the
/// capacity.
using Contacts = std::vector<Contact>;

/// Returns whether two geoms may collide at all; called with their owners, for every pair with overlapping bounds.
using PairFilter = bool (*)(void* ownerA, void* ownerB);

}  // namespace spark::engine
