#include "colliders.h"

#include <algorithm>

namespace spark {

using engine::Shape;
using engine::ShapeDescription;

void BoxCollider::describe(Description<BoxCollider>& d) {
  d.doc("A box.");
  d.implements<IRobotBox>();
  d.property("boxLengths", &BoxCollider::boxLengths, &BoxCollider::setLengths)
      .unit("m")
      .range(0, physics::kFarthest)
      .doc("Full edge lengths.");
  d.method("getBoxLength", &BoxCollider::length).parameters({"axis"}).doc("Edge length along axis 0, 1 or 2 [m].");
  d.method("getPointDepth", &BoxCollider::pointDepth)
      .parameters({"point [m]"})
      .doc("Depth of a point, given in the frame of its transform, below the surface [m]; negative outside.");
  d.method("addSCFreezeJointEffName", &BoxCollider::addFreezeJointEffector)
      .parameters({"effector"})
      .doc("Adds an effector that a rule about self-collisions may freeze when this box touches its own robot.");
  d.property("freezeJointEffectors", &BoxCollider::freezeJointEffectors)
      .doc("Names of the effectors that a rule about self-collisions may freeze.");
}

std::vector<SceneCall> BoxCollider::sceneCalls() const {
  std::vector<SceneCall> calls = Collider::sceneCalls();
  for (const std::string& name : freezes_) calls.push_back({"addSCFreezeJointEffName", {name}});
  return calls;
}

std::optional<ShapeDescription> BoxCollider::shape() const {
  ShapeDescription s;
  s.shape = Shape::box;
  s.lengths = lengths_;
  return s;
}

bool BoxCollider::ignores(const std::string& collider) const {
  return std::find(notCollideWith().begin(), notCollideWith().end(), collider) != notCollideWith().end();
}

double BoxCollider::length(int axis) const {
  if (axis < 0 || axis > 2) throw Error(fmt::format("{}: expected an axis 0, 1 or 2, found {}", where(), axis));
  return lengths_[axis];
}

void SphereCollider::describe(Description<SphereCollider>& d) {
  d.doc("A sphere.");
  d.property("radius", &SphereCollider::radius, &SphereCollider::setRadius)
      .unit("m")
      .range(0, physics::kFarthest)
      .doc("Radius.");
  d.method("getPointDepth", &SphereCollider::pointDepth)
      .parameters({"point [m]"})
      .doc("Depth of a point, given in the frame of its transform, below the surface [m]; negative outside.");
}

std::optional<ShapeDescription> SphereCollider::shape() const {
  ShapeDescription s;
  s.shape = Shape::sphere;
  s.radius = radius_;
  return s;
}

void PlaneCollider::describe(Description<PlaneCollider>& d) {
  d.doc("An infinite plane in the world; transforms above do not move it.");
  d.method("setParams", &PlaneCollider::setParams)
      .parameters({"a b c d of ax + by + cz = d, or point and normal"})
      .doc("The plane as 4 numbers, or as a point and a normal (6 numbers).");
  d.method("getPointDepth", &PlaneCollider::pointDepth)
      .parameters({"point [m]"})
      .doc("Depth of a point, given in the frame of its transform, below the plane [m]; negative above it.");
}

std::vector<SceneCall> PlaneCollider::sceneCalls() const {
  std::vector<SceneCall> calls = Collider::sceneCalls();
  calls.push_back({"setParams", List(plane_.begin(), plane_.end())});
  return calls;
}

std::optional<ShapeDescription> PlaneCollider::shape() const {
  ShapeDescription s;
  s.shape = Shape::plane;
  std::copy(plane_.begin(), plane_.end(), s.plane);
  return s;
}

void PlaneCollider::setParams(std::vector<double> n) {
  if (n.size() == 4) return change(plane_, {n[0], n[1], n[2], n[3]});
  if (n.size() != 6)
    throw Error(fmt::format("{}: expected 4 numbers (a b c d) or 6 (point, normal), found {}", where(), n.size()));
  const Vec3 point(n[0], n[1], n[2]), normal(n[3], n[4], n[5]);
  change(plane_, {normal.x(), normal.y(), normal.z(), normal.dot(point)});
}

double PlaneCollider::pointDepth(const Vec3& at) const {
  const Pose frame = physics::frameOf(*this);
  const Vec3 normal(plane_[0], plane_[1], plane_[2]);
  return (plane_[3] - normal.dot(frame.position + frame.rotation * at)) / normal.norm();
}

void RayCollider::describe(Description<RayCollider>& d) {
  d.doc("A probe: its contacts call handlers and are never solid. Their depth is the distance from the ray's origin.");
  d.method("setParams", &RayCollider::setParams)
      .parameters({"origin [m]", "direction", "length [m]"})
      .doc("The ray, in the frame of its body or transform.");
}

std::vector<SceneCall> RayCollider::sceneCalls() const {
  const Vec3 &o = ray_.rayOrigin, &d = ray_.rayDirection;
  std::vector<SceneCall> calls = Collider::sceneCalls();
  calls.push_back({"setParams", {o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), ray_.length}});
  return calls;
}

std::optional<ShapeDescription> RayCollider::shape() const { return ray_; }

void RayCollider::setParams(const Vec3& origin, const Vec3& direction, double length) {
  ShapeDescription s = ray_;
  s.rayOrigin = origin, s.rayDirection = direction, s.length = length;
  change(ray_, std::move(s));
}

}  // namespace spark
