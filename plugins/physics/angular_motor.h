#pragma once
/// \file
/// The angular motor of scene files: what drives a joint as a real motor does.

#include "controllers.h"
#include "joints.h"

namespace spark {

class PhysicsServer;

/// Drives the angles between two bodies; below a HingeJoint it drives the hinge's. With a greatest torque it is a
/// modelled motor: the torque that it had in a step says the current, the current what it drew from its battery and how
/// much warmer it got, and these how strong it is in the next step (scene-language section 3.5). Without one its force
/// is what setMaxMotorForce says.
class AngularMotor : public Joint, public IMotor {
  SPARK_CLASS(AngularMotor, Joint)
 public:
  static void describe(Description<AngularMotor>& d);
  engine::JointType jointType() const override { return engine::JointType::angularMotor; }
  double stiffness() const override { return stiffness_; }
  void setStiffness(double fraction) override { stiffness_ = std::clamp(fraction, 0.0, 1.0); }
  double temperature() const override { return temperature_; }
  double current() const override { return current_; }
  bool disabled() const override;

 protected:
  void attached() override { apply(); }
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void apply();
  int numAxes() const { return axes_; }
  void setNumAxes(int n);
  void setMotorAxis(int axis, int frame, const Vec3& direction);
  void setUserMode() { euler_ = false, apply(); }
  void setEulerMode() { euler_ = true, apply(); }
  std::string mode() const { return euler_ ? "euler" : "user"; }
  void setAxisAngle(int axis, double deg);
  double axisAngle(int axis) const;
  double axisAngleRate(int axis) const;
  int axisAnchor(int axis) const;

  const std::string& batteryPath() const { return batteryPath_; }
  void setBatteryPath(std::string path) {
    batteryPath_ = std::move(path);
    battery_.lookAgain();
  }
  bool modelled() const { return maxTorque_ > 0 && engine(); }
  bool tooHot() const { return temperature_ > protectionTemperature_; }
  /// Before the step: as much torque as stiffness, heat and battery leave.
  void prepare(const Event&);
  /// After the step: what it has cost.
  void measure(const Event& event);

  int axes_ = 0, anchors_[3] = {0, 0, 0};
  bool euler_ = false;
  std::string batteryPath_;
  Link<HingeJoint, true> hinge_;
  Link<Battery, true> battery_;
  Link<PhysicsServer, true> server_;
  double speedConstant_ = 4.3, torqueConstant_ = 4.3, resistance_ = 6.44, environment_ = 20, conductivity_ = 0.025,
         heatCapacity_ = 26;
  double protectionTemperature_ = 80, protectionStiffness_ = 0.8, maxTorque_ = 0, stiffness_ = 1, temperature_ = 20;
  double current_ = 0;  ///< A, in the last step
};

}  // namespace spark
