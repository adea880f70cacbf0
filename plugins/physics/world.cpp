#include "world.h"

namespace spark {

Pose physics::poseFrom(const std::vector<double>& n) {
  for (double v : n)
    if (!std::isfinite(v)) throw Error("expected finite numbers in a matrix");
  if (n.empty()) return {};
  if (n.size() == 6) {
    Pose p = toPose(rotationDeg(static_cast<float>(n[3]), static_cast<float>(n[4]), static_cast<float>(n[5])));
    p.position = {n[0], n[1], n[2]};
    return p;
  }
  if (n.size() != 16)
    throw Error(fmt::format(
        "expected a matrix as 6 numbers (position, rotation in degrees) or 16 (column-major), found {}", n.size()));
  Pose p;
  p.position = {n[12], n[13], n[14]};
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) p.rotation(row, column) = n[4 * column + row];
  return p;
}

void World::describe(Description<World>& d) {
  d.doc("The physical world of a scene: gravity and the solver's parameters.");
  d.property("gravity", &World::gravity, &World::setGravity)
      .unit("m/s^2")
      .state()
      .doc("Gravitational acceleration, world frame.");
  d.property("ERP", &World::erp, &World::setErp)
      .range(0, 1)
      .state()
      .doc("Error reduction parameter: the fraction of a constraint's error that one step corrects.");
  d.property("CFM", &World::cfm, &World::setCfm)
      .min(0)
      .state()
      .doc("Constraint force mixing (compliance / time step) of all constraints.");
  d.property("autoDisableFlag", &World::autoDisable, &World::setAutoDisable).state().doc("Bodies at rest fall asleep.");
  d.property("contactSurfaceLayer", &World::surfaceLayer, &World::setSurfaceLayer)
      .unit("m")
      .min(0)
      .state()
      .doc("Allowed penetration depth of contacts.");
}

World& World::of(const Leaf& node) {
  for (Node* up = node.parent(); up; up = up->parent())
    if (auto* world = up->childOf<World>(); world && world->handle() && world->handle()->engine()) return *world;
  throw Error(
      fmt::format("{}: expected a World in its scene, found none. Make one before importing bodies: new(\"World\", "
                  "\"/usr/scene/world\")",
                  node.path()));
}

void World::onLink() {
  PhysicsObject::onLink();
  auto& server = kernel().root().require<IPhysicsServer>();
  engine::IEngine& e = server.engine();
  // IEngine has no node of its own: the handle refers to the child of the server that offers it.
  Leaf* engineLeaf = kernel().root().find("/sys/server/physics/engine");
  if (!engineLeaf) engineLeaf = kernel().root().find("/sys/server/physics");
  handle_ = std::make_shared<physics::WorldHandle>(physics::EngineUse{Ref<Leaf>(engineLeaf), &e}, path());
  apply();
}

const std::shared_ptr<physics::SpaceHandle>& World::space() {
  if (parent())
    if (auto* first = parent()->childOf<Space>(); first && first->handle()) return first->handle();
  if (!ownSpace_) ownSpace_ = std::make_shared<physics::SpaceHandle>(handle_, nullptr);
  return ownSpace_;
}

void World::setGravity(const Vec3& g) {
  if (!g.allFinite()) throw Error(fmt::format("{}: expected finite numbers for gravity", where()));
  parameters_.gravity = g;
  apply();
}

void World::apply() {
  if (!handle_) return;
  if (auto* e = handle_->engine()) e->setWorldParameters(handle_->id(), parameters_);
}

void Space::describe(Description<Space>& d) {
  d.doc("A collision space: it holds the colliders below it.");
  d.method("disableInnerCollision", &Space::disableInnerCollision)
      .parameters({"off"})
      .doc("true: colliders directly in this space do not collide with each other.");
  d.property("innerCollisionDisabled", &Space::innerOff, &Space::disableInnerCollision)
      .doc("Colliders directly in this space do not collide with each other.");
}

void Space::onLink() {
  PhysicsObject::onLink();
  World& world = World::of(*this);

  // A space inside another is nested. The first beside the world is a top-level space, others are nested in it.
  if (auto* above = ancestor<Space>())
    handle_ = std::make_shared<physics::SpaceHandle>(world.handle(), above->handle());
  else if (world.parent()->childOf<Space>() == this)
    handle_ = std::make_shared<physics::SpaceHandle>(world.handle(), nullptr);
  else
    handle_ = std::make_shared<physics::SpaceHandle>(world.handle(), world.space());
  disableInnerCollision(innerOff_);
}

void Space::disableInnerCollision(bool off) {
  innerOff_ = off;
  if (!handle_) return;
  if (auto* e = handle_->world()->engine()) e->setInnerCollision(handle_->id(), !off);
}

}  // namespace spark
