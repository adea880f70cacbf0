#pragma once

#include "api/joint_command.h"

namespace spark {

/// `(force 0 0 10)`: applies a force to the body above it, or else beside it, during the next step [N, world frame].
class ForceEffector : public Effector {
  SPARK_CLASS(ForceEffector, Effector)
 public:
  static void describe(Description<ForceEffector>& d) {
    d.doc(
        "Applies a force to the body above or beside it during one step: (force x y z) in N, world frame. The last "
        "command of a cycle counts.");
    d.link(&ForceEffector::above_, Above<IRigidBody>());
    d.link(&ForceEffector::beside_, BodyAround());
    d.on<&ForceEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "force"; }
  std::string act(const Element& action) override {
    NumberArguments read(action);
    Vec3 force;
    for (int i = 0; i < 3; ++i)
      if (!read(i, force[i])) return read.remark();
    if (!above_ && !beside_) return "expected a body above or beside it, found none";
    force_ = force;
    pending_ = true;
    return read.remark();
  }

 private:
  void prepare(const Event&) {
    if (!pending_) return;
    pending_ = false;
    IRigidBody* const body = above_ ? above_.get() : beside_.get();
    if (!body) return;
    body->enable();
    body->addForce(force_);
  }
  Link<IRigidBody> above_, beside_;
  Vec3 force_ = Vec3::Zero();
  bool pending_ = false;
};

}  // namespace spark
