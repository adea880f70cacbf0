#include "mujoco_constraints.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "api/physics.h"

namespace spark {

std::uint64_t mujoco::identityAt(const Leaf& from, const std::string& path, bool joint) {
  const Leaf* const found = path.empty() ? nullptr : from.find(path);
  if (!found) return 0;
  if (joint) {
    const auto made = found->as<IJoint>();
    return made ? made->identity() : 0;
  }
  const auto made = found->as<IRigidBody>();
  return made ? made->identity() : 0;
}

// ---- equalities ----

void MujocoEquality::describe(Description<MujocoEquality>& d) {
  using E = MujocoEquality;
  using N = mujoco::EqualityNumbers;
  engine::describeExtension(
      d,
      "An equality of MuJoCo: a common point of two bodies (connect), bodies that do not move in "
      "each other (weld), or a coordinate or length that depends on another one (joint, tendon).");
  d.property("type", &E::type, &E::setType).doc("connect, weld, joint or tendon.");
  d.property("first", &E::first, &E::setFirst).doc("Path of the first body, joint or MujocoTendon; \"\": the world.");
  d.property("second", &E::second, &E::setSecond).doc("Path of the second one; \"\": the world, or no joint.");
  d.property("part1", &E::get<&N::part1>, &E::set<&N::part1>)
      .min(0)
      .doc("Which part of the first body is held, in the order of RigidBody.addPart; 0: the first, or all of it.");
  d.property("part2", &E::get<&N::part2>, &E::set<&N::part2>).min(0).doc("The same of the second body.");
  d.property("anchor1", &E::get<&N::anchor1>, &E::set<&N::anchor1>)
      .unit("m")
      .doc("The point in the frame of the first body's link, or of the world.");
  d.property("anchor2", &E::get<&N::anchor2>, &E::set<&N::anchor2>).unit("m").doc("The same in that of the second.");
  d.property("rotation", &E::get<&N::rotation>, &E::set<&N::rotation>)
      .doc("Of a weld: rotation of the second body in the first, w x y z.");
  d.property("torqueScale", &E::get<&N::torqueScale>, &E::set<&N::torqueScale>)
      .unit("m")
      .doc("Of a weld: how much rotation counts against translation.");
  d.property("polynomial", &E::get<&N::polynomial>, &E::set<&N::polynomial>)
      .doc("Of joints and tendons: coefficients of the first's coordinate as a function of the second's.");
  d.property("solref", &E::get<&N::solref>, &E::set<&N::solref>).doc("Time constant [s] and damping ratio.");
  d.property("solimp", &E::get<&N::solimp>, &E::set<&N::solimp>)
      .doc("Impedance: fractions from and to, width, midpoint, power.");
  d.property("active", &E::active, &E::setActive).doc("False: it has no effect.");
}

void MujocoEquality::setType(const std::string& name) {
  constexpr auto& kTypes = mujoco::EqualityNumbers::kTypes;
  const auto found = std::find(kTypes.begin(), kTypes.end(), name);
  if (found == kTypes.end())
    throw Error(fmt::format("{}: expected {}, found '{}'", path(), fmt::join(kTypes, " or "), name));
  set<&mujoco::EqualityNumbers::type>(found - kTypes.begin());
  resolve();
}

void MujocoEquality::setPath(std::size_t which, const std::string& path) {
  paths_[which] = path;
  resolve();
}

void MujocoEquality::resolve() {
  if (!parent()) return;
  const auto id = [&](const std::string& p) -> std::uint64_t {
    if (numbers().type != 3) return mujoco::identityAt(*this, p, numbers().type == 2);
    const Leaf* const tendon = p.empty() ? nullptr : find(p);
    const bool is = tendon && tendon->classObject()->name() == "MujocoTendon";
    return is ? static_cast<std::uint64_t>(mujoco::constraintNumber(*tendon)) + 1 : 0;
  };
  set<&mujoco::EqualityNumbers::named>((paths_[0].empty() ? 0 : 1) + (paths_[1].empty() ? 0 : 2));
  set<&mujoco::EqualityNumbers::first>(id(paths_[0]));
  set<&mujoco::EqualityNumbers::second>(id(paths_[1]));
}

void MujocoEquality::onLink() {
  resolve();
  MujocoConstraint::onLink();
}

// ---- tendons ----

void MujocoTendon::describe(Description<MujocoTendon>& d) {
  using T = MujocoTendon;
  using N = mujoco::TendonNumbers;
  engine::describeExtension(d, "A tendon of MuJoCo, along joints or along points of bodies.");
  d.implements<ISceneCalls>();
  d.method("addJoint", &T::addJoint)
      .parameters({"path", "coefficient"})
      .doc("Adds the coordinate of a joint to its length, times a coefficient.");
  d.method("addPoint", &T::addPoint)
      .parameters({"path", "x", "y", "z"})
      .doc("Adds a point to its path [m], in the frame of the link of a body; path \"\": of the world.");
  d.method("addSphere", &T::addSphere)
      .parameters({"path", "x", "y", "z", "radius"})
      .doc("Has the path go around a sphere of a body [m].");
  d.method("addCylinder", &T::addCylinder)
      .parameters({"path", "x", "y", "z", "radius", "rotation w x y z"})
      .doc("Has the path go around a cylinder of any length, along the z axis of its frame [m].");
  d.method("setSide", &T::setSide)
      .parameters({"path", "x", "y", "z"})
      .doc("The side of the last sphere or cylinder on which the path goes, by a point of a body; within: through it.");
  d.method("addPulley", &T::addPulley)
      .parameters({"divisor"})
      .doc("Begins another branch of the path, whose length counts by 1/divisor.");
  d.property("stiffness", &T::get<&N::stiffness>, &T::set<&N::stiffness>)
      .unit("N/m or Nm/rad")
      .min(0)
      .doc("Of its spring, against its length.");
  d.property("damping", &T::get<&N::damping>, &T::set<&N::damping>)
      .unit("N s/m or Nm s/rad")
      .min(0)
      .doc("Force per speed of its length.");
  d.property("frictionLoss", &T::get<&N::frictionLoss>, &T::set<&N::frictionLoss>)
      .unit("N or Nm")
      .min(0)
      .doc("Largest force of dry friction.");
  d.property("springLength", &T::get<&N::springLength>, &T::set<&N::springLength>)
      .unit("m or rad")
      .doc("Length at which the spring rests; of a path below 0: that where the springs of its joints rest.");
  d.property("limited", &T::limited, &T::setLimited).doc("Its length stays in `range`.");
  d.property("range", &T::get<&N::range>, &T::set<&N::range>).doc("Least and largest length.");
  d.property("margin", &T::get<&N::margin>, &T::set<&N::margin>)
      .unit("m or rad")
      .doc("Distance from a limit at which it begins to act.");
  const char *const solref = "Time constant [s] and damping ratio of {}.",
                    *const solimp = "Impedance of {}: fractions from and to, width, midpoint, power.";
  d.property("limitSolref", &T::get<&N::limitSolref>, &T::set<&N::limitSolref>)
      .doc(fmt::format(fmt::runtime(solref), "the limits"));
  d.property("limitSolimp", &T::get<&N::limitSolimp>, &T::set<&N::limitSolimp>)
      .doc(fmt::format(fmt::runtime(solimp), "the limits"));
  d.property("frictionSolref", &T::get<&N::frictionSolref>, &T::set<&N::frictionSolref>)
      .doc(fmt::format(fmt::runtime(solref), "dry friction"));
  d.property("frictionSolimp", &T::get<&N::frictionSolimp>, &T::set<&N::frictionSolimp>)
      .doc(fmt::format(fmt::runtime(solimp), "dry friction"));
}

std::vector<SceneCall> MujocoTendon::sceneCalls() const {
  using N = mujoco::TendonNumbers;
  std::vector<SceneCall> calls;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const N::Element& e = numbers().elements[i];
    const auto& p = e.point;
    const auto& q = e.rotation;
    if (numbers().spatial == 0)
      calls.push_back({"addJoint", {paths_[i], p[0]}});
    else if (e.kind == N::kPoint)
      calls.push_back({"addPoint", {paths_[i], p[0], p[1], p[2]}});
    else if (e.kind == N::kSphere)
      calls.push_back({"addSphere", {paths_[i], p[0], p[1], p[2], e.radius}});
    else if (e.kind == N::kCylinder)
      calls.push_back({"addCylinder", {paths_[i], p[0], p[1], p[2], e.radius, q[0], q[1], q[2], q[3]}});
    else
      calls.push_back({"addPulley", {p[0]}});
    if (e.hasSide != 0) calls.push_back({"setSide", {sides_[i], e.side[0], e.side[1], e.side[2]}});
  }
  return calls;
}

void MujocoTendon::addJoint(const std::string& path, double coefficient) {
  add(false, path, {.point = {coefficient, 0, 0}});
}
void MujocoTendon::addPoint(const std::string& path, double x, double y, double z) {
  add(true, path, {.point = {x, y, z}});
}
void MujocoTendon::addSphere(const std::string& path, double x, double y, double z, double radius) {
  add(true, path, {.point = {x, y, z}, .kind = mujoco::TendonNumbers::kSphere, .radius = radius});
}
void MujocoTendon::addCylinder(const std::string& path, double x, double y, double z, double radius,
                               const List& rotation) {
  if (rotation.size() != 4)
    throw Error(fmt::format("{}: expected a rotation w x y z, found {} numbers", this->path(), rotation.size()));
  mujoco::TendonNumbers::Element e{.point = {x, y, z}, .kind = mujoco::TendonNumbers::kCylinder, .radius = radius};
  for (std::size_t i = 0; i < 4; ++i) e.rotation[i] = rotation[i].toNumber();
  add(true, path, e);
}
void MujocoTendon::addPulley(double divisor) {
  if (!(divisor > 0)) throw Error(fmt::format("{}: expected a divisor above 0, found {}", path(), divisor));
  add(true, "", {.point = {divisor, 0, 0}, .kind = mujoco::TendonNumbers::kPulley});
}

void MujocoTendon::setSide(const std::string& path, double x, double y, double z) {
  using N = mujoco::TendonNumbers;
  mujoco::requireFinite(*this, std::array{x, y, z});
  auto elements = numbers().elements;
  const bool wraps = !paths_.empty() && (elements[paths_.size() - 1].kind == N::kSphere ||
                                         elements[paths_.size() - 1].kind == N::kCylinder);
  if (!wraps) throw Error(fmt::format("{}: expected a sphere or a cylinder before its side", this->path()));
  N::Element& last = elements[paths_.size() - 1];
  last.hasSide = 1;
  last.side = {x, y, z};
  sides_.back() = path;
  set<&N::elements>(elements);
  resolve();
}

void MujocoTendon::add(bool spatial, const std::string& path, const mujoco::TendonNumbers::Element& element) {
  using N = mujoco::TendonNumbers;
  if (!paths_.empty() && (numbers().spatial != 0) != spatial)
    throw Error(fmt::format("{}: a tendon has joints or points, not both", this->path()));
  if (paths_.size() == N::kMaxElements)
    throw Error(fmt::format("{}: expected at most {} joints or points of a tendon", this->path(), N::kMaxElements));
  mujoco::requireFinite(*this, element.point);
  mujoco::requireFinite(*this, element.rotation);
  if (!(element.radius > 0) && (element.kind == N::kSphere || element.kind == N::kCylinder))
    throw Error(fmt::format("{}: expected a radius above 0, found {}", this->path(), element.radius));
  auto elements = numbers().elements;
  elements[paths_.size()] = element;
  paths_.push_back(path);
  sides_.emplace_back();
  set<&N::spatial>(spatial);
  set<&N::elements>(elements);
  resolve();
}

void MujocoTendon::resolve() {
  using N = mujoco::TendonNumbers;
  if (!parent()) return;
  auto elements = numbers().elements;
  bool lacks = false;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    N::Element& e = elements[i];
    e.id = mujoco::identityAt(*this, paths_[i], numbers().spatial == 0);
    e.sideId = mujoco::identityAt(*this, sides_[i], false);
    lacks |= e.id == 0 && !(paths_[i].empty() && numbers().spatial != 0);
    lacks |= e.sideId == 0 && !sides_[i].empty();
  }
  set<&N::elements>(elements);
  set<&N::lacks>(lacks);
  set<&N::count>(static_cast<std::int64_t>(paths_.size()));
}

void MujocoTendon::onLink() {
  resolve();
  MujocoConstraint::onLink();
}

}  // namespace spark
