#pragma once

#include "ray_perceptor.h"

namespace spark {

/// `(DST (n front) (d 2.31))`: distance to the first surface along the y axis of its transform [m], by one ray.
class DistancePerceptor : public RayPerceptor {
  SPARK_CLASS(DistancePerceptor, RayPerceptor)
 public:
  static void describe(Description<DistancePerceptor>& d) {
    d.doc("Senses the distance to the first surface in front of it: (DST (n name) (d m)).");
  }
  void sense(Predicates& out, const Event&) override {
    beginMeasuring();
    out.open("DST").pair("n", messageName()).pair("d", distance(cast(Vec3::UnitY()))).close();
  }
};

}  // namespace spark
