#pragma once

#include "api/agents.h"

namespace spark {

/// `(BAT 167184.00)`, named as the node: energy left in the battery above it.
class BatteryPerceptor : public Perceptor {
  SPARK_CLASS(BatteryPerceptor, Perceptor)
 public:
  static void describe(Description<BatteryPerceptor>& d) { d.doc("Senses the energy left in the Battery above it: (name J)."); }
  void sense(Predicates& out, const Event&) override {
    if (power_) out.pair(name(), power_->get(*battery_).toNumber());
  }

 protected:
  void onLink() override {
    Perceptor::onLink();
    lookUp();
  }
  void onMoved() override {
    Perceptor::onMoved();
    lookUp();
  }

 private:
  void lookUp() {
    power_ = nullptr;
    for (battery_ = parent(); battery_ && !battery_->classObject()->isA("Battery"); battery_ = battery_->parent()) {
    }
    const Property* p = battery_ ? battery_->classObject()->property("power") : nullptr;
    if (p && p->get(*battery_).isNumber()) power_ = p;
    if (!power_) kernel().log().warning("{}: expected a Battery above it, found none; it senses nothing. Put it below the battery.", path());
  }
  const Leaf* battery_ = nullptr;
  const Property* power_ = nullptr;
};

}  // namespace spark
