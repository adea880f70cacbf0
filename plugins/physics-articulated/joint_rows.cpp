#include "rows.h"

// Rows by joint type. Both bodies' velocities meet in a row with opposite signs, at the same point or about the same
// axis; the target pushes back what has drifted apart. a1 and a2 are the anchors seen from the bodies' centres.

namespace spark::articulated {

namespace {

using engine::JointType;
using engine::SolverAxis;
using engine::SolverJoint;

struct JointWriter {
  const SolverJoint& joint;
  Frame& a;
  Frame* b;
  const RowScale& scale;
  Row* next;

  Vec3 inWorldA(const Vec3& v) const { return a.rotation * v; }
  Vec3 inWorldB(const Vec3& v) const { return b ? Vec3(b->rotation * v) : v; }
  Vec3 placeB() const { return b ? b->position : Vec3(Vec3::Zero()); }
  double correction() const { return scale.perSecond * scale.erp; }
  double softness(double cfm) const { return cfm * scale.perSecond; }

  /// A row that wants the velocity `wanted`.
  Row& add(const Six& onA, const Six& onB, double wanted, double cfm) {
    Row& row = *next++;
    row = {};
    row.a = onA;
    row.b = onB;
    row.target = wanted * scale.perSecond;
    row.softness = softness(cfm);
    return row;
  }
  Row& addTurning(const Vec3& axis, double wanted, double cfm) {
    return add(Six::of(Vec3::Zero(), axis), Six::of(Vec3::Zero(), -axis), wanted, cfm);
  }

  /// Two points meet, seen along a direction.
  void addPoint(const Vec3& direction, const Vec3& a1, const Vec3& a2, double wanted, double cfm) {
    add(Six::of(direction, a1.cross(direction)), Six::of(-direction, direction.cross(a2)), wanted, cfm);
  }
  void addBall(double erp, double cfm) {
    const Vec3 a1 = inWorldA(joint.anchorA), a2 = b ? Vec3(b->rotation * joint.anchorB) : Vec3(Vec3::Zero());
    const Vec3 apart = (b ? Vec3(b->position + a2) : joint.anchorB) - a.position - a1;
    const double k = scale.perSecond * erp;
    for (int i = 0; i < 3; ++i) addPoint(Vec3::Unit(i), a1, a2, k * apart[i], cfm);
  }

  /// Second body's rotation in the first, relative to what it was.
  Turn turned(const std::array<double, 4>& before) const {
    const Turn second = b ? b->turn : Turn{};
    return a.turn.inverse() * second * Turn::of(before).inverse();
  }
  void addSameRotation() {
    const Turn t = turned(joint.initialRotationA);
    const Vec3 error = inWorldA(t.w < 0 ? Vec3(-t.v) : t.v);
    for (int i = 0; i < 3; ++i) addTurning(Vec3::Unit(i), 2 * correction() * error[i], scale.cfm);
  }

  /// At which stop an axis stands, and how far beyond it.
  static int stopAt(const SolverAxis& axis, double position, double& beyond) {
    if (position <= axis.lowStop) return beyond = position - axis.lowStop, 1;
    if (position >= axis.highStop) return beyond = position - axis.highStop, 2;
    return 0;
  }
  static bool stopsTurn(const SolverAxis& axis) {
    return (axis.lowStop >= -kPi || axis.highStop <= kPi) && axis.lowStop <= axis.highStop;
  }

  /// What a motor does that presses against a stop: its whole force, or a part of it away from the stop, acts besides
  /// the stop's row.
  double pressing(const SolverAxis& axis, int stop) const {
    double force = axis.maxForce;
    if (axis.velocity > 0 || (axis.velocity == 0 && stop == 2)) force = -force;
    if ((stop == 1 && axis.velocity > 0) || (stop == 2 && axis.velocity < 0)) force *= axis.fudgeFactor;
    return force;
  }
  void press(const Six& onA, const Six& onB, double force) {
    a.force -= force * onA.linear();
    a.torque -= force * onA.angular();
    if (!b) return;
    b->force -= force * onB.linear();
    b->torque -= force * onB.angular();
  }

  /// The row of a motor, or of the stop that the axis has reached. `velocity`: of a relative to b along the axis, for
  /// bounce.
  void addAxis(int index, const Six& onA, const Six& onB, int stop, double beyond, double velocity) {
    const SolverAxis& axis = joint.axes[static_cast<std::size_t>(index)];
    const bool locked = stop && axis.lowStop == axis.highStop;
    const bool powered = axis.maxForce > 0 && !locked;
    if (!powered && !stop) return;
    if (powered && stop) press(onA, onB, pressing(axis, stop));
    Row& row = add(onA, onB, axis.velocity, axis.cfm);
    row.axis = static_cast<std::int8_t>(index);
    row.stop = static_cast<std::int8_t>(stop);
    if (!stop) {
      row.low = -axis.maxForce, row.high = axis.maxForce;
      return;
    }
    row.softness = softness(axis.stopCfm);
    double wanted = -scale.perSecond * axis.stopErp * beyond;
    if (!locked) {
      (stop == 1 ? row.low : row.high) = 0;
      const double rebound = -axis.bounce * velocity;
      if (axis.bounce > 0 && stop == 1 && velocity < 0) wanted = std::max(wanted, rebound);
      if (axis.bounce > 0 && stop == 2 && velocity > 0) wanted = std::min(wanted, rebound);
    }
    row.target = wanted * scale.perSecond;
  }
  void addTurningAxis(int index, const Vec3& axis, int stop, double beyond) {
    const double velocity = a.spin.dot(axis) - (b ? b->spin.dot(axis) : 0);
    addAxis(index, Six::of(Vec3::Zero(), axis), Six::of(Vec3::Zero(), -axis), stop, beyond, velocity);
  }

  void writeBall() { addBall(joint.erp, joint.cfm); }

  void writeHinge() {
    addBall(scale.erp, scale.cfm);
    const Vec3 axis = inWorldA(joint.axisA[0]);
    Vec3 p, q;
    planeSpace(axis, p, q);
    const Vec3 error = axis.cross(inWorldB(joint.axisB[0]));
    addTurning(p, correction() * error.dot(p), scale.cfm);
    addTurning(q, correction() * error.dot(q), scale.cfm);
    double beyond = 0;
    const int stop = stopsTurn(joint.axes[0])
                         ? stopAt(joint.axes[0], hingeAngle(turned(joint.initialRotationA), joint.axisA[0]), beyond)
                         : 0;
    addTurningAxis(0, axis, stop, beyond);
  }

  void writeSlider() {
    addSameRotation();
    Vec3 axis = inWorldA(joint.axisA[0]), p, q;
    planeSpace(axis, p, q);
    // Forces act halfway between the centres, so that they do not turn the pair.
    const Vec3 half = b ? Vec3(0.5 * (b->position - a.position)) : Vec3(Vec3::Zero());
    const Vec3 apart = placeB() + inWorldB(joint.anchorB) - a.position;
    for (const Vec3& d : {p, q})
      add(Six::of(d, half.cross(d)), Six::of(-d, half.cross(d)), correction() * d.dot(apart), scale.cfm);
    if (!b && joint.reversed) axis = -axis;
    const SolverAxis& limits = joint.axes[0];
    double beyond = 0;
    const bool stops = (limits.lowStop > -HUGE_VAL || limits.highStop < HUGE_VAL) && limits.lowStop <= limits.highStop;
    const int stop = stops ? stopAt(limits, -axis.dot(apart), beyond) : 0;
    const double velocity = a.velocity.dot(axis) - (b ? b->velocity.dot(axis) : 0);
    addAxis(0, Six::of(axis, half.cross(axis)), Six::of(-axis, half.cross(axis)), stop, beyond, velocity);
  }

  void writeUniversal() {
    addBall(scale.erp, scale.cfm);
    const Vec3 axis1 = inWorldA(joint.axisA[0]), axis2 = inWorldB(joint.axisB[1]);
    const double leaning = axis1.dot(axis2);
    addTurning(axis1.cross(axis2 - leaning * axis1).normalized(), -correction() * leaning, scale.cfm);
    const bool stops1 = stopsTurn(joint.axes[0]), stops2 = stopsTurn(joint.axes[1]);
    int stop1 = 0, stop2 = 0;
    double beyond1 = 0, beyond2 = 0;
    if (stops1 || stops2) {
      const Turn cross = Turn::of(crossOf(axis1, axis2));
      const Turn halfRound{0, (axis1 + axis2).normalized()};
      const Turn first = a.turn.inverse() * cross * Turn::of(joint.initialRotationA).inverse();
      const Turn second =
          (b ? b->turn.inverse() : Turn{}) * (halfRound * cross) * Turn::of(joint.initialRotationB).inverse();
      if (stops1) stop1 = stopAt(joint.axes[0], hingeAngle(first, joint.axisA[0]), beyond1);
      if (stops2) stop2 = stopAt(joint.axes[1], -hingeAngle(second, joint.axisB[1]), beyond2);
    }
    addTurningAxis(0, axis1, stop1, beyond1);
    addTurningAxis(1, axis2, stop2, beyond2);
  }

  void writeHinge2() {
    const Vec3 axis1 = inWorldA(joint.axisA[0]), axis2 = inWorldB(joint.axisB[1]);
    const Vec3 a1 = inWorldA(joint.anchorA), a2 = b ? Vec3(b->rotation * joint.anchorB) : Vec3(Vec3::Zero());
    const Vec3 apart = (b ? Vec3(b->position + a2) : joint.anchorB) - a.position - a1;
    Vec3 p, q;
    planeSpace(axis1, p, q);
    addPoint(axis1, a1, a2, scale.perSecond * joint.suspensionErp * axis1.dot(apart), joint.suspensionCfm);
    addPoint(p, a1, a2, correction() * p.dot(apart), scale.cfm);
    addPoint(q, a1, a2, correction() * q.dot(apart), scale.cfm);
    const Vec3 normal = axis1.cross(axis2);
    const double sine = normal.norm(), cosine = axis1.dot(axis2);
    addTurning(normal.normalized(), correction() * (joint.cosAxes * sine - joint.sinAxes * cosine), scale.cfm);
    double beyond = 0;
    int stop = 0;
    if (stopsTurn(joint.axes[0])) {
      const Vec3 seen = a.rotation.transpose() * axis2;
      stop = stopAt(joint.axes[0], -angleOf(joint.planeA[1].dot(seen), joint.planeA[0].dot(seen)), beyond);
    }
    addTurningAxis(0, axis1, stop, beyond);
    addTurningAxis(1, axis2, 0, 0);
  }

  void writeFixed() {
    addBall(joint.erp, joint.cfm);
    addSameRotation();
  }

  void writeUserMotor() {
    for (int i = 0; i < joint.motorAxes; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const Vec3& v = joint.axisA[n];
      const Vec3 axis = joint.frame[n] == 1 ? inWorldA(v) : joint.frame[n] == 2 ? inWorldB(v) : v;
      double beyond = 0;
      const int stop = stopAt(joint.axes[n], joint.angle[n], beyond);
      addTurningAxis(i, axis, stop, beyond);
    }
  }
  void writeEulerMotor() {
    // The first body turns about the first axis, the second about the last; reversed, the other way round.
    const std::size_t mine = joint.reversed ? 2 : 0, other = 2 - mine;
    std::array<Vec3, 3> axis;
    axis[mine] = inWorldA(joint.axisA[mine]);
    axis[other] = inWorldB(joint.axisA[other]);
    axis[1] = axis[2].cross(axis[0]).normalized();
    Vec3 first = inWorldA(joint.reference1), last = inWorldB(joint.reference2);
    if (joint.reversed) std::swap(first, last);
    const Vec3 upon = axis[0].cross(axis[1]);
    const double angles[] = {-angleOf(axis[2].dot(axis[0].cross(first)), axis[2].dot(first)),
                             -angleOf(axis[2].dot(axis[0]), axis[2].dot(upon)),
                             -angleOf(last.dot(axis[1]), last.dot(axis[1].cross(axis[2])))};
    const Vec3 held[] = {axis[1].cross(axis[2]), axis[1], upon};
    for (int i = 0; i < 3; ++i) {
      double beyond = 0;
      const int stop = stopAt(joint.axes[static_cast<std::size_t>(i)], angles[i], beyond);
      addTurningAxis(i, held[i], stop, beyond);
    }
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
        return joint.euler ? writeEulerMotor() : writeUserMotor();
    }
  }
};

}  // namespace

int jointRows(const SolverJoint& joint, Frame& a, Frame* b, const RowScale& scale, Row* out) {
  JointWriter writer{joint, a, b, scale, out};
  writer.write();
  return static_cast<int>(writer.next - out);
}

}  // namespace spark::articulated
