#include "world.h"

#include <algorithm>

#include "physics_server.h"

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
  d.implements<engine::IExtended>();
  d.implements<engine::IExtendedWorld>();
  d.property("gravity", &World::gravity, &World::setGravity)
      .unit("m/s^2")
      .state()
      .doc("Gravitational acceleration, world frame.");
  d.property("ERP", &World::erp, &World::setErp)
      .range(0, 1)
      .state()
      .doc("Error reduction parameter: the fraction of a constraint's error that one step corrects.");
  d.property("CFM", &World::cfm, &World::setCfm)
      .range(0, ContactJointHandler::kSoftest)
      .state()
      .doc("Constraint force mixing (compliance / time step) of all constraints.");
  d.property("autoDisableFlag", &World::autoDisable, &World::setAutoDisable).state().doc("Bodies at rest fall asleep.");
  d.property("joinedCollide", &World::joinedCollide, &World::setJoinedCollide)
      .doc("Bodies that joints connect collide with each other.");
  d.property("contactSurfaceLayer", &World::surfaceLayer, &World::setSurfaceLayer)
      .unit("m")
      .range(0, physics::kFarthest)
      .state()
      .doc("Allowed penetration depth of contacts.");
  d.property("timestep", &World::timestep, &World::setTimestep)
      .unit("s")
      .min(0)
      .doc(
          "Length of the engine's steps, of which a step of the simulation has a whole number: in each of them "
          "contacts "
          "are found and controllers act. 0: as the engine says.");
  d.property("meshes", &World::meshes)
      .ofProcess()
      .doc("Number of different meshes and hulls that its colliders have; each is in memory once.");
  d.property("meshLoads", &World::meshLoads)
      .ofProcess()
      .doc("How often a mesh file was read for its colliders; those with the same file and scale share one.");
}

void World::setBlock(const engine::Block& block) {
  blocks_.set(block);
  if (model_) model_->setBlocks(blocks_);
}

void World::removeBlock(std::uint64_t kind) {
  blocks_.remove(kind);
  if (!model_) return;
  model_->setBlocks(blocks_);
  model_->endInput(kind);
}

void World::setInput(std::uint64_t kind, double value) {
  if (model_) model_->setInput(kind, value);
}

World& World::of(const Leaf& node) {
  for (Node* up = node.parent(); up; up = up->parent())
    if (auto* world = up->childOf<World>(); world && world->model()) return *world;
  throw Error(
      fmt::format("{}: expected a World in its scene, found none. Make one before importing bodies: new(\"World\", "
                  "\"/usr/scene/world\")",
                  node.path()));
}

namespace {
/// The server that steps the scene of a world; the usual one if none says so.
PhysicsServer& serverOf(const World& world) {
  std::vector<PhysicsServer*> all;
  world.kernel().root().collect(all);
  for (PhysicsServer* server : all)
    if (server->isOf(*world.parent())) return *server;
  return world.kernel().root().require<PhysicsServer>(IPhysicsServer::kPath);
}
}  // namespace

void World::onLink() {
  PhysicsObject::onLink();
  PhysicsServer& server = serverOf(*this);
  server.expectEngines();
  stepper_ = nullptr;  // it ends before its model does
  model_ = std::make_shared<physics::WorldModel>(server.exactReplay());
  stepper_ = std::make_shared<physics::Stepper>(*model_);
  apply();
  model_->setBlocks(blocks_);
}

void World::saveState(StateWriter& out) const {
  if (stepper_) stepper_->save(out);
}

void World::loadState(StateReader& in) {
  if (stepper_) stepper_->load(in);
}

const std::shared_ptr<physics::SharedSpace>& World::space() {
  if (parent())
    if (auto* first = parent()->childOf<Space>(); first && first->shared()) return first->shared();
  if (!ownSpace_) ownSpace_ = std::make_shared<physics::SharedSpace>(model_, nullptr);
  return ownSpace_;
}

void World::setGravity(const Vec3& g) {
  if (!g.allFinite()) throw Error(fmt::format("{}: expected finite numbers for gravity", where()));
  parameters_.gravity = g;
  apply();
}

void World::apply() {
  if (model_) model_->setParameters(parameters_);
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
    shared_ = std::make_shared<physics::SharedSpace>(world.model(), above->shared());
  else if (world.parent()->childOf<Space>() == this)
    shared_ = std::make_shared<physics::SharedSpace>(world.model(), nullptr);
  else
    shared_ = std::make_shared<physics::SharedSpace>(world.model(), world.space());
  disableInnerCollision(innerOff_);
}

void Space::disableInnerCollision(bool off) {
  innerOff_ = off;
  if (shared_) shared_->world()->setInnerCollision(shared_->handle(), !off);
}

}  // namespace spark
