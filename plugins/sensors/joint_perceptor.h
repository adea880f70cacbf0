#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(HJ (n q_hj1) (ax -1.15) (vx 0.5))`: angle [deg] and rate [deg/s] of the hinge above it; of a slider m and m/s.
class JointPerceptor : public Perceptor {
  SPARK_CLASS(JointPerceptor, Perceptor)
 public:
  static void describe(Description<JointPerceptor>& d) {
    d.doc("Senses angle and rate of the joint above it: (HJ (n name) (ax deg) (vx deg/s)); of a slider m and m/s.");
    d.property("reference", &JointPerceptor::reference_)
        .unit("rad")
        .doc("Angle in messages where the joint's is 0; on a slider m.");
    d.link(&JointPerceptor::joint_, Above<IJoint>()).required(kNoJointAbove);
  }
  void sense(Predicates& out, const Event&) override {
    IJoint* const joint = joint_.get();
    if (!joint) return;
    const double unit = joint->jointType() == engine::JointType::slider ? 1 : radToDeg(1);
    out.open("HJ")
        .pair("n", messageName())
        .pair("ax", unit * (joint->angle(0) + reference_))
        .pair("vx", unit * joint->angleRate(0))
        .close();
  }

 private:
  Link<IJoint> joint_;
  double reference_ = 0;
};

}  // namespace spark
