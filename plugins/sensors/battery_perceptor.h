#pragma once

#include "api/agents.h"
#include "api/measurement.h"
#include "api/physics.h"

namespace spark {

/// `(BAT 0.75)`, with the node's name as predicate: state of charge of the battery above it, energy / capacity.
class BatteryPerceptor : public Perceptor, public IMeasurement {
  SPARK_CLASS(BatteryPerceptor, Perceptor)
 public:
  static void describe(Description<BatteryPerceptor>& d) {
    d.doc("Senses the state of charge of the Battery above it: (name fraction), 0..1.");
    d.link(&BatteryPerceptor::battery_, Above<IBattery>()).required("It senses nothing. Put it below a Battery.");
    d.implements<IMeasurement>();
  }
  Measured measured() const override { return {Measured::Kind::numbers, 0, 1}; }
  void sense(Predicates& out, const Event&) override {
    const IBattery* const battery = battery_.get();
    if (!battery) return;
    const double capacity = battery->capacity();
    out.pair(messageName(), capacity > 0 ? battery->power() / capacity : 0.0);
  }

 private:
  Link<IBattery> battery_;
};

}  // namespace spark
