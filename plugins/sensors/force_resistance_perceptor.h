#pragma once

#include "api/agents.h"
#include "api/local_frame.h"
#include "api/physics.h"

namespace spark {

/// `(FRP (n rf) (c 0.00 -0.02 -0.01) (f 0.00 0.00 22.59))`: where and how strongly the collider beside it was pressed
/// in the last step; says nothing when nothing touched. A TouchPerceptorHandler feeds it after the solver; it is
/// emptied in the prepare phase, before the contacts of the step are found. Point and force are in the frame of its
/// transform (by the local matrix: robots' parts hang in an identity).
class ForceResistancePerceptor : public Perceptor {
  SPARK_CLASS(ForceResistancePerceptor, Perceptor)
 public:
  static void describe(Description<ForceResistancePerceptor>& d) {
    d.doc(
        "Senses the force on the collider beside it and its mean point: (FRP (n name) (c x y z) (f x y z)) in m and N, "
        "only when touched.");
    d.property("point", &ForceResistancePerceptor::point_)
        .unit("m")
        .state()
        .doc("Mean point that was felt last, world frame.");
    d.property("force", &ForceResistancePerceptor::force_)
        .unit("N")
        .state()
        .doc("Force that was felt last, world frame.");
    d.on<&ForceResistancePerceptor::prepare>(phase::kPrepare);
  }

  /// A contact of the step that was just solved: point [m] and force on the body [N], world frame.
  void touch(const Vec3& point, const Vec3& force) {
    const auto size = static_cast<float>(force.norm());
    touched_ = true;
    weight_ += size;
    weightedPoint_ += point.cast<float>() * size;
    sum_ += force.cast<float>();
  }

  void sense(Predicates& out, const Event&) override {
    if (!touched_) return;
    // Contacts of sleeping bodies carry no force: what was felt last is repeated.
    if (weight_ > 0) point_ = weightedPoint_ / weight_, force_ = sum_;

    const Matrix local = transform() ? transform()->local() : Matrix(Matrix::Identity());
    out.open("FRP").pair("n", name());
    put(out, "c", intoFrame(local, point_) - intoFrame(local, positionOf(local)));
    put(out, "f", intoFrame(local, force_));
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
  bool touched_ = false;
  float weight_ = 0;
  Vec3f weightedPoint_ = Vec3f::Zero(), sum_ = Vec3f::Zero();
  Vec3f point_ = Vec3f::Zero(), force_ = Vec3f::Zero();
};

}  // namespace spark
