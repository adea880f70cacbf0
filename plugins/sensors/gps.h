#pragma once

#include "api/agents.h"
#include "api/measurement.h"

namespace spark {

/// `(GPS (n torso) (tf m00 m01 ... m33))`: world matrix of its transform, row-major.
class GPS : public Perceptor, public IMeasurement {
  SPARK_CLASS(GPS, Perceptor)
 public:
  static void describe(Description<GPS>& d) {
    d.doc("Senses the world matrix of its transform, row-major: (GPS (n name) (tf m00 m01 ... m33)).");
    d.implements<IMeasurement>();
  }
  Measured measured() const override { return {Measured::Kind::pose}; }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    const Matrix& world = transform()->world();
    out.open("GPS").pair("n", messageName()).open("tf");
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) out.add(double(world(row, column)));
    out.close().close();
  }
};

}  // namespace spark
