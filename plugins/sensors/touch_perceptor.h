#pragma once

#include "api/measurement.h"
#include "collision_perceptor.h"

namespace spark {

/// `(TCH (n lf) (val 1))`: 1 when a collider touched since the last percept, else 0.
class TouchPerceptor : public CollisionPerceptor, public IMeasurement {
  SPARK_CLASS(TouchPerceptor, CollisionPerceptor)
 public:
  static void describe(Description<TouchPerceptor>& d) {
    d.doc("Senses whether its transform's colliders were touched: (TCH (n name) (val 0 or 1)).");
    d.implements<IMeasurement>();
  }
  Measured measured() const override { return {Measured::Kind::numbers, 0, 1}; }
  void sense(Predicates& out, const Event&) override {
    out.open("TCH").pair("n", messageName()).pair("val", wasTouched() ? 1 : 0).close();
    clear();
  }
};

}  // namespace spark
