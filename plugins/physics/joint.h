#pragma once
/// \file
/// The base of joints.

#include <functional>

#include "rigid_body.h"

namespace spark {

/// Base of joints. Bodies are given by paths relative to the joint. Anchors and axes are given in the frame of the
/// nearest transform. It is evaluated when they are set, or at attach() when they are set before.
class Joint : public PhysicsObject, public IJoint, public engine::IExtended, public ISceneCalls {
  SPARK_CLASS(Joint, PhysicsObject)
 public:
  static void describe(Description<Joint>& d);

  Leaf& leaf() override { return *this; }
  std::uint64_t identity() const override { return world() ? world()->model().joints[world()->index(joint_)].id : 0; }
  IRigidBody* body(int index) const override { return bodies_[index == 0 ? 0 : 1].get(); }
  int axes() const override;
  Vec3 anchor() const override { return world() ? world()->at(joint_).anchor() : Vec3(Vec3::Zero()); }
  Vec3 axisNow(int axis) const override { return world() ? world()->at(joint_).axis(axis) : Vec3(Vec3::Zero()); }
  double angle(int axis) const override { return world() ? world()->at(joint_).angle(axis) : 0; }
  double sensedAngle(int axis) const override {
    return !world()                       ? 0
           : world()->model().exactReplay ? world()->at(joint_).angleOfPoses(axis)
                                          : world()->at(joint_).angle(axis);
  }
  double angleRate(int axis) const override { return world() ? world()->at(joint_).angleRate(axis) : 0; }
  double parameter(engine::JointParameter p, int axis) const override {
    return world() ? world()->parameter(joint_, p, axis) : 0;
  }
  void setParameter(engine::JointParameter p, int axis, double v) override;
  void drive(int axis, double speed) override {
    if (world()) world()->drive(joint_, axis, speed);
  }
  void control(int axis, const engine::Control& control) override {
    if (world()) world()->control(joint_, axis, control);
  }
  void setWorldAnchor(const Vec3& point) override;
  void setWorldAxis(int axis, const Vec3& direction) override;
  bool atStop(int axis) const override { return world() && world()->at(joint_).atStop(axis); }
  double maxSpeed(int axis) const override { return axis == 0 || axis == 1 ? maxSpeed_[axis] : 0; }
  double feedbackTorque() const override;
  bool feedback() const override { return feedback_; }
  void setBlock(const engine::Block& block) override;
  void removeBlock(std::uint64_t kind) override;
  std::vector<SceneCall> sceneCalls() const override;
  /// The index in the model; kNone when it is not linked or does not act.
  engine::Index index() const { return world() ? world()->index(joint_) : engine::kNone; }

 protected:
  void onLink() override;
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;
  /// Called after the bodies were attached, for settings that depend on their current poses.
  virtual void attached() {}

  /// False: the class is accepted in scenes, but has no effect.
  virtual bool acts() const { return true; }
  /// The world of the joint; nullptr when it is not linked or does not act.
  physics::WorldModel* world() const { return joint_ != physics::JointHandle::none ? world_.get() : nullptr; }
  physics::JointHandle handle() const { return joint_; }
  /// Calls `f` now, or as soon as bodies are attached. For settings that need the places of the bodies.
  template <class F>
  void withBodies(F f) {
    if (!world()) return;
    if (attached_)
      placeBodies(), f();
    else
      pending_.push_back(std::move(f));
  }
  /// Sets the anchor, in the frame of the nearest transform [m]. Throws RefusedValue when it is not finite.
  void setAnchor(const Vec3& local);
  /// Sets the direction of an axis, in the frame of the nearest transform. Throws Error when its length is 0.
  void setAxisLocal(int axis, const Vec3& direction);
  double angleDeg(int axis) const { return radToDeg(angle(axis)); }
  double angleRateDeg(int axis) const { return radToDeg(angleRate(axis)); }
  /// Throws Error unless the joint has the axis.
  void expectAxis(int axis) const;
  void expectAxis(int axis, engine::JointParameter p) const;

 private:
  template <engine::JointParameter P>
  void set(int axis, double v) {
    expectAxis(axis, P);
    setParameter(P, axis, v);
  }
  template <engine::JointParameter P>
  double get(int axis) {
    expectAxis(axis, P);
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
  void expectFinite(const Vec3& anchor) const;
  void expectDirection(const Vec3& direction) const;
  /// Sets an axis to a world direction, with errors that name the joint.
  void turnAxis(int axis, const Vec3& direction);
  void setLocalAxis(int axis, const Vec3& direction) {
    expectAxis(axis);
    setAxisLocal(axis, direction);
  }
  /// Throws Error if the joint is not as its calls leave it: at coordinate 0, with one anchor.
  void expectAsMade() const;
  void addParameterCalls(std::vector<SceneCall>& calls, int axis) const;
  void setSpring(int axis, double stiffness, double position);
  double stiffness(int axis) const;
  double springPosition(int axis) const;
  void setStiffness(int axis, double v) { setSpring(axis, v, springPosition(axis)); }
  void setSpringPosition(int axis, double v) { setSpring(axis, stiffness(axis), v); }
  /// Stiffness and position.
  std::pair<double, double> springOf(int axis) const;
  void setController(int axis, double stiffness, double damping, double position, double velocity, double force,
                     double maxForce);
  void addControllerTerm(int axis, double force, double stiffness, double damping, double least, double most);
  void attach(std::string first, std::string second);
  /// The body at a path relative to the joint; empty, with a warning, when there is none.
  Ref<RigidBody> bodyAt(const std::string& path);
  /// Brings its bodies to where their transforms are: the joint is set in the world, at the places that they have then.
  void placeBodies() const;
  void enableFeedback(bool on);
  double maxSpeed1() const { return maxSpeed_[0]; }
  double maxSpeed2() const { return maxSpeed_[1]; }
  void setMaxSpeed1(double v) { maxSpeed_[0] = std::abs(v); }
  void setMaxSpeed2(double v) { maxSpeed_[1] = std::abs(v); }

  std::shared_ptr<physics::WorldModel> world_;
  physics::JointHandle joint_ = physics::JointHandle::none;
  Ref<RigidBody> bodies_[2];
  std::vector<std::function<void()>> pending_;  ///< anchors and axes that were set before attach(), in that order
  bool attached_ = false;
  engine::Blocks blocks_;
  double maxSpeed_[2] = {0, 0};  ///< rad/s; 0: unlimited
  bool feedback_ = false;
};

}  // namespace spark
