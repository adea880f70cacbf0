#include "rigid_body.h"

#include <Eigen/Eigenvalues>

#include "spark/state.h"

namespace spark {

void RigidBody::describe(Description<RigidBody>& d) {
  using B = RigidBody;
  d.doc("A rigid body: it moves the nearest transform above it.");
  d.implements<IRigidBody>();
  d.implements<IPlacedBody>();
  d.implements<IFollowsTransform>();
  d.implements<ISceneCalls>();
  d.property("mass", &B::mass, &B::setMass)
      .unit("kg")
      .range(physics::kLeastMass, physics::kMostMass)
      .doc("Total mass. Setting it scales the inertia as well.");
  d.property("position", &B::position, &B::setPosition).unit("m").savedByClass().doc("Centre of mass in the world.");
  d.property("velocity", &B::velocity, &B::setVelocity)
      .unit("m/s")
      .savedByClass()
      .doc("Velocity of the centre of mass, in the world.");
  d.property("angularVelocity", &B::angularVelocity, &B::setAngularVelocity)
      .unit("rad/s")
      .savedByClass()
      .doc("Angular velocity, in the world.");
  d.property("connector", &B::connector, &B::setConnector)
      .doc(
          "The body only links two joints of a body that has several: what it connects counts as connected by one "
          "joint, and does not collide.");
  d.property("linkOrigin", &B::linkOrigin, &B::setLinkOrigin)
      .unit("m")
      .doc(
          "Origin of its link's frame, in the body's frame, for engines in coordinates of joints: the point of a free "
          "body whose place and velocity are its coordinates.");
  d.property("linearDamping", &B::linearDamping, &B::setLinearDamping)
      .unit("N s/m")
      .range(0, 1e9)
      .doc("Force per velocity against the motion in the world, at the origin of its link's frame.");
  d.property("angularDamping", &B::angularDamping, &B::setAngularDamping)
      .unit("N m s")
      .range(0, 1e9)
      .doc("Torque per angular velocity against the rotation in the world.");
  d.property("gravityOn", &B::usesGravity, &B::useGravity).doc("The world's gravity acts on it.");

  const auto solid = [&](const char* shape, auto set, auto setTotal, std::vector<std::string> lengths) {
    lengths.insert(lengths.begin(), "density [kg/m^3]");
    d.method(fmt::format("set{}", shape), set)
        .parameters(lengths)
        .doc(fmt::format("Sets mass and inertia to those of a solid {} of uniform density.", shape));
    lengths.front() = "mass [kg]";
    d.method(fmt::format("set{}Total", shape), setTotal)
        .parameters(lengths)
        .doc(fmt::format("Sets mass and inertia to those of a solid {}.", shape));
  };
  const auto added = [&](const char* shape, auto add, auto addTotal, std::vector<std::string> lengths) {
    const std::string doc =
        fmt::format("Adds the mass of a solid {} and moves the body's origin to the common centre of mass.", shape);
    lengths.insert(lengths.begin(), "density [kg/m^3]");
    d.method(fmt::format("add{}", shape), add).parameters(lengths).doc(doc);
    lengths.front() = "mass [kg]";
    d.method(fmt::format("add{}Total", shape), addTotal).parameters(lengths).doc(doc);
  };
  solid("Box", &B::setBox, &B::setBoxTotal, {"edges [m]"});
  solid("Sphere", &B::setSphere, &B::setSphereTotal, {"radius [m]"});
  solid("Capsule", &B::setCapsule, &B::setCapsuleTotal, {"radius [m]", "length [m]"});
  solid("Cylinder", &B::setCylinder, &B::setCylinderTotal, {"radius [m]", "length [m]"});
  added("Box", &B::addBox, &B::addBoxTotal, {"edges [m]", "matrix: position [m] and rotation [deg], or 16 numbers"});
  added("Sphere", &B::addSphere, &B::addSphereTotal,
        {"radius [m]", "matrix: position [m] and rotation [deg], or 16 numbers"});
  added("Capsule", &B::addCapsule, &B::addCapsuleTotal,
        {"radius [m]", "length [m]", "matrix: position [m] and rotation [deg], or 16 numbers"});
  added("Cylinder", &B::addCylinder, &B::addCylinderTotal,
        {"radius [m]", "length [m]", "matrix: position [m] and rotation [deg], or 16 numbers"});
  d.method("setMassParameters", &B::setMassParameters)
      .parameters({"mass [kg]", "centre [m]", "I11 I22 I33 [kg m^2]", "I12 I13 I23 [kg m^2]"})
      .surplusIgnored()
      .doc("Sets mass and inertia. The centre must be 0; another one is ignored, with a warning in the log.");
  d.method("addPart", &B::addPart)
      .parameters({"mass [kg]", "centre [m]", "I11 I22 I33 [kg m^2]", "I12 I13 I23 [kg m^2]", "w x y z"})
      .doc(
          "Names a part of which the body consists, in the body's frame, with its inertia about its own centre: for "
          "engines whose drag and contacts depend on parts. The first one has the joints. The body's mass stays; parts "
          "have shares of it, until its distribution is changed. The quaternion turns to its principal axes, where "
          "several fit.");
  d.method("setLocalPose", &B::setLocalPose)
      .parameters({"position [m]", "rotation: 9 numbers, row by row"})
      .doc("Sets the pose in the frame of the nearest transform, which is in single precision, in double precision.");
  d.method("translateMass", &B::translateMass)
      .parameters({"offset [m]"})
      .doc("Accepted for old scenes; has no effect, as in the installed base.");

  d.method("addForce", &B::addForceBy)
      .parameters({"force [N]"})
      .doc("Adds a force at the centre of mass for the next step, in the world frame.");
  d.method("addTorque", &B::addTorque)
      .parameters({"torque [Nm]"})
      .doc("Adds a torque for the next step, in the world frame.");
  d.method("enable", &B::enable).doc("Wakes the body.");
  d.method("disable", &B::disable).doc("Puts the body to sleep.");
  d.method("isEnabled", &B::enabled).doc("False while the body sleeps.");
  d.method("useGravity", &B::useGravity).parameters({"on"}).doc("Switches the world's gravity for this body.");
}

void RigidBody::onLink() {
  Body::onLink();
  World& world = World::of(*this);
  worldNode_ = Ref<World>(&world);
  world_ = world.model();
  body_ = world_->createBody();
  const Pose pose = physics::frameOf(*this);
  world_->setPosition(body_, pose.position);
  world_->setRotation(body_, pose.rotation);
  world_->setMass(body_, mass_);
  world_->setLinkOrigin(body_, linkOrigin_);
  world_->setConnector(body_, connector_);
  world_->setParts(body_, parts_);
  world_->setDamping(body_, linearDamping_, angularDamping_);
  world_->setGravityMode(body_, gravity_);
}

void RigidBody::onUnlink() {
  if (world_) world_->destroyBody(body_);
  body_ = physics::BodyHandle::none;
  world_.reset();
  Body::onUnlink();
}

std::uint64_t RigidBody::identity() const { return world_ ? world_->model().bodies[world_->index(body_)].id : 0; }

engine::BodyState RigidBody::state() const {
  if (world_) return world_->state(body_);
  const Pose p = physics::frameOf(*this);
  return {p.position, Vec3::Zero(), Vec3::Zero(), p.rotation};
}

Vec3 RigidBody::worldGravity() const {
  return world_ ? world_->model().parameters.gravity : engine::WorldParameters().gravity;
}

void RigidBody::wake() {
  placed_ = false;
  if (!world_->enabled(body_)) world_->setEnabled(body_, true);
}

void RigidBody::setPose(const Pose& pose) {
  if (!world_) return;
  world_->setPosition(body_, pose.position);
  world_->setRotation(body_, pose.rotation);
  wake();
}

void RigidBody::setPosition(const Vec3& position) {
  if (!world_) return;
  world_->setPosition(body_, position);
  wake();
}

void RigidBody::setVelocity(const Vec3& v) {
  if (!world_) return;
  const Vec3 before = world_->state(body_).linearVelocity;
  world_->setLinearVelocity(body_, v);
  jumps_.linear += world_->state(body_).linearVelocity - before;
  if (!v.isZero(0)) wake();
}

void RigidBody::setAngularVelocity(const Vec3& w) {
  if (!world_) return;
  const Vec3 before = world_->state(body_).angularVelocity;
  world_->setAngularVelocity(body_, w);
  jumps_.angular += world_->state(body_).angularVelocity - before;
  if (!w.isZero(0)) wake();
}

void RigidBody::addForce(const Vec3& f) {
  if (!world_ || f.isZero(0)) return;
  world_->addForce(body_, f);
  wake();
}

void RigidBody::addTorque(const Vec3& t) {
  if (!world_ || t.isZero(0)) return;
  world_->addTorque(body_, t);
  wake();
}

void RigidBody::addDrag(double linear, double angular) {
  if (world_) world_->addDrag(body_, linear, angular);
}

bool RigidBody::enabled() const { return world_ && world_->enabled(body_); }

void RigidBody::enable() {
  if (world_) world_->setEnabled(body_, true);
}

void RigidBody::disable() {
  if (world_) world_->setEnabled(body_, false);
}

void RigidBody::setConnector(bool on) {
  connector_ = on;
  if (world_) world_->setConnector(body_, on);
}

void RigidBody::setDamping(double linear, double angular) {
  linearDamping_ = linear;
  angularDamping_ = angular;
  if (world_) world_->setDamping(body_, linear, angular);
}

void RigidBody::setLinkOrigin(const Vec3& origin) {
  linkOrigin_ = origin;
  if (world_) world_->setLinkOrigin(body_, origin);
}

void RigidBody::useGravity(bool on) {
  gravity_ = on;
  if (world_) world_->setGravityMode(body_, on);
}

namespace {
/// True if a transform, or one above it, was moved by hand since the last place phase.
bool isMovedByHand(const Transform* transform) {
  for (; transform; transform = transform->transform())
    if (transform->movedSincePlace()) return true;
  return false;
}
}  // namespace

void RigidBody::follow(const Matrix& world) {
  // The transform still has the origin before the pending shift.
  setPose(compose(toPose(world), {-pendingShift_, Mat3::Identity()}));
}

void RigidBody::catchUp() {
  if (!world_ || !isMovedByHand(transform())) return;
  // Where it is there already, but for the transform's single precision, its digits stay.
  const Pose due = compose(physics::frameOf(*this), {-pendingShift_, Mat3::Identity()});
  const engine::BodyState now = world_->state(body_);
  const double rounding = 1e-6 * (1 + due.position.norm());
  if ((due.position - now.position).norm() > rounding || !due.rotation.isApprox(now.rotation, 1e-6)) setPose(due);
}

void RigidBody::applyMass(const engine::Mass& mass) {
  if (world_) {
    try {
      world_->setMass(body_, mass);
    } catch (const Error& e) {
      throw Error(fmt::format("{}: cannot set the mass; it stays {:g} kg", where(), mass_.mass), e);
    }
  }
  const bool scaled = mass.inertia.isApprox(mass.mass / mass_.mass * mass_.inertia, 1e-9);
  mass_ = mass;
  if (scaled || parts_.empty()) return;
  parts_.clear();
  if (world_) world_->setParts(body_, parts_);
}

void RigidBody::add(const engine::Mass& part, const std::vector<double>& matrix) {
  // `matrix` is relative to the original origin.
  Pose at = physics::poseFrom(matrix);
  at.position += shift_;
  const engine::Mass sum = physics::addMass(mass_, part, at);
  applyMass(physics::centred(sum));

  // The body's origin is the centre of mass: move it there, and the surroundings back by the same offset.
  const Vec3 center = sum.center;
  if (world_) {
    const engine::BodyState s = world_->state(body_);
    world_->setPosition(body_, s.position + s.rotation * center);
    placed_ = false;
  }
  shift_ -= center;
  pendingShift_ -= center;
  if (worldNode_) worldNode_->markRecentred();
}

Vec3 RigidBody::takeShift() { return std::exchange(pendingShift_, Vec3::Zero()); }

void RigidBody::setMass(double m) {
  engine::Mass scaled = mass_;
  scaled.mass = m;
  scaled.inertia *= m / mass_.mass;
  applyMass(scaled);
}

namespace {
Mat3 symmetric(const Vec3& diagonal, const Vec3& products) {
  Mat3 m = diagonal.asDiagonal();
  m(0, 1) = m(1, 0) = products.x();
  m(0, 2) = m(2, 0) = products.y();
  m(1, 2) = m(2, 1) = products.z();
  return m;
}
}  // namespace

void RigidBody::addPart(double m, const Vec3& center, const Vec3& diagonal, const Vec3& products,
                        const std::vector<double>& axes) {
  if (!(m >= 0)) throw Error(fmt::format("{}: expected the mass of a part, at least 0 kg, found {}", where(), m));
  std::array<double, 4> quaternion{};
  if (axes.size() != quaternion.size())
    throw Error(fmt::format("{}: expected 4 numbers of the axes of a part, found {}", where(), axes.size()));
  std::copy(axes.begin(), axes.end(), quaternion.begin());
  if (!(std::abs(Eigen::Vector4d(quaternion.data()).norm() - 1) < 1e-6))
    throw Error(fmt::format("{}: expected a quaternion of length 1 for the axes of a part", where()));
  const Mat3 inertia = symmetric(diagonal, products);
  const bool real = center.allFinite() && center.norm() < 1e6 && m < 1e8 && inertia.allFinite() &&
                    inertia.norm() < 1e8 &&
                    Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues().minCoeff() >= -1e-9 * inertia.norm();
  if (!real)
    throw Error(
        fmt::format("{}: expected a part with a mass below 1e8 kg, a centre within 1e6 m and an inertia that a body "
                    "can have, found {} kg at ({}, {}, {}) with moments of {}, {}, {}",
                    where(), m, center.x(), center.y(), center.z(), diagonal.x(), diagonal.y(), diagonal.z()));
  parts_.push_back({m, center, inertia, rotationOf(quaternion)});
  if (world_) world_->setParts(body_, parts_);
}

void RigidBody::setMassParameters(double m, const Vec3& center, const Vec3& diagonal, const Vec3& products) {
  if (!center.isZero(1e-9))
    kernel().log().warning(
        "{}: setMassParameters was given the centre ({}, {}, {}); a body's centre of mass is its origin, so 0 was "
        "taken. Move the transform there.",
        where(), center.x(), center.y(), center.z());
  applyMass({m, Vec3::Zero(), symmetric(diagonal, products)});
}

void RigidBody::setLocalPose(const Vec3& position, const std::vector<double>& rotation) {
  const Pose frame = physics::frameOf(*this), local = physics::poseOfNumbers(*this, position, rotation);
  setPose({frame.position + frame.rotation * local.position, frame.rotation * local.rotation});
}

std::vector<SceneCall> RigidBody::sceneCalls() const {
  if (!pendingShift_.isZero(0))
    throw Error(fmt::format("{}: cannot be written: its origin is about to move to the centre of mass", where()));
  std::vector<SceneCall> calls;
  const auto numbersOf = [](double mass, const Vec3& at, const Mat3& i) {
    return List{mass, at.x(), at.y(), at.z(), i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)};
  };
  const engine::BodyState now = state();
  const Pose frame = physics::frameOf(*this);
  if (now.position != frame.position || !now.rotation.isApprox(frame.rotation, 1e-7)) {
    // The frame is a matrix in single precision: its inverse is not its transpose.
    const Mat3 inverse = frame.rotation.inverse();
    calls.push_back(
        {"setLocalPose", physics::numbersOfPose({inverse * (now.position - frame.position), inverse * now.rotation})});
  }
  if (mass_.mass != engine::Mass().mass || mass_.inertia != engine::Mass().inertia)
    calls.push_back({"setMassParameters", numbersOf(mass_.mass, Vec3::Zero(), mass_.inertia)});
  for (const engine::Part& part : parts_) {
    List numbers = numbersOf(part.mass, part.center, part.inertia);
    const Eigen::Quaterniond q(part.axes);
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) numbers.emplace_back(v);
    calls.push_back({"addPart", std::move(numbers)});
  }
  return calls;
}

bool RigidBody::takeUnplaced() {
  if (!world_) return false;
  const bool awake = world_->enabled(body_);
  const bool unplaced = awake || !placed_;
  placed_ = !awake;
  return unplaced;
}

bool RigidBody::countFault() {
  ++faults_;
  return (faults_ & (faults_ - 1)) == 0;
}

void RigidBody::saveState(StateWriter& out) const {
  out.write(mass_.mass);
  for (int i = 0; i < 9; ++i) out.write(mass_.inertia.data()[i]);
  for (int i = 0; i < 3; ++i) out.write(shift_[i]);
  for (int i = 0; i < 3; ++i) out.write(pendingShift_[i]);
  std::vector<double> numbers;
  if (world_) world_->saveBody(body_, numbers);
  out.write(static_cast<std::int64_t>(numbers.size()));
  for (double v : numbers) out.write(v);
  if (out.keeps()) out.aside(world_ ? world_->saveSupport(body_) : std::string());
}

void RigidBody::loadState(StateReader& in) {
  engine::Mass mass;
  mass.mass = in.readNumber();
  for (int i = 0; i < 9; ++i) mass.inertia.data()[i] = in.readNumber();
  for (int i = 0; i < 3; ++i) shift_[i] = in.readNumber();
  for (int i = 0; i < 3; ++i) pendingShift_[i] = in.readNumber();
  const std::int64_t count = in.readInteger();
  if (count < 0 || count > 1024)
    throw Error(fmt::format("{}: expected the saved numbers of a body, found a count of {}", where(), count));
  std::vector<double> numbers(count);
  for (double& v : numbers) v = in.readNumber();
  applyMass(mass);
  if (world_) world_->loadBody(body_, numbers);
  const std::string support = in.readString();
  if (world_) world_->loadSupport(body_, support);
  placed_ = false;
  if (worldNode_ && !pendingShift_.isZero(0)) worldNode_->markRecentred();
}

}  // namespace spark
