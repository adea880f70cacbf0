#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(H2J (n wheel) (ax 0 12.50))`: steering angle of the hinge2 above it [deg]. The 0 is the number of the axis.
class Hinge2Perceptor : public Perceptor {
  SPARK_CLASS(Hinge2Perceptor, Perceptor)
 public:
  static void describe(Description<Hinge2Perceptor>& d) {
    d.doc("Senses the first angle of the hinge2 joint above it: (H2J (n name) (ax 0 deg)).");
    d.link(&Hinge2Perceptor::joint_, JointAbove<engine::JointType::hinge2>("Hinge2Joint")).required(kNoJointAbove);
  }
  void sense(Predicates& out, const Event&) override {
    IJoint* const joint = joint_.get();
    if (!joint) return;
    out.open("H2J").pair("n", messageName());
    out.open("ax").add(0).add(radToDeg(joint->sensedAngle(0))).close().close();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
