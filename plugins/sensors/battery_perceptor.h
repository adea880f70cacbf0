#pragma once

#include "api/agents.h"

namespace spark {

/// `(BAT 0.75)`, named as the node: state of charge of the battery above it, its energy over its capacity.
class BatteryPerceptor : public Perceptor {
  SPARK_CLASS(BatteryPerceptor, Perceptor)
 public:
  static void describe(Description<BatteryPerceptor>& d) {
    d.doc("Senses the state of charge of the Battery above it: (name part), 0..1.");
  }
  void sense(Predicates& out, const Event&) override {
    if (!power_ || !capacity_) return;
    const double capacity = capacity_->get(*battery_).toNumber();
    out.pair(name(), capacity > 0 ? power_->get(*battery_).toNumber() / capacity : 0.0);
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
    for (battery_ = parent(); battery_ && !battery_->classObject()->isA("Battery"); battery_ = battery_->parent()) {
    }
    power_ = number("power");
    capacity_ = number("capacity");
    if (!power_ || !capacity_)
      kernel().log().warning(
          "{}: expected a Battery above it, found none; it senses nothing. Put it below the battery.", path());
  }
  const Property* number(const char* property) const {
    const Property* p = battery_ ? battery_->classObject()->property(property) : nullptr;
    return p && p->get(*battery_).isNumber() ? p : nullptr;
  }
  const Leaf* battery_ = nullptr;
  const Property* power_ = nullptr;
  const Property* capacity_ = nullptr;
};

}  // namespace spark
