#include "placed_bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/mass.h"

namespace spark::mjcf {

PlacedBodies::PlacedBodies(const Model& model, const Pose& root) : root_(root), bodies_(model.bodies.size()) {
  for (const Equality& x : model.equalities)
    for (const std::string& name : {x.first, x.second})
      if (!name.empty()) held_.insert(name);
  bodies_.front().body = &model.bodies.front();
  bodies_.front().world = root;
  for (std::size_t i = 1; i < bodies_.size(); ++i) place(i, model.bodies[i]);
}

void PlacedBodies::place(std::size_t index, const Body& b) {
  PlacedBody& p = bodies_[index];
  const PlacedBody& parent = bodies_[static_cast<std::size_t>(b.parent)];
  p.body = &b;
  p.world = compose(parent.world, b.pose);
  const bool free =
      std::any_of(b.joints.begin(), b.joints.end(), [](const Joint& j) { return j.kind == JointKind::free; });
  if (free && (b.parent != 0 || b.joints.size() > 1))
    throw b.from.error("expected a free joint as the only one of a body in the world");
  if (b.joints.empty()) {
    p.carrier = parent.carrier;
    p.inCarrier = compose(parent.inCarrier, b.pose);
  } else {
    p.carrier = static_cast<int>(index);
    p.above = parent.carrier;
  }
  if (p.carrier == 0) return;
  // Masses of parts move to the carrier.
  PlacedBody& carrier = carrierOf(p);
  const Mat3& r = p.inCarrier.rotation;
  const engine::Mass part{b.mass.mass, p.inCarrier.position + r * b.mass.center, r * b.mass.inertia * r.transpose()};
  carrier.mass = physics::together(carrier.mass, part);
  if (&p == &carrier || part.mass > 0 || !b.geoms.empty() || held_.contains(b.name)) {
    p.part = static_cast<int>(carrier.parts.size());
    carrier.parts.push_back({part.mass, part.center, part.inertia, r * b.inertiaAxes});
  }
  carrier.compensatedMass += b.gravityCompensation * b.mass.mass;
  if (!b.name.empty() && !byName_.emplace(b.name, &p).second)
    throw b.from.error(fmt::format("there are two bodies '{}'", b.name));
}

PlacedBody& PlacedBodies::find(const std::string& name, const Element& user) {
  if (name == "world") return bodies_.front();
  if (const auto found = byName_.find(name); found != byName_.end()) return *found->second;
  for (PlacedBody& p : bodies_)  // a static one
    if (p.body->name == name && !name.empty()) return p;
  throw user.error(fmt::format("there is no body '{}'", name));
}

}  // namespace spark::mjcf
