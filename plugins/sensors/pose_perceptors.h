#pragma once

#include <Eigen/Geometry>

#include "api/agents.h"
#include "api/measurement.h"
#include "api/scene.h"

namespace spark {

/// `(pos (n torso_pos) (p 1.5 0 0.67))`: position of its transform in the world frame [m].
class PositionPerceptor : public Perceptor {
  SPARK_CLASS(PositionPerceptor, Perceptor)
 public:
  static void describe(Description<PositionPerceptor>& d) {
    d.doc("Senses the position of its transform in the world frame: (pos (n name) (p x y z)) in m.");
  }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    out.open("pos").pair("n", messageName()).open("p");
    for (const float v : positionOf(transform()->world())) out.add(double(v));
    out.close().close();
  }
};

/// `(quat (n torso_quat) (q 1 0 0 0))`: orientation of its transform in the world frame, as a unit quaternion w x y z.
class OrientationPerceptor : public Perceptor, public IMeasurement {
  SPARK_CLASS(OrientationPerceptor, Perceptor)
 public:
  static void describe(Description<OrientationPerceptor>& d) {
    d.doc("Senses the rotation of its transform in the world: (quat (n name) (q w x y z)), of length 1.");
    d.implements<IMeasurement>();
  }
  Measured measured() const override { return {Measured::Kind::rotation}; }
  void sense(Predicates& out, const Event&) override {
    if (!transform()) return;
    const Eigen::Quaterniond q(toPose(transform()->world()).rotation);
    out.open("quat").pair("n", messageName()).open("q");
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) out.add(v);
    out.close().close();
  }
};

}  // namespace spark
