#pragma once
/// \file
/// The joints of scene files.

#include "joint.h"

namespace spark {

/// Base of joints between two bodies.
class Generic6DOFJoint : public Joint {
  SPARK_CLASS(Generic6DOFJoint, Joint)
 public:
  static void describe(Description<Generic6DOFJoint>& d) {
    d.doc("Base of joints between two bodies.");
    d.abstract();
  }
};

/// Allows rotation about one axis.
class HingeJoint : public Generic6DOFJoint {
  SPARK_CLASS(HingeJoint, Generic6DOFJoint)
 public:
  static void describe(Description<HingeJoint>& d) {
    d.doc("Allows rotation about one axis.");
    d.method("setAnchor", &HingeJoint::setAnchor)
        .parameters({"point [m]"})
        .surplusIgnored()
        .doc("Sets a point on the axis, in the joint's frame.");
    d.method("setAxis", &HingeJoint::setAxis)
        .parameters({"0, 1 or 2, or a direction"})
        .doc("Sets the direction of the axis, in the joint's frame: x, y, z as 0, 1, 2, or a vector.");
    d.method("getAnchor", &HingeJoint::anchor).doc("A point on the axis, in the world [m].");
    d.method("getAxis", &HingeJoint::worldAxis).doc("Direction of the axis, in the world.");
    d.method("getAngle", &HingeJoint::degrees).doc("Angle of the first body relative to the second [deg].");
    d.method("getAngleRate", &HingeJoint::degreesPerSecond).doc("Its rate [deg/s].");
  }
  engine::JointType jointType() const override { return engine::JointType::hinge; }

 private:
  void setAxis(std::vector<double> v) {
    if (v.size() == 1 && v[0] >= 0 && v[0] < 3) return setAxisLocal(0, Vec3::Unit(static_cast<int>(v[0])));
    if (v.size() != 3)
      throw Error(fmt::format("{}: expected an axis 0, 1 or 2, or a direction of 3 numbers, found {} numbers", where(),
                              v.size()));
    setAxisLocal(0, {v[0], v[1], v[2]});
  }
  Vec3 worldAxis() const { return axisNow(0); }
  double degrees() const { return angleDeg(0); }
  double degreesPerSecond() const { return angleRateDeg(0); }
};

/// Allows rotation about two axes that stay perpendicular.
class UniversalJoint : public Generic6DOFJoint {
  SPARK_CLASS(UniversalJoint, Generic6DOFJoint)
 public:
  static void describe(Description<UniversalJoint>& d) {
    d.doc("Allows rotation about two axes that stay perpendicular.");
    d.method("setAnchor", &UniversalJoint::setAnchor)
        .parameters({"point [m]"})
        .surplusIgnored()
        .doc("Sets the intersection of the axes, in the joint's frame.");
    d.method("getAnchor", &UniversalJoint::anchor).doc("Intersection of the axes, in the world [m].");
    d.method("setAxis1", &UniversalJoint::setAxis1)
        .parameters({"direction"})
        .surplusIgnored()
        .doc("Sets the first body's axis, in the joint's frame.");
    d.method("setAxis2", &UniversalJoint::setAxis2)
        .parameters({"direction"})
        .surplusIgnored()
        .doc("Sets the second body's axis, in the joint's frame.");
    d.method("getAngle", &UniversalJoint::angleDeg)
        .parameters({"axis"})
        .optional(1)
        .doc("Angle about an axis, 0 or 1 [deg].");
    d.method("getAngleRate", &UniversalJoint::angleRateDeg).parameters({"axis"}).optional(1).doc("Its rate [deg/s].");
  }
  engine::JointType jointType() const override { return engine::JointType::universal; }

 private:
  void setAxis1(const Vec3& v) { setAxisLocal(0, v); }
  void setAxis2(const Vec3& v) { setAxisLocal(1, v); }
};

/// Connects a wheel to a chassis: it steers about z of the joint's frame and rolls about x.
class Hinge2Joint : public Generic6DOFJoint {
  SPARK_CLASS(Hinge2Joint, Generic6DOFJoint)
 public:
  static void describe(Description<Hinge2Joint>& d) {
    d.doc("Connects a wheel to a chassis, with steering and suspension.");
    d.method("setAnchor", &Hinge2Joint::setWheel)
        .parameters({"point [m]"})
        .surplusIgnored()
        .doc("Sets the wheel's centre, in the joint's frame, and the axes: steering about z, rolling about x.");
    d.method("getAnchor", &Hinge2Joint::anchor).doc("Centre of the wheel, in the world [m].");
    d.method("getAngle", &Hinge2Joint::angleDeg)
        .parameters({"axis"})
        .optional(1)
        .doc("Angle about an axis: 0 steering, 1 rolling [deg].");
    d.method("getAngleRate", &Hinge2Joint::angleRateDeg).parameters({"axis"}).optional(1).doc("Its rate [deg/s].");
  }
  engine::JointType jointType() const override { return engine::JointType::hinge2; }

 private:
  void setWheel(const Vec3& at) {
    setAnchor(at);
    setAxisLocal(0, Vec3::UnitZ());
    setAxisLocal(1, Vec3::UnitX());
  }
};

/// Allows rotation about a point.
class BallJoint : public Generic6DOFJoint {
  SPARK_CLASS(BallJoint, Generic6DOFJoint)
 public:
  static void describe(Description<BallJoint>& d) {
    d.doc("Allows rotation about a point.");
    d.method("setAnchor", &BallJoint::setAnchor)
        .parameters({"point [m]"})
        .surplusIgnored()
        .doc("Sets the point, in the joint's frame.");
    d.method("getAnchor", &BallJoint::anchor).doc("The point, in the world [m].");
  }
  engine::JointType jointType() const override { return engine::JointType::ball; }
};

/// Allows translation along z of the joint's frame, as it is when the bodies are attached.
class SliderJoint : public Generic6DOFJoint {
  SPARK_CLASS(SliderJoint, Generic6DOFJoint)
 public:
  static void describe(Description<SliderJoint>& d) {
    d.doc("Allows translation along z of the joint's frame.");
    d.method("getPosition", &SliderJoint::position).doc("Position of the first body relative to the second [m].");
    d.method("getPositionRate", &SliderJoint::positionRate).doc("Its rate [m/s].");
  }
  engine::JointType jointType() const override { return engine::JointType::slider; }

 protected:
  void attached() override { setAxisLocal(0, Vec3::UnitZ()); }

 private:
  double position() const { return angle(0); }
  double positionRate() const { return angleRate(0); }
};

/// Holds two bodies in their relative pose at the time of attach, or of setFixed.
class FixedJoint : public Generic6DOFJoint {
  SPARK_CLASS(FixedJoint, Generic6DOFJoint)
 public:
  static void describe(Description<FixedJoint>& d) {
    d.doc("Holds two bodies in their relative pose.");
    d.method("setFixed", &FixedJoint::attached).doc("Makes the bodies' current relative pose the one to hold.");
  }
  engine::JointType jointType() const override { return engine::JointType::fixed; }

 protected:
  void attached() override {
    if (world()) world()->setFixed(handle());
  }
};

/// Accepted for old scenes; has no effect.
class ConeTwistJoint : public Generic6DOFJoint {
  SPARK_CLASS(ConeTwistJoint, Generic6DOFJoint)
 public:
  static void describe(Description<ConeTwistJoint>& d) { d.doc("Accepted for old scenes; has no effect."); }
  engine::JointType jointType() const override { return engine::JointType::fixed; }

 protected:
  bool acts() const override { return false; }
};

}  // namespace spark
