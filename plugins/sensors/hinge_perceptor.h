#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(HJ (n hj1) (ax -1.15))`: angle of the hinge above it [deg].
class HingePerceptor : public Perceptor {
  SPARK_CLASS(HingePerceptor, Perceptor)
 public:
  static void describe(Description<HingePerceptor>& d) {
    d.doc("Senses the angle of the hinge joint above it: (HJ (n name) (ax deg)).");
    d.link(&HingePerceptor::joint_, JointAbove<engine::JointType::hinge>("HingeJoint")).required(kNoJointAbove);
  }
  /// Flattened, because half of all percepts of a robot are made here and the compiler would not inline the tokens.
  [[gnu::flatten]] void sense(Predicates& out, const Event&) override {
    IJoint* const joint = joint_.get();
    if (!joint) return;
    out.open("HJ").pair("n", messageName()).pair("ax", radToDeg(joint->sensedAngle(0))).close();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
