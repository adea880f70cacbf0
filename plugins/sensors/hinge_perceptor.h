#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(HJ (n hj1) (ax -1.15))`: angle of the hinge above it, degrees.
class HingePerceptor : public Perceptor {
  SPARK_CLASS(HingePerceptor, Perceptor)
 public:
  static void describe(Description<HingePerceptor>& d) {
    d.doc("Senses the angle of the hinge joint above it: (HJ (n name) (ax deg)).");
  }
  /// Half of what robots sense: left to itself the compiler makes a call of each token.
  [[gnu::flatten]] void sense(Predicates& out, const Event&) override {
    if (!joint_) return;
    out.open("HJ").pair("n", name()).pair("ax", radToDeg(joint_->angle(0))).close();
  }

 protected:
  void onLink() override {
    Perceptor::onLink();
    joint_ = jointAbove(*this, engine::JointType::hinge, "HingeJoint");
  }
  void onMoved() override {
    Perceptor::onMoved();
    joint_ = jointAbove(*this, engine::JointType::hinge, "HingeJoint");
  }

 private:
  IJoint* joint_ = nullptr;
};

}  // namespace spark
