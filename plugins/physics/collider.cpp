#include "collider.h"

#include <algorithm>

#include "colliders.h"

namespace spark {

using engine::Shape;
using engine::ShapeDescription;

const engine::Surface& defaultSurface() {
  static const ContactJointHandler handler;
  return *handler.surface();
}

void Collider::describe(Description<Collider>& d) {
  d.doc("Collision geometry. Its child handlers define what a contact does.");
  d.implements<ICollider>();
  d.implements<IFollowsTransform>();
  d.implements<ISceneCalls>();
  d.method("setPosition", &Collider::setPosition)
      .parameters({"position [m]"})
      .surplusIgnored()
      .doc("Position in the frame of its transform or body.");
  d.method("setLocalPosition", &Collider::setLocalPosition)
      .parameters({"position [m]"})
      .surplusIgnored()
      .doc("Offset inside a TransformCollider or on a body; in the world for a static collider.");
  d.method("setRotation", &Collider::setRotation)
      .parameters({"matrix: 6 or 16 numbers"})
      .doc("Rotation inside a TransformCollider or on a body; in the world for a static collider.");
  d.method("setLocalPose", &Collider::setLocalPose)
      .parameters({"position [m]", "rotation: 9 numbers, row by row"})
      .doc("Pose in the frame of its transform or body, or inside a TransformCollider.");
  d.method("addCollisionHandler", &Collider::addCollisionHandler)
      .parameters({"class"})
      .doc("Creates a handler of that class below it.");
  d.method("addNotCollideWithColliderName", &Collider::addNotCollideWithColliderName)
      .parameters({"name", "on"})
      .doc("true: excludes collisions with colliders of that name in the same space; false: allows them again.");
  d.method("addCollideWithColliderName", &Collider::addCollideWithColliderName)
      .parameters({"name", "on"})
      .doc("true: it collides with colliders of that name in the same space, whatever contactTypes say.");
  d.property("collideWith", &Collider::collideWith)
      .doc("Names of the colliders of its space that it collides with whatever contactTypes say.");
  d.property("contactTypes", &Collider::contactTypes_)
      .doc(
          "Bits of the kinds of colliders that it is. Two collide if a bit of one is in the other's "
          "contactAffinities.");
  d.property("contactAffinities", &Collider::contactAffinities_)
      .doc("Bits of the kinds of colliders that it collides with.");
  d.property("notCollideWith", &Collider::notCollideWith)
      .doc("Names of the colliders of its space that it does not collide with.");
  d.property("part", &Collider::part, &Collider::setPart)
      .min(0)
      .doc("Which of its body's parts it belongs to (addPart), from 0.");
  d.property("priority", &Collider::priority_)
      .doc("Of two colliders that touch the surface of that with the higher one counts alone.");
  d.implements<engine::IExtended>();
  d.abstract();
}

void Collider::setPart(int part) {
  part_ = part;
  extend();
}

std::uint64_t Collider::identity() const {
  return world() && geom_ != physics::GeomHandle::none ? world()->model().geoms[world()->index(geom_)].id : 0;
}

void Collider::setBlock(const engine::Block& block) {
  blocks_.set(block);
  extend();
}

void Collider::removeBlock(std::uint64_t kind) {
  blocks_.remove(kind);
  extend();
}

void Collider::extend() {
  if (!world() || geom_ == physics::GeomHandle::none) return;
  world()->setPart(geom_, part_);
  world()->setBlocks(geom_, blocks_);
}

void Collider::onLink() {
  PhysicsObject::onLink();
  World& world = World::of(*this);
  outer_ = parent()->as<TransformCollider>();
  auto* above = ancestor<Space>();
  space_ = above ? above->shared() : world.space();
  // Only a body that is linked before its colliders is found.
  body_ = outer_ ? outer_->body_ : Ref<RigidBody>(parent()->childOf<RigidBody>());
  if (body_ && body_->handle() == physics::BodyHandle::none) body_ = {};
  reshape();
}

void Collider::onMoved() {
  PhysicsObject::onMoved();
  outer_ = parent()->as<TransformCollider>();
  attach();
}

void Collider::onUnlink() {
  destroyGeom();
  space_.reset();
  PhysicsObject::onUnlink();
}

void Collider::destroyGeom() {
  if (world() && geom_ != physics::GeomHandle::none) world()->destroyGeom(geom_);
  geom_ = physics::GeomHandle::none;
}

void Collider::reshape() {
  if (!world()) return;
  const auto s = shape();
  if (!s) return destroyGeom();
  try {
    if (geom_ != physics::GeomHandle::none) return world()->setShape(geom_, *s);
    geom_ = world()->createGeom(space_->handle(), *s, &outermost());
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot take that shape", where()), e);
  }
  extend();
  attach();
}

Collider& Collider::outermost() {
  Collider* top = this;
  while (top->outer_) top = top->outer_;
  return *top;
}

void Collider::attach(const Pose& base) {
  if (geom_ != physics::GeomHandle::none && world()) {
    if (body_) {
      world()->setBody(geom_, body_->handle(), offset());
    } else {
      world()->setPose(geom_, compose(base, offset()));
    }
  }
  for (const auto& child : children())
    if (auto inner = child->as<Collider>(); inner && inner->outer_ == this) inner->attach(base);
}

void Collider::follow(const Matrix& world) {
  if (!body_ && !outer_) attach(toPose(world));
}

void Collider::shift(const Vec3& offset) {
  local_.position += offset;
  attach();
}

void Collider::setPosition(const Vec3& p) {
  local_.position = p;
  attach();
}

void Collider::setLocalPosition(const Vec3& p) {
  const Pose frame = physics::frameOf(*this);
  local_.position = isStaticInWorld() ? Vec3(frame.rotation.transpose() * (p - frame.position)) : p;
  attach();
}

void Collider::setRotation(const std::vector<double>& matrix) {
  if (matrix.empty()) throw Error(fmt::format("{}: expected a matrix of 6 or 16 numbers, found none", where()));
  const Mat3 r = physics::poseFrom(matrix).rotation;
  local_.rotation = isStaticInWorld() ? Mat3(physics::frameOf(*this).rotation.transpose() * r) : r;
  attach();
}

void Collider::setLocalPose(const Vec3& position, const std::vector<double>& rotation) {
  local_ = physics::poseOfNumbers(*this, position, rotation);
  attach();
}

std::vector<SceneCall> Collider::sceneCalls() const {
  std::vector<SceneCall> calls;
  if (!local_.position.isZero(0) || !local_.rotation.isIdentity(0))
    calls.push_back({"setLocalPose", physics::numbersOfPose(local_)});
  for (const std::string& name : notCollideWith_) calls.push_back({"addNotCollideWithColliderName", {name, true}});
  for (const std::string& name : collideWith_) calls.push_back({"addCollideWithColliderName", {name, true}});
  return calls;
}

void Collider::addCollisionHandler(const std::string& className) { create<CollisionHandler>(className); }

void Collider::addNotCollideWithColliderName(std::string name, bool on) {
  std::erase(notCollideWith_, name);
  if (on) notCollideWith_.push_back(std::move(name));
}

void Collider::addCollideWithColliderName(std::string name, bool on) {
  std::erase(collideWith_, name);
  if (on) collideWith_.push_back(std::move(name));
}

bool Collider::mayCollideWith(const Collider& other) const {
  const auto names = [](const std::vector<std::string>& list, const Collider& c) {
    return std::find(list.begin(), list.end(), c.name()) != list.end();
  };
  if (!((contactTypes_ & other.contactAffinities_) | (other.contactTypes_ & contactAffinities_)) &&
      (space_ != other.space_ || !(names(collideWith_, other) || names(other.collideWith_, *this))))
    return false;

  // A detached group collides only with itself and with static colliders.
  const auto detached = [](const CollisionGroup* group) { return group && group->detached(); };
  if (group_ != other.group_ && hasBody_ && other.hasBody_ && (detached(group_) || detached(other.group_)))
    return false;

  // Colliders exclude each other by name within one space.
  if (notCollideWith_.empty() && other.notCollideWith_.empty()) return true;
  if (space_ != other.space_) return true;
  return !names(notCollideWith_, other) && !names(other.notCollideWith_, *this);
}

void Collider::refreshHandlers(bool defaultOnTransform) {
  findHandlers(defaultOnTransform);
  solid_ = handlers_.contact || handlers_.fallback;
  listens_ = !handlers_.active.empty();
  hasBody_ = static_cast<bool>(body_);
}

void Collider::findHandlers(bool defaultOnTransform) {
  handlers_.contact = nullptr;
  handlers_.active.clear();
  bool any = false;
  for (const auto& child : children()) {
    auto handler = child->as<CollisionHandler>();
    if (!handler) continue;
    any = true;
    if (!handlers_.contact && handler->surface()) handlers_.contact = handler;
    // A plain ContactJointHandler only holds a surface: it need not be called.
    if (handler->classObject()->name() != ContactJointHandler::kClassName) handlers_.active.push_back(handler);
  }

  // A TransformCollider without a handler may take over those of its inner collider.
  auto inner = as<TransformCollider>() ? childOf<Collider>() : nullptr;
  if (!any && inner && !defaultOnTransform) {
    inner->refreshHandlers(defaultOnTransform);
    handlers_ = inner->handlers_;
    return;
  }
  handlers_.fallback = !any;
  // A ray is a probe: its handlers are called, but its contacts are never solid.
  if (const auto s = shape(); s && s->shape == Shape::ray) {
    handlers_.contact = nullptr;
    handlers_.fallback = false;
  }
}

Pose Collider::geomPose() const {
  return world() && geom_ != physics::GeomHandle::none ? world()->pose(geom_)
                                                       : compose(physics::frameOf(*this), local_);
}

double Collider::pointDepth(const Vec3& p) const {
  const Pose frame = physics::frameOf(*this), own = geomPose();
  const Vec3 world = frame.position + frame.rotation * p;
  return -physics::distanceTo(*shape(), own.rotation.transpose() * (world - own.position));
}

namespace {

void widen(Vec3& low, Vec3& high, const Vec3& p) {
  low = low.cwiseMin(p);
  high = high.cwiseMax(p);
}

/// Widens an empty box (`low` infinite, `high` minus infinite) to the bounds of a shape that is not symmetric.
void boundsOf(const ShapeDescription& s, const Pose& p, Vec3& low, Vec3& high) {
  if (s.shape == Shape::plane) {
    std::swap(low, high);  // unbounded
  } else if (s.shape == Shape::ray) {
    const Vec3 from = p.position + p.rotation * s.rayOrigin;
    widen(low, high, from);
    widen(low, high, from + p.rotation * s.rayDirection.normalized() * s.length);
  } else if (s.shape == Shape::heightField) {
    const engine::HeightField& f = *s.heightField;
    for (int corner = 0; corner < 8; ++corner)
      widen(low, high,
            p.position + p.rotation * Vec3(corner & 1 ? f.width / 2 : -f.width / 2,
                                           corner & 2 ? f.depth / 2 : -f.depth / 2, corner & 4 ? f.high : f.low));
  } else {
    for (std::size_t i = 0; i < s.mesh->vertices.size() / 3; ++i)
      widen(low, high, p.position + p.rotation * s.mesh->vertex(i));
  }
}

}  // namespace

const std::vector<const Collider*>& Collider::inner() const {
  if (std::exchange(innerAt_, changedAt()) == changedAt()) return inner_;
  inner_.clear();
  for (const auto& child : children())
    if (const auto collider = child->as<Collider>()) inner_.push_back(collider);
  return inner_;
}

void Collider::bounds(Vec3& low, Vec3& high) const {
  // Start with an empty box.
  low = Vec3::Constant(HUGE_VAL);
  high = -low;
  if (world() && geom_ != physics::GeomHandle::none) {
    const Pose p = world()->pose(geom_);
    if (const auto half = halfExtent(p.rotation)) {
      low = p.position - *half;
      high = p.position + *half;
    } else if (const auto s = shape()) {
      boundsOf(*s, p, low, high);
    }
  }
  for (const Collider* collider : inner()) {
    Vec3 innerLow, innerHigh;
    collider->bounds(innerLow, innerHigh);
    low = low.cwiseMin(innerLow);
    high = high.cwiseMax(innerHigh);
  }
}

}  // namespace spark
