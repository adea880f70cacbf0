#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(UJ (n laj1_2) (ax1 0.50) (ax2 -3.20))`: both angles of the universal joint above it [deg].
class UniversalJointPerceptor : public Perceptor {
  SPARK_CLASS(UniversalJointPerceptor, Perceptor)
 public:
  static void describe(Description<UniversalJointPerceptor>& d) {
    d.doc("Senses both angles of the universal joint above it: (UJ (n name) (ax1 deg) (ax2 deg)).");
    d.link(&UniversalJointPerceptor::joint_, JointAbove<engine::JointType::universal>("UniversalJoint"))
        .required(kNoJointAbove);
  }
  void sense(Predicates& out, const Event&) override {
    IJoint* const joint = joint_.get();
    if (!joint) return;
    out.open("UJ").pair("n", messageName());
    out.pair("ax1", radToDeg(joint->sensedAngle(0))).pair("ax2", radToDeg(joint->sensedAngle(1))).close();
  }

 private:
  Link<IJoint> joint_;
};

}  // namespace spark
