#include "posture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace humanoid {

namespace {
constexpr double kTrust = 0.03;    // weight of the accelerometer in each cycle
constexpr double kSteadyBand = 3;  // the accelerometer is used when it measures gravity within this band [m/s^2]
constexpr double kGravity = 9.81;  // m/s^2
}  // namespace

void Posture::update(const Percepts& percepts) {
  up_ -= percepts.gyro.cross(up_) * kCycle;
  const double size = percepts.acceleration.norm();
  if (std::abs(size - kGravity) < kSteadyBand) up_ += (percepts.acceleration / size - up_) * kTrust;
  if (!up_.allFinite() || up_.norm() < 1e-6) up_ = Vec3(0, 0, 1);
  up_.normalize();
}

// When the robot leans forward, the vertical points towards its back.
double Posture::forward() const { return std::atan2(-up_.y(), up_.z()); }
double Posture::right() const { return std::atan2(-up_.x(), up_.z()); }
double Posture::tilt() const { return std::acos(std::clamp(up_.z(), -1.0, 1.0)); }

Lying Posture::lying() const {
  if (tilt() < radians(60)) return Lying::no;
  if (std::abs(up_.x()) > std::abs(up_.y())) return Lying::onSide;
  return up_.y() < 0 ? Lying::onFront : Lying::onBack;
}

// The shortest rotation; upside down any half turn.
Mat3 Posture::level() const {
  const Vec3 axis = up_.cross(Vec3::UnitZ());
  if (axis.norm() < 1e-9) return up_.z() > 0 ? Mat3(Mat3::Identity()) : Mat3(Vec3(1, -1, -1).asDiagonal());
  return Eigen::AngleAxisd(tilt(), axis.normalized()).toRotationMatrix();
}

}  // namespace humanoid
