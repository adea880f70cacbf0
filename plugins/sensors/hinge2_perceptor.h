#pragma once

#include "api/joint_above.h"

namespace spark {

/// `(H2J (n wheel) (ax 0 12.50))`: steering angle of the hinge2 above it, degrees. The 0 is the axis.
class Hinge2Perceptor : public Perceptor {
  SPARK_CLASS(Hinge2Perceptor, Perceptor)
 public:
  static void describe(Description<Hinge2Perceptor>& d) {
    d.doc("Senses the first angle of the hinge2 joint above it: (H2J (n name) (ax 0 deg)).");
  }
  void sense(Predicates& out, const Event&) override {
    if (!joint_) return;
    out.open("H2J").pair("n", name());
    out.open("ax").add(0).add(radToDeg(joint_->angle(0))).close().close();
  }

 protected:
  void onLink() override {
    Perceptor::onLink();
    joint_ = jointAbove(*this, engine::JointType::hinge2, "Hinge2Joint");
  }
  void onMoved() override {
    Perceptor::onMoved();
    joint_ = jointAbove(*this, engine::JointType::hinge2, "Hinge2Joint");
  }

 private:
  IJoint* joint_ = nullptr;
};

}  // namespace spark
