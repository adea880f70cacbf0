#include "joint.h"

#include <optional>

#include "spark/state.h"

namespace spark {

using engine::JointParameter;
using engine::JointType;

namespace {

constexpr int kSavedParameters = 11;    // those of JointParameter that are state: the first ones
constexpr double kShortestAxis = 1e-9;  // shorter axes are refused
static_assert(static_cast<int>(JointParameter::suspensionCfm) == kSavedParameters - 1);

}  // namespace

void Joint::describe(Description<Joint>& d) {
  using J = Joint;
  using P = JointParameter;
  d.doc("Connects two bodies, or a body with the world.");
  d.implements<IJoint>();
  d.implements<ISceneCalls>();
  d.abstract();
  d.method("attach", &J::attach)
      .parameters({"path of the first body", "path of the second"})
      .optional(1)
      .doc(
          "Connects two bodies by paths relative to the joint; without a second path, a body with the static world. "
          "Where the first path is empty, motor and stops of a hinge count against its angle.");

  const auto axis = [&](const char* name, auto set, auto get, const char* unit, const char* doc) {
    const std::string value = *unit ? fmt::format("value [{}]", unit) : "value";
    d.method(std::string("set") + name, set).parameters({"axis", value}).doc(doc);
    d.method(std::string("get") + name, get).parameters({"axis"}).doc(doc);
  };
  // Meanings as in the ODE manual, "Stop and motor parameters".
  axis("LowStopDeg", &J::setDeg<P::lowStop>, &J::getDeg<P::lowStop>, "deg", "Lower stop.");
  axis("HighStopDeg", &J::setDeg<P::highStop>, &J::getDeg<P::highStop>, "deg", "Upper stop.");
  axis("LowStopPos", &J::set<P::lowStop>, &J::get<P::lowStop>, "m or rad", "Lower stop.");
  axis("HighStopPos", &J::set<P::highStop>, &J::get<P::highStop>, "m or rad", "Upper stop.");
  axis("FudgeFactor", &J::set<P::fudgeFactor>, &J::get<P::fudgeFactor>, "",
       "Scales the excess force of a motor that moves the joint away from a stop, 0..1.");
  axis("Bounce", &J::set<P::bounce>, &J::get<P::bounce>, "", "Coefficient of restitution of the stops, 0..1.");
  axis("CFM", &J::set<P::cfm>, &J::get<P::cfm>, "", "Constraint force mixing of the motor.");
  axis("StopCFM", &J::set<P::stopCfm>, &J::get<P::stopCfm>, "", "Constraint force mixing of the stops.");
  axis("StopERP", &J::set<P::stopErp>, &J::get<P::stopErp>, "",
       "Error reduction parameter of the stops: the fraction of the error that one step corrects.");
  axis("SuspensionERP", &J::set<P::suspensionErp>, &J::get<P::suspensionErp>, "",
       "Error reduction parameter of a wheel's suspension.");
  axis("SuspensionCFM", &J::set<P::suspensionCfm>, &J::get<P::suspensionCfm>, "",
       "Constraint force mixing of a wheel's suspension.");
  axis("LinearMotorVelocity", &J::set<P::velocity>, &J::get<P::velocity>, "m/s", "Target speed of the motor.");
  axis("AngularMotorVelocity", &J::setDeg<P::velocity>, &J::getDeg<P::velocity>, "deg/s", "Target speed of the motor.");
  axis("MaxMotorForce", &J::set<P::maxForce>, &J::get<P::maxForce>, "N or Nm",
       "Maximum force or torque of the motor; 0: no motor.");
  axis("Armature", &J::set<P::armature>, &J::get<P::armature>, "kg m^2 or kg",
       "Inertia of the motor's rotor about the axis.");
  axis("Damping", &J::set<P::damping>, &J::get<P::damping>, "N m s or N s/m",
       "Force per velocity, against it; axis 0 of a ball joint is any direction.");
  axis("DryFriction", &J::set<P::dryFriction>, &J::get<P::dryFriction>, "Nm or N",
       "Largest force of dry friction; of an axis with a controller.");

  d.method("setLocalAxis", &J::setLocalAxis)
      .parameters({"axis", "direction"})
      .doc("Sets the direction of an axis, in the joint's frame.");
  d.method("setSpring", &J::setSpring)
      .parameters({"axis", "stiffness [Nm/rad]", "position [rad]"})
      .doc("Passive spring beside motor and controller: stiffness (position - angle); of a slider N/m and m.");
  axis("SpringStiffness", &J::setStiffness, &J::stiffness, "Nm/rad or N/m",
       "Stiffness of the passive spring; 0: none.");
  axis("SpringPosition", &J::setSpringPosition, &J::springPosition, "rad or m", "Where the passive spring is at rest.");
  d.method("setController", &J::setController)
      .parameters({"axis", "stiffness [Nm/rad]", "damping [N m s/rad]", "position [rad]", "velocity [rad/s]",
                   "force [Nm]", "maxForce [Nm]"})
      .doc(
          "Puts a controller in place of the axis' motor: stiffness (position - angle) + damping (velocity - rate) + "
          "force, at most maxForce; of a slider m and N.");
  d.method("addControllerTerm", &J::addControllerTerm)
      .parameters({"axis", "force [Nm]", "stiffness [Nm/rad]", "damping [N m s/rad]", "least [Nm]", "most [Nm]"})
      .doc(
          "Adds a term with a range of its own to the axis' controller: force - stiffness angle - damping rate; up to "
          "four.");
  d.implements<engine::IExtended>();
  d.property("jointMaxSpeed1", &J::maxSpeed1, &J::setMaxSpeed1)
      .unit("rad/s")
      .doc("Maximum speed that effectors may command on the first axis; 0: no limit.");
  d.property("jointMaxSpeed2", &J::maxSpeed2, &J::setMaxSpeed2)
      .unit("rad/s")
      .doc("Maximum speed that effectors may command on the second axis; 0: no limit.");
  d.method("enableFeedback", &J::enableFeedback).parameters({"on"}).doc("Switches the measurement of torques.");
  d.property("feedback", &J::feedback, &J::enableFeedback).doc("Torques are measured.");
  d.property("torque", &J::feedbackTorque)
      .unit("Nm")
      .doc("Torque on both bodies, summed, in the last step; of an AngularMotor on the first. 0 without feedback.");
}

void Joint::onLink() {
  PhysicsObject::onLink();
  world_ = World::of(*this).model();
  if (acts()) joint_ = world_->createJoint(jointType());
}

void Joint::onUnlink() {
  if (world()) world()->destroyJoint(joint_);
  joint_ = physics::JointHandle::none;
  attached_ = false;
  pending_.clear();
  world_.reset();
  PhysicsObject::onUnlink();
}

int Joint::axes() const { return engine::axesOf(jointType()); }

void Joint::expectAxis(int axis, JointParameter p) const {
  // The damping of a ball joint acts about all directions.
  if (p != JointParameter::damping || jointType() != engine::JointType::ball) return expectAxis(axis);
  if (axis != 0) throw Error(fmt::format("{}: expected axis 0 for the damping, found axis {}", where(), axis));
}

void Joint::expectAxis(int axis) const {
  if (axis >= 0 && axis < axes()) return;
  const std::string range = axes() == 0   ? "no axis: this joint has neither motor nor stops"
                            : axes() == 1 ? "axis 0"
                                          : fmt::format("an axis from 0 to {}", axes() - 1);
  throw Error(fmt::format("{}: expected {}, found axis {}", where(), range, axis));
}

void Joint::setParameter(JointParameter p, int axis, double v) {
  if (world()) world()->setParameter(joint_, p, axis, v);
}

double Joint::feedbackTorque() const {
  if (!feedback_ || !world()) return 0;
  Vec3 force1, torque1, force2, torque2;
  world()->feedback(joint_, force1, torque1, force2, torque2);
  // The torque of an angular motor is that on its first body.
  return jointType() == JointType::angularMotor ? torque1.norm() : torque1.norm() + torque2.norm();
}

Ref<RigidBody> Joint::bodyAt(const std::string& path) {
  if (path.empty()) return {};
  Leaf* found = find(path);
  if (auto body = found ? found->as<RigidBody>() : nullptr; body && body->world() == world_)
    return Ref<RigidBody>(body);
  kernel().log().warning(
      "{}: expected a RigidBody at '{}', found {}; it is attached to the static world instead. Paths are relative to "
      "the joint, and the body must stand before the joint.",
      where(), path, found ? "a " + found->classObject()->name() : "nothing");
  return {};
}

void Joint::attach(std::string first, std::string second) {
  if (!world()) return;
  bodies_[0] = bodyAt(first);
  bodies_[1] = bodyAt(second);
  placeBodies();
  const auto handle = [](const Ref<RigidBody>& b) { return b ? b->handle() : physics::BodyHandle::none; };
  try {
    world()->attach(joint_, handle(bodies_[0]), handle(bodies_[1]));
  } catch (const Error& e) {
    bodies_[0] = bodies_[1] = {};
    throw Error(fmt::format("{}: cannot attach '{}' and '{}'", where(), first, second), e);
  }

  // Apply what needed bodies, in the order in which it was set.
  attached_ = true;
  attached();
  for (const auto& set : std::exchange(pending_, {})) set();
}

void Joint::placeBodies() const {
  for (const Ref<RigidBody>& body : bodies_)
    if (body) body->catchUp();
}

void Joint::setAnchor(const Vec3& local) {
  expectFinite(local);
  withBodies([this, local] {
    const Pose frame = physics::frameOf(*this);
    world()->setAnchor(joint_, frame.position + frame.rotation * local);
  });
}

void Joint::setWorldAnchor(const Vec3& point) {
  expectFinite(point);
  withBodies([this, point] { world()->setAnchor(joint_, point); });
}

void Joint::setAxisLocal(int axis, const Vec3& direction) {
  expectDirection(direction);
  withBodies([this, axis, direction] { turnAxis(axis, physics::frameOf(*this).rotation * direction); });
}

void Joint::setWorldAxis(int axis, const Vec3& direction) {
  expectDirection(direction);
  withBodies([this, axis, direction] { turnAxis(axis, direction); });
}

void Joint::expectFinite(const Vec3& anchor) const {
  if (world() && !anchor.allFinite())
    throw RefusedValue(fmt::format("{}: expected finite numbers for the anchor", where()));
}

void Joint::expectDirection(const Vec3& direction) const {
  if (world() && !(direction.norm() >= kShortestAxis))
    throw Error(fmt::format("{}: cannot set the axis", where()), Error("expected an axis longer than 0"));
}

void Joint::turnAxis(int axis, const Vec3& direction) {
  try {
    world()->setAxis(joint_, axis, direction);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot set the axis", where()), e);
  }
}

void Joint::setBlock(const engine::Block& block) {
  blocks_.set(block);
  if (world()) world()->setBlocks(joint_, blocks_);
}

void Joint::removeBlock(std::uint64_t kind) {
  blocks_.remove(kind);
  if (world()) world()->setBlocks(joint_, blocks_);
}

void Joint::setSpring(int axis, double stiffness, double position) {
  expectAxis(axis);
  if (!(stiffness >= 0) || !std::isfinite(position))
    throw RefusedValue(
        fmt::format("{}: expected a stiffness of 0 or more and a finite position of the spring, found "
                    "{} and {}",
                    where(), stiffness, position));
  if (world()) world()->setSpring(joint_, axis, stiffness, position);
}

double Joint::stiffness(int axis) const { return springOf(axis).first; }
double Joint::springPosition(int axis) const { return springOf(axis).second; }

std::pair<double, double> Joint::springOf(int axis) const {
  if (axis < 0 || axis >= axes() || !world()) return {0, 0};
  const engine::JointAxis& a = world()->model().joints[world()->index(joint_)].axes[static_cast<std::size_t>(axis)];
  return {a.stiffness, a.springPosition};
}

void Joint::setController(int axis, double stiffness, double damping, double position, double velocity, double force,
                          double maxForce) {
  expectAxis(axis);
  control(axis, {stiffness, damping, position, velocity, force, maxForce});
}

void Joint::addControllerTerm(int axis, double force, double stiffness, double damping, double least, double most) {
  expectAxis(axis);
  const engine::Control* const present = world() ? world()->controlOf(joint_, axis) : nullptr;
  engine::Control c = present ? *present : engine::Control{};
  if (!c.add({force, stiffness, damping, least, most}))
    throw Error(fmt::format("{}: expected at most {} terms of a controller", path(), engine::Control::kMaxTerms));
  control(axis, c);
}

void Joint::enableFeedback(bool on) {
  feedback_ = on;
  if (world()) world()->setFeedback(joint_, on);
}

void Joint::saveState(StateWriter& out) const {
  for (int axis = 0; axis < axes(); ++axis) {
    double saved[kSavedParameters] = {};
    if (world()) world()->parameters(joint_, axis, saved);
    for (const double v : saved) out.write(v);
  }
  for (int axis = 0; axis < axes(); ++axis) {
    const engine::Control* c = world() ? world()->controlOf(joint_, axis) : nullptr;
    // 0: no controller; else its number of terms and 1.
    out.write(std::int64_t{c ? 1 + c->termCount : 0});
    if (!c) continue;
    for (const double v : {c->stiffness, c->damping, c->position, c->velocity, c->force, c->maxForce}) out.write(v);
    for (int i = 0; i < c->termCount; ++i) {
      const engine::ControlTerm& t = c->terms[static_cast<std::size_t>(i)];
      for (const double v : {t.force, t.stiffness, t.damping, t.least, t.most}) out.write(v);
    }
  }
  for (int axis = 0; axis < axes(); ++axis) out.write(world() ? world()->at(joint_).coordinate(axis) : 0.0);
}

void Joint::loadState(StateReader& in) {
  std::optional<physics::BodyWatch::Loading> loading;
  if (world()) loading.emplace(world()->watch());
  for (int axis = 0; axis < axes(); ++axis)
    for (int p = 0; p < kSavedParameters; ++p) setParameter(static_cast<JointParameter>(p), axis, in.readNumber());
  for (int axis = 0; axis < axes(); ++axis) {
    const std::int64_t written = in.readInteger();
    if (written == 0) continue;
    engine::Control c;
    for (double* v : {&c.stiffness, &c.damping, &c.position, &c.velocity, &c.force, &c.maxForce}) *v = in.readNumber();
    for (std::int64_t i = 1; i < written; ++i) {
      engine::ControlTerm t;
      for (double* v : {&t.force, &t.stiffness, &t.damping, &t.least, &t.most}) *v = in.readNumber();
      c.add(t);
    }
    if (world()) world()->control(joint_, axis, c);
  }
  for (int axis = 0; axis < axes(); ++axis) {
    const double coordinate = in.readNumber();
    if (world()) world()->loadCoordinate(joint_, axis, coordinate);
  }
}

}  // namespace spark
