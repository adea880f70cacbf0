#pragma once

#include "collision_perceptor.h"

namespace spark {

/// `(TCH (n lf) (val 1))`: 1 when anything touched since it last sensed, else 0.
class TouchPerceptor : public CollisionPerceptor {
  SPARK_CLASS(TouchPerceptor, CollisionPerceptor)
 public:
  static void describe(Description<TouchPerceptor>& d) {
    d.doc("Senses whether anything touched its transform's colliders: (TCH (n name) (val 0 or 1)).");
  }
  void sense(Predicates& out, const Event&) override {
    out.open("TCH").pair("n", name()).pair("val", wasTouched() ? 1 : 0).close();
    forget();
  }
};

}  // namespace spark
