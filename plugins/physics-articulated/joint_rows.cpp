#include "api/joint_stops.h"
#include "rows.h"

// The rows of each joint type, as ODE has them (Smith, ODE manual, "Joint Types and Functions").
//
// A row constrains the velocity of body a relative to body b, at one point or about one axis. With r_a and r_b the
// anchor relative to the bodies' centres, the Jacobians are
//
//     point, along d:     J_A = (d, r_a x d)      J_B = (-d, -r_b x d)
//     rotation about d:   J_A = (0, d)            J_B = (0, -d)
//
// and the target velocity is erp / dt times the position error, which removes a fraction erp of the error in one
// step.

namespace spark::articulated {

namespace {

using engine::JointAxis;
using engine::JointType;
using engine::nearestTurn;

/// Whether an axis is at a stop, and by how much it is beyond it [rad or m]: negative at the low stop.
struct StopContact {
  Stop stop = Stop::none;
  double excess = 0;
};

/// Writes the rows of one joint, from `next` on.
struct JointWriter {
  const engine::Joint& joint;
  const engine::JointSoftness& soft;
  const engine::Motors& motors;
  const engine::JointCoordinates& coordinates;
  const engine::LawsByJoint& laws;
  Index index;  ///< of the joint
  RigidBodyState& a;
  RigidBodyState* b;
  const StepConstants& constants;
  Row* next;

  // ---- frames and constants ----

  Vec3 fromA(const Vec3& v) const { return a.rotation * v; }
  Vec3 fromB(const Vec3& v) const { return b ? Vec3(b->rotation * v) : v; }
  Vec3 positionB() const { return b ? b->position : Vec3(Vec3::Zero()); }
  /// Velocity per position error, with the world's ERP [1/s].
  double errorGain() const { return constants.inverseDt * constants.erp; }
  /// D of a row.
  double softness(double cfm) const { return cfm * constants.inverseDt; }

  // ---- single rows; `velocity` is the target velocity [m/s or rad/s] ----

  Row& add(const SpatialVector& jacobianA, const SpatialVector& jacobianB, double velocity, double cfm) {
    Row& row = *next++;
    row = {};
    row.jacobianA = jacobianA;
    row.jacobianB = jacobianB;
    row.target = velocity * constants.inverseDt;
    row.softness = softness(cfm);
    return row;
  }
  /// Rotation about `axis`.
  Row& addAngular(const Vec3& axis, double velocity, double cfm) {
    return add(SpatialVector::of(Vec3::Zero(), axis), SpatialVector::of(Vec3::Zero(), -axis), velocity, cfm);
  }
  /// Translation of the anchor along `direction`; armA and armB are the anchor relative to the bodies' centres.
  void addPoint(const Vec3& direction, const Vec3& armA, const Vec3& armB, double velocity, double cfm) {
    add(SpatialVector::of(direction, armA.cross(direction)), SpatialVector::of(-direction, direction.cross(armB)),
        velocity, cfm);
  }

  // ---- groups of rows ----

  /// Anchor relative to b's centre, world axes; zero for the world.
  Vec3 armOfB() const { return b ? Vec3(b->rotation * joint.inB.anchor) : Vec3(Vec3::Zero()); }
  /// From a's anchor point to b's.
  Vec3 anchorError(const Vec3& armA, const Vec3& armB) const {
    return (b ? Vec3(b->position + armB) : joint.inB.anchor) - a.position - armA;
  }
  /// Three rows that keep the anchor points together.
  void addBall(double erp, double cfm) {
    const Vec3 armA = fromA(joint.inA.anchor), armB = armOfB();
    const Vec3 error = anchorError(armA, armB);
    const double gain = constants.inverseDt * erp;
    for (int i = 0; i < 3; ++i) addPoint(Vec3::Unit(i), armA, armB, gain * error[i], cfm);
  }

  /// b's rotation relative to a, as a change since the joint was set: q_a^* q_b q_0^*.
  Quaternion rotationSince(const std::array<double, 4>& initial) const {
    const Quaternion rotationB = b ? b->orientation : Quaternion{};
    return a.orientation.conjugate() * rotationB * Quaternion::of(initial).conjugate();
  }
  /// Three rows that keep the relative rotation.
  void addSameRotation() {
    // A small rotation q = (w, v) has the rotation vector 2 v, with the sign of q that makes w positive.
    const Quaternion q = rotationSince(joint.inA.rotation);
    const Vec3 error = fromA(q.w < 0 ? Vec3(-q.v) : q.v);
    for (int i = 0; i < 3; ++i) addAngular(Vec3::Unit(i), 2 * errorGain() * error[i], constants.cfm);
  }

  // ---- motors and stops ("Stops and motor parameters") ----

  /// The stop that an axis at `position` has reached.
  static StopContact stopAt(const JointAxis& axis, double position) {
    if (position <= axis.lowStop) return {Stop::low, position - axis.lowStop};
    if (position >= axis.highStop) return {Stop::high, position - axis.highStop};
    return {};
  }
  static bool hasStops(const JointAxis& axis) {
    return (axis.lowStop > -HUGE_VAL || axis.highStop < HUGE_VAL) && axis.lowStop <= axis.highStop;
  }
  /// The same for a rotational axis, at an angle within one turn.
  StopContact angularStopAt(std::size_t axis, double angle) const {
    return stopAt(joint.axes[axis], nearestTurn(angle, coordinates.at(axis)));
  }

  /// The force of a motor at a stop. It presses with its full force, or drives away from the stop with a fraction of it
  /// (the fudge factor), which avoids a jump off the stop.
  static double motorForceAtStop(double fudgeFactor, const engine::Motor& motor, Stop stop) {
    double force = motor.maxForce;
    if (motor.velocity > 0 || (motor.velocity == 0 && stop == Stop::high)) force = -force;
    if ((stop == Stop::low && motor.velocity > 0) || (stop == Stop::high && motor.velocity < 0)) force *= fudgeFactor;
    return force;
  }
  /// Adds -force along the row to the forces on the bodies.
  void subtractForce(const SpatialVector& jacobianA, const SpatialVector& jacobianB, double force) {
    a.force -= force * jacobianA.linear();
    a.torque -= force * jacobianA.angular();
    if (!b) return;
    b->force -= force * jacobianB.linear();
    b->torque -= force * jacobianB.angular();
  }

  /// The present velocity along a row.
  double motionAlong(const SpatialVector& jacobianA, const SpatialVector& jacobianB) const {
    const auto motion = [](const RigidBodyState& s) { return SpatialVector::of(s.linearVelocity, s.angularVelocity); };
    return dot(jacobianA, motion(a)) + (b ? dot(jacobianB, motion(*b)) : 0);
  }
  /// A row of an inertial force alone (rows.h); `momentum`: that of the rotor.
  void addInertial(const SpatialVector& jacobianA, const SpatialVector& jacobianB, double inertia, double momentum) {
    Row& row = add(jacobianA, jacobianB, momentum / inertia, 0);
    row.softness = 1 / inertia;
  }

  void setInertia(Row& row, double inertia, double momentum) const {
    if (inertia == 0) return;
    row.inertia = inertia;
    row.inertialTarget = momentum * constants.inverseDt / inertia;
  }

  // ---- laws (engine::AxisLaw) ----

  /// A law in the direction of a row.
  struct Law {
    double force = 0, resistance = 0, maxForce = 0;
  };
  static Law lawAlong(const engine::AxisLaw& law, const SpatialVector& jacobianA) {
    const Vec3 linear = jacobianA.linear();
    const double cosine = (linear.isZero(0) ? jacobianA.angular() : linear).dot(law.along);
    return {cosine < 0 ? -law.force : law.force, law.resistance, law.maxForce};
  }
  /// A row of a law with a bound, beside an inertial force.
  void addLaw(std::uint8_t axis, const SpatialVector& jacobianA, const SpatialVector& jacobianB, const Law& law,
              double inertia, double momentum) {
    Row& row = add(jacobianA, jacobianB, law.force / law.resistance, 0);
    row.softness = constants.inverseDt / law.resistance;
    row.low = -law.maxForce, row.high = law.maxForce;
    row.axis = axis;
    setInertia(row, inertia, momentum);
  }

  /// The row of axis `at`: its stop's if it has reached one, else its motor's if it has one, else none. `velocity`
  /// is the present velocity of a relative to b along the axis, for bounce. `drift`: what turns of the Jacobian add to
  /// the acceleration along the row [m/s^2]; 0 for rotation about an axis that is fixed in both bodies.
  void addAxis(Index at, const SpatialVector& jacobianA, const SpatialVector& jacobianB, const StopContact& contact,
               double velocity, double drift = 0) {
    const JointAxis& axis = joint.axes[at];
    const engine::JointSoftness::Axis& softAxis = soft.axes[at];
    const engine::Motor& motor = motors[at];
    const Stop stop = contact.stop;
    const bool stopped = stop != Stop::none;
    const bool locked = stopped && axis.lowStop == axis.highStop;
    const bool powered = motor.maxForce > 0 && !locked;
    double inertia = axis.armature + axis.damping / constants.inverseDt;
    // Of the row itself: that of a slider has arms, which `velocity` is without.
    double momentum =
        inertia > 0 ? axis.armature * (motionAlong(jacobianA, jacobianB) - drift / constants.inverseDt) : 0;
    Law bounded;
    laws.forEach(index, static_cast<int>(at), [&](const engine::AxisLaw& law) {
      Law own = lawAlong(law, jacobianA);
      if (law.maxForce < HUGE_VAL) {
        if (!powered && !stopped) return void(bounded = own);
        // The row has bounds already: the law begins the step within its own.
        const double force = std::abs(own.force - own.resistance * motionAlong(jacobianA, jacobianB));
        if (force > law.maxForce) own.force *= law.maxForce / force, own.resistance *= law.maxForce / force;
      }
      inertia += own.resistance / constants.inverseDt;
      momentum += own.force / constants.inverseDt;
    });
    if (!powered && !stopped) {
      if (bounded.resistance > 0)
        addLaw(static_cast<std::uint8_t>(at), jacobianA, jacobianB, bounded, inertia, momentum);
      else if (inertia > 0)
        addInertial(jacobianA, jacobianB, inertia, momentum);
      return;
    }
    // At a stop the motor acts as a given force: the row belongs to the stop. Dry friction does not press.
    const bool friction = motor.velocity == 0 && motor.maxForce == axis.dryFriction;
    if (powered && stopped && !friction)
      subtractForce(jacobianA, jacobianB, motorForceAtStop(softAxis.fudgeFactor, motor, stop));
    Row& row = add(jacobianA, jacobianB, motor.velocity, softAxis.cfm);
    row.axis = static_cast<std::uint8_t>(at);
    row.stop = stop;
    setInertia(row, inertia, momentum);
    // A motor reaches its target velocity with a force of at most maxForce.
    if (!stopped) {
      row.low = -motor.maxForce, row.high = motor.maxForce;
      return;
    }
    // A stop pushes only away from itself; equal stops push both ways and do not bounce.
    row.softness = softness(softAxis.stopCfm);
    double target = -engine::stopReturn(joint.type, contact.excess, softAxis.stopErp, 1 / constants.inverseDt);
    if (!locked) {
      (stop == Stop::low ? row.low : row.high) = 0;
      const double rebound = -softAxis.bounce * velocity;
      if (softAxis.bounce > 0 && stop == Stop::low && velocity < 0) target = std::max(target, rebound);
      if (softAxis.bounce > 0 && stop == Stop::high && velocity > 0) target = std::min(target, rebound);
    }
    row.target = target * constants.inverseDt;
  }
  /// The same for rotation about `axis`.
  void addAngularAxis(Index index, const Vec3& axis, const StopContact& contact) {
    const double velocity = a.angularVelocity.dot(axis) - (b ? b->angularVelocity.dot(axis) : 0);
    addAxis(index, SpatialVector::of(Vec3::Zero(), axis), SpatialVector::of(Vec3::Zero(), -axis), contact, velocity);
  }

  // ---- joint types ----

  void writeBall() {
    addBall(soft.erp, soft.cfm);
    const double damping = joint.axes[0].damping;
    for (int i = 0; damping > 0 && i < 3; ++i) {
      const Vec3 axis = Vec3::Unit(i);
      addInertial(SpatialVector::of(Vec3::Zero(), axis), SpatialVector::of(Vec3::Zero(), -axis),
                  damping / constants.inverseDt, 0);
    }
  }

  void writeHinge() {
    addBall(constants.erp, constants.cfm);
    // No rotation about the two directions perpendicular to the axis. The error is the cross product of the axis as
    // fixed in a and as fixed in b.
    const Vec3 axis = fromA(joint.inA.axis[0]);
    Vec3 p, q;
    perpendicularBasis(axis, p, q);
    const Vec3 error = axis.cross(fromB(joint.inB.axis[0]));
    addAngular(p, errorGain() * error.dot(p), constants.cfm);
    addAngular(q, errorGain() * error.dot(q), constants.cfm);
    // The angle is needed only for stops.
    StopContact contact;
    if (hasStops(joint.axes[0]))
      contact = angularStopAt(0, hingeAngle(rotationSince(joint.inA.rotation), joint.inA.axis[0]));
    addAngularAxis(0, axis, contact);
  }

  void writeSlider() {
    addSameRotation();
    Vec3 axis = fromA(joint.inA.axis[0]), p, q;
    perpendicularBasis(axis, p, q);
    // Forces act halfway between the centres: both bodies get the same torque, and the pair none.
    const Vec3 arm = b ? Vec3(0.5 * (b->position - a.position)) : Vec3(Vec3::Zero());
    // From a's centre to where it was when set, carried along by b. No component perpendicular to the axis.
    const Vec3 offset = positionB() + fromB(joint.inB.anchor) - a.position;
    for (const Vec3& d : {p, q})
      add(SpatialVector::of(d, arm.cross(d)), SpatialVector::of(-d, arm.cross(d)), errorGain() * d.dot(offset),
          constants.cfm);
    // Motor and stops along the axis.
    if (!b && joint.reversed) axis = -axis;
    const JointAxis& limits = joint.axes[0];
    const StopContact contact = hasStops(limits) ? stopAt(limits, -axis.dot(offset)) : StopContact{};
    const double velocity = a.linearVelocity.dot(axis) - (b ? b->linearVelocity.dot(axis) : 0);
    // What the turning axis adds to the second derivative of the slider's place.
    double drift = 0;
    if (b) {
      const Vec3& w = a.angularVelocity;
      const Vec3 turning = w.cross(axis);
      drift = 2 * turning.dot(a.linearVelocity - b->linearVelocity) + w.cross(turning).dot(a.position - b->position);
    }
    addAxis(0, SpatialVector::of(axis, arm.cross(axis)), SpatialVector::of(-axis, arm.cross(axis)), contact, velocity,
            drift);
  }

  void writeUniversal() {
    addBall(constants.erp, constants.cfm);
    // The axes stay perpendicular: no rotation about axis 1 x axis 2, where the error is the cosine between them.
    const Vec3 axis1 = fromA(joint.inA.axis[0]), axis2 = fromB(joint.inB.axis[1]);
    const double cosine = axis1.dot(axis2);
    addAngular(axis1.cross(axis2 - cosine * axis1).normalized(), -errorGain() * cosine, constants.cfm);
    const bool hasStops1 = hasStops(joint.axes[0]), hasStops2 = hasStops(joint.axes[1]);
    StopContact contact1, contact2;
    if (hasStops1 || hasStops2) {
      // The joint is two hinges in series with a cross between them: a turns about axis 1 relative to the cross, the
      // cross about axis 2 relative to b. Half a turn about the bisector exchanges the two arms of the cross.
      const Quaternion cross = Quaternion::of(orthonormalFrame(axis1, axis2));
      const Quaternion exchange{0, (axis1 + axis2).normalized()};
      const Quaternion crossInA = a.orientation.conjugate() * cross * Quaternion::of(joint.inA.rotation).conjugate();
      const Quaternion crossInB = (b ? b->orientation.conjugate() : Quaternion{}) * (exchange * cross) *
                                  Quaternion::of(joint.inB.rotation).conjugate();
      if (hasStops1) contact1 = angularStopAt(0, hingeAngle(crossInA, joint.inA.axis[0]));
      if (hasStops2) contact2 = angularStopAt(1, -hingeAngle(crossInB, joint.inB.axis[1]));
    }
    addAngularAxis(0, axis1, contact1);
    addAngularAxis(1, axis2, contact2);
  }

  void writeHinge2() {
    // The anchor, with the suspension along axis 1.
    const Vec3 axis1 = fromA(joint.inA.axis[0]), axis2 = fromB(joint.inB.axis[1]);
    const Vec3 armA = fromA(joint.inA.anchor), armB = armOfB();
    const Vec3 error = anchorError(armA, armB);
    Vec3 p, q;
    perpendicularBasis(axis1, p, q);
    addPoint(axis1, armA, armB, constants.inverseDt * soft.suspensionErp * axis1.dot(error), soft.suspensionCfm);
    addPoint(p, armA, armB, errorGain() * p.dot(error), constants.cfm);
    addPoint(q, armA, armB, errorGain() * q.dot(error), constants.cfm);
    // The angle between the axes stays as set; the error is the sine of the difference of the two angles.
    const Vec3 normal = axis1.cross(axis2);
    const double sine = normal.norm(), cosine = axis1.dot(axis2);
    addAngular(normal.normalized(), errorGain() * (joint.cosAxes * sine - joint.sinAxes * cosine), constants.cfm);
    // Steering angle: of axis 2 in the plane perpendicular to axis 1. Axis 2 has a motor and no stops.
    StopContact contact;
    if (hasStops(joint.axes[0])) {
      const Vec3 axis2InA = a.rotation.transpose() * axis2;
      contact = angularStopAt(0, -portableAtan2(joint.inA.axis[2].dot(axis2InA), joint.inA.axis[1].dot(axis2InA)));
    }
    addAngularAxis(0, axis1, contact);
    addAngularAxis(1, axis2, {});
  }

  void writeFixed() {
    addBall(soft.erp, soft.cfm);
    addSameRotation();
  }

  /// Angular motor in user mode: axes and angles are the caller's.
  void writeUserMotor() {
    const auto count = static_cast<Index>(joint.motor.axes);
    for (Index i = 0; i < count; ++i) {
      const Vec3 &inA = joint.inA.axis[i], &inB = joint.inB.axis[i];
      const Vec3 axis = joint.motor.frame[i] == 1 ? fromA(inA) : joint.motor.frame[i] == 2 ? fromB(inB) : inA;
      addAngularAxis(i, axis, stopAt(joint.axes[i], joint.motor.angle[i]));
    }
  }

  /// Angular motor in Euler mode.
  void writeEulerMotor() {
    // Axis 0 is fixed in the first body, axis 2 in the second, axis 1 is perpendicular to both. In a reversed joint, a
    // is the second body.
    const std::size_t ofA = joint.reversed ? 2 : 0, ofB = 2 - ofA;
    std::array<Vec3, 3> axis;
    axis[ofA] = fromA(joint.inA.axis[ofA]);
    axis[ofB] = fromB(joint.inB.axis[ofB]);
    axis[1] = axis[2].cross(axis[0]).normalized();
    // Where axes 2 and 0 were when set, carried along by the other body: angles 0 and 2 are counted from there.
    std::array<Vec3, 3> zero;
    zero[ofA] = fromB(joint.inB.axis[ofA]);
    zero[ofB] = fromA(joint.inA.axis[ofB]);
    const Vec3 normal = axis[0].cross(axis[1]);
    const double angles[] = {-portableAtan2(axis[2].dot(axis[0].cross(zero[2])), axis[2].dot(zero[2])),
                             -portableAtan2(axis[2].dot(axis[0]), axis[2].dot(normal)),
                             -portableAtan2(zero[0].dot(axis[1]), zero[0].dot(axis[1].cross(axis[2])))};
    // The velocity about direction i depends on the rate of angle i alone: it is perpendicular to the other two axes.
    const Vec3 directions[] = {axis[1].cross(axis[2]), axis[1], normal};
    for (Index i = 0; i < 3; ++i) addAngularAxis(i, directions[i], angularStopAt(i, angles[i]));
  }

  void write() {
    switch (joint.type) {
      case JointType::ball:
        return writeBall();
      case JointType::hinge:
        return writeHinge();
      case JointType::hinge2:
        return writeHinge2();
      case JointType::slider:
        return writeSlider();
      case JointType::universal:
        return writeUniversal();
      case JointType::fixed:
        return writeFixed();
      case JointType::angularMotor:
        return joint.motor.euler ? writeEulerMotor() : writeUserMotor();
    }
  }
};

}  // namespace

Index writeJointRows(const engine::Joint& joint, const engine::JointSoftness& soft, const engine::Motors& motors,
                     const engine::JointCoordinates& coordinates, const engine::LawsByJoint& laws, Index index,
                     RigidBodyState& a, RigidBodyState* b, const StepConstants& constants, Row* out) {
  JointWriter writer{joint, soft, motors, coordinates, laws, index, a, b, constants, out};
  writer.write();
  return toIndex(static_cast<std::size_t>(writer.next - out));
}

}  // namespace spark::articulated
