#pragma once
/// \file
/// The angular motor of scene files, with an optional model of a real motor.

#include "controllers.h"
#include "joints.h"

namespace spark {

class PhysicsServer;

/// Drives the angles between two bodies; below a HingeJoint it drives the hinge's angle.
///
/// With a `maxTorque` above 0 it models a DC motor (scene-language section 3.5). After each step the measured torque
/// gives the current, and the current gives the energy drawn from the battery and the heating of the winding. Before
/// the next step stiffness, temperature and battery limit the torque. Without a `maxTorque` its torque is limited by
/// setMaxMotorForce alone.
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
  std::vector<SceneCall> sceneCalls() const override;
  std::vector<std::string_view> setByCalls() const override { return {"numAxes"}; }

 protected:
  void attached() override { apply(); }
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  /// Passes number of axes and mode to the model.
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
  bool modelled() const { return maxTorque_ > 0 && world(); }
  bool tooHot() const { return temperature_ > protectionTemperature_; }
  /// Before the step: sets the maximum torque from stiffness, temperature and battery.
  void prepare(const Event&);
  /// After the step: updates current, battery and temperature.
  void measure(const Event& event);

  int axes_ = 0;
  int frames_[3] = {0, 0, 0};  ///< of each axis: 0 world, 1 first body, 2 second body
  bool euler_ = false;
  std::string batteryPath_;
  Link<HingeJoint, true> hinge_;
  Link<Battery, true> battery_;
  Link<PhysicsServer, true> server_;
  double speedConstant_ = 4.3;         ///< back EMF per speed [V s/rad]
  double torqueConstant_ = 4.3;        ///< Nm/A
  double resistance_ = 6.44;           ///< Ohm
  double environment_ = 20;            ///< deg C
  double conductivity_ = 0.025;        ///< W/K
  double heatCapacity_ = 26;           ///< J/K
  double protectionTemperature_ = 80;  ///< deg C
  double protectionStiffness_ = 0.8;   ///< limit of the stiffness above that temperature, 0..1
  double maxTorque_ = 0;               ///< Nm; 0: not modelled
  double stiffness_ = 1;               ///< 0..1
  double temperature_ = 20;            ///< deg C
  double current_ = 0;                 ///< in the last step [A]
};

}  // namespace spark
