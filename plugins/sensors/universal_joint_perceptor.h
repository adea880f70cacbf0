#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(UJ (n laj1_2) (ax1 0.50) (ax2 -3.20))`: both angles of the universal joint above it, degrees.
class UniversalJointPerceptor : public Perceptor {
  SPARK_CLASS(UniversalJointPerceptor, Perceptor)
 public:
  static void describe(Description<UniversalJointPerceptor>& d) {
    d.doc("Senses both angles of the universal joint above it: (UJ (n name) (ax1 deg) (ax2 deg)).");
  }
  void sense(Predicates& out, const Event&) override {
    if (!joint_) return;
    out.open("UJ").pair("n", name());
    out.pair("ax1", radToDeg(joint_->angle(0))).pair("ax2", radToDeg(joint_->angle(1))).close();
  }

 protected:
  void onLink() override {
    Perceptor::onLink();
    joint_ = jointAbove(*this, engine::JointType::universal, "UniversalJoint");
  }
  void onMoved() override {
    Perceptor::onMoved();
    joint_ = jointAbove(*this, engine::JointType::universal, "UniversalJoint");
  }

 private:
  IJoint* joint_ = nullptr;
};

}  // namespace spark
