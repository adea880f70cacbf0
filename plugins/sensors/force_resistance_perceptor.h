#pragma once

#include "api/agents.h"
#include "api/local_frame.h"
#include "api/physics.h"

namespace spark {

/// `(FRP (n rf) (c 0.00 -0.02 -0.01) (f 0.00 0.00 22.59))`: centre of pressure [m] and total contact force [N] of the
/// collider beside it in the last step; no percept when nothing touched. A TouchPerceptorHandler adds contacts after
/// the solver; the prepare phase clears them before the next step. Point and force are in the frame of its transform.
class ForceResistancePerceptor : public Perceptor {
  SPARK_CLASS(ForceResistancePerceptor, Perceptor)
 public:
  static void describe(Description<ForceResistancePerceptor>& d) {
    d.doc(
        "Senses the contact force on the collider beside it and the centre of pressure: (FRP (n name) (c x y z) (f x y "
        "z)) in m and N, only when touched.");
    d.property("point", &ForceResistancePerceptor::point_)
        .unit("m")
        .state()
        .doc("The last measured centre of pressure, world frame.");
    d.property("force", &ForceResistancePerceptor::force_)
        .unit("N")
        .state()
        .doc("The last measured force, world frame.");
    d.on<&ForceResistancePerceptor::prepare>(phase::kPrepare);
  }

  /// Adds a contact of the step that was just solved: point [m] and force on the body [N], world frame.
  void touch(const Vec3& point, const Vec3& force) {
    const auto weight = static_cast<float>(force.norm());
    touched_ = true;
    weight_ += weight;
    weightedPoint_ += point.cast<float>() * weight;
    sum_ += force.cast<float>();
  }

  void sense(Predicates& out, const Event&) override {
    if (!touched_) return;
    // Contacts of sleeping bodies carry no force: the last measured values are repeated.
    if (weight_ > 0) point_ = weightedPoint_ / weight_, force_ = sum_;

    const Matrix here = transform() ? transform()->world() : Matrix(Matrix::Identity());
    out.open("FRP").pair("n", messageName());
    put(out, "c", intoFrame(here, point_) - intoFrame(here, positionOf(here)));
    put(out, "f", intoFrame(here, force_));
    out.close();
  }

 private:
  void prepare(const Event&) {
    touched_ = false;
    weight_ = 0;
    weightedPoint_.setZero();
    sum_.setZero();
  }
  static void put(Predicates& out, std::string_view name, const Vec3f& v) {
    out.open(name);
    for (const float x : v) out.add(x);
    out.close();
  }
  // Contacts of the last step.
  bool touched_ = false;
  float weight_ = 0;                     ///< sum of the magnitudes of the forces [N]
  Vec3f weightedPoint_ = Vec3f::Zero();  ///< sum of magnitude times point [N m]
  Vec3f sum_ = Vec3f::Zero();            ///< sum of the forces [N]
  // The last measured values.
  Vec3f point_ = Vec3f::Zero(), force_ = Vec3f::Zero();
};

}  // namespace spark
