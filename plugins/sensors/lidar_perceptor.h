#pragma once

#include <cmath>

#include "ray_perceptor.h"

namespace spark {

/// `(LDR (n scan) (d 2.31 2.30 ...))`: distances to the first surface [m] in a fan of `rays` directions, which are
/// spread evenly over `fov`, from right to left, in the plane of x and y of its transform. The middle of the fan is the
/// y axis. A fan of 360 degrees begins behind the sensor and does not repeat that direction at its end.
class LidarPerceptor : public RayPerceptor {
  SPARK_CLASS(LidarPerceptor, RayPerceptor)
 public:
  static void describe(Description<LidarPerceptor>& d) {
    using L = LidarPerceptor;
    d.doc("Senses distances in a fan of directions, from right to left: (LDR (n name) (d m m ...)).");
    d.property("rays", &L::rays_).range(1, 4096).doc("Number of directions.");
    d.property("fov", &L::fovDeg_).unit("deg").range(0, 360).doc("Angle between the first and the last direction.");
  }
  void sense(Predicates& out, const Event&) override {
    beginMeasuring();
    const double fov = degToRad(fovDeg_);
    const int gaps = fovDeg_ < 360 ? rays_ - 1 : rays_;
    const double step = gaps > 0 ? fov / gaps : 0, first = gaps > 0 ? -fov / 2 : 0;
    out.open("LDR").pair("n", messageName()).open("d");
    for (int i = 0; i < rays_; ++i) {
      const double angle = first + i * step;  // from the y axis, positive to the left
      out.add(distance(cast({-std::sin(angle), std::cos(angle), 0})));
    }
    out.close().close();
  }

 private:
  int rays_ = 64;
  double fovDeg_ = 240;
};

}  // namespace spark
