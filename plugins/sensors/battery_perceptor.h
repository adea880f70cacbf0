#pragma once

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// `(BAT 0.75)`, named as the node: state of charge of the battery above it, its energy over its capacity.
class BatteryPerceptor : public Perceptor {
  SPARK_CLASS(BatteryPerceptor, Perceptor)
 public:
  static void describe(Description<BatteryPerceptor>& d) {
    d.doc("Senses the state of charge of the Battery above it: (name part), 0..1.");
  }
  void sense(Predicates& out, const Event&) override {
    if (!battery_) return;
    const double capacity = battery_->capacity();
    out.pair(name(), capacity > 0 ? battery_->power() / capacity : 0.0);
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
    battery_ = ancestor<IBattery>();
    if (!battery_)
      kernel().log().warning(
          "{}: expected a Battery above it, found none; it senses nothing. Put it below the battery.", path());
  }
  const IBattery* battery_ = nullptr;
};

}  // namespace spark
