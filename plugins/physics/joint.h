#pragma once
/// \file
/// Joints.

#include <functional>

#include "rigid_body.h"

namespace spark {

/// Base of joints. Anchors and axes are given in the frame of the nearest transform, as it is when they are set, or,
/// when they are set before the bodies are attached, as it is then; bodies by paths relative to the joint.
class Joint : public PhysicsObject, public IJoint {
  SPARK_CLASS(Joint, PhysicsObject)
 public:
  static void describe(Description<Joint>& d);

  Leaf& leaf() override { return *this; }
  IRigidBody* body(int index) const override { return bodies_[index == 0 ? 0 : 1].get(); }
  int axes() const override;
  Vec3 anchor() const override { return engine() ? engine()->anchor(joint_) : Vec3(Vec3::Zero()); }
  Vec3 axisNow(int axis) const override { return engine() ? engine()->axis(joint_, axis) : Vec3(Vec3::Zero()); }
  double angle(int axis) const override { return engine() ? engine()->angle(joint_, axis) : 0; }
  double angleRate(int axis) const override { return engine() ? engine()->angleRate(joint_, axis) : 0; }
  double parameter(engine::JointParameter p, int axis) const override {
    return engine() ? engine()->parameter(joint_, p, axis) : 0;
  }
  void setParameter(engine::JointParameter p, int axis, double v) override;
  void drive(int axis, double speed) override {
    if (engine()) engine()->drive(joint_, axis, speed);
  }
  bool atStop(int axis) const override { return engine() && engine()->atStop(joint_, axis); }
  double maxSpeed(int axis) const override { return axis == 0 || axis == 1 ? maxSpeed_[axis] : 0; }
  double feedbackTorque() const override;
  bool feedback() const override { return feedback_; }

 protected:
  void onLink() override;
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;
  /// The bodies are attached: what the joint takes from how they stand now.
  virtual void attached() {}

  /// False: the joint is accepted, but holds nothing.
  virtual bool acts() const { return true; }
  /// The engine that has the joint; nullptr when there is none.
  engine::IEngine* engine() const { return joint_ != engine::Joint::none ? world_->engine() : nullptr; }
  engine::Joint handle() const { return joint_; }
  /// Does now, or as soon as the bodies are attached, what an engine can only do with bodies.
  template <class F>
  void withBodies(F f) {
    if (!engine()) return;
    if (attached_)
      f();
    else
      waiting_.push_back(std::move(f));
  }
  void setAnchor(const Vec3& local);
  /// `direction` in the joint's frame.
  void setAxisLocal(int axis, const Vec3& direction);
  double angleDeg(int axis) const { return radToDeg(angle(axis)); }
  double angleRateDeg(int axis) const { return radToDeg(angleRate(axis)); }
  /// Throws Error unless the joint has that axis.
  void expectAxis(int axis) const;

 private:
  template <engine::JointParameter P>
  void set(int axis, double v) {
    expectAxis(axis);
    setParameter(P, axis, v);
  }
  template <engine::JointParameter P>
  double get(int axis) {
    expectAxis(axis);
    return parameter(P, axis);
  }
  template <engine::JointParameter P>
  void setDeg(int axis, double deg) {
    expectAxis(axis);
    setParameter(P, axis, degToRad(deg));
  }
  template <engine::JointParameter P>
  double getDeg(int axis) {
    expectAxis(axis);
    return radToDeg(parameter(P, axis));
  }
  void attach(std::string first, std::string second);
  Ref<RigidBody> bodyAt(const std::string& path);
  void enableFeedback(bool on);
  double maxSpeed1() const { return maxSpeed_[0]; }
  double maxSpeed2() const { return maxSpeed_[1]; }
  void setMaxSpeed1(double v) { maxSpeed_[0] = std::abs(v); }
  void setMaxSpeed2(double v) { maxSpeed_[1] = std::abs(v); }

  std::shared_ptr<physics::WorldHandle> world_;
  engine::Joint joint_{};
  Ref<RigidBody> bodies_[2];
  std::vector<std::function<void()>> waiting_;  ///< anchors and axes that were set before attach, in that order
  bool attached_ = false;
  double maxSpeed_[2] = {0, 0};
  bool feedback_ = false;
};

}  // namespace spark
