#include "localisation.h"

#include <Eigen/Geometry>
#include <cmath>

namespace humanoid {

namespace {
/// Rotates robot axes to field axes. With heading 0 the robot's forward axis (y) is the field's x.
Eigen::Rotation2Dd rotation(double heading) { return Eigen::Rotation2Dd(heading - kPi / 2); }

constexpr double kTorsoHeight = 0.35;        // of a robot that stands or walks [m]
constexpr double kNod = 0.4, kMaxNod = 0.4;  // fraction of a measured correction; limit [rad]
constexpr double kNear = 25;                 // a single landmark farther away is not used [m]
}  // namespace

Vec3 Localisation::level(const Vec3& inHead, const Percepts& percepts, const Posture& posture) const {
  const Mat3 head = (Eigen::AngleAxisd(percepts.joints[Joint::headYaw], Vec3::UnitZ()) *
                     Eigen::AngleAxisd(percepts.joints[Joint::headPitch], Vec3::UnitX()))
                        .toRotationMatrix();
  return Eigen::AngleAxisd(nod_, Vec3::UnitX()) * (posture.level() * (head * inHead + Vec3(0, 0, kCameraHeight)));
}

/// While a robot walks, the lean estimated from its accelerometer is wrong by several degrees. Landmarks of known
/// height correct it.
void Localisation::findHorizon(const Percepts& percepts, const Posture& posture) {
  double across = 0, along = 0;
  for (const Sighting& s : percepts.sightings) {
    const Vec3 place = level(s.place, percepts, posture);
    across += place.y() * (s.landmark->place.z() - kTorsoHeight - place.z());
    along += place.y() * place.y();
  }
  if (along > 1 && posture.lying() == Lying::no)
    nod_ = std::clamp(nod_ + kNod * std::atan2(across, along), -kMaxNod, kMaxNod);
}

Vec2 Localisation::toField(const Vec2& fromRobot) const { return place_ + rotation(heading_) * fromRobot; }
Vec2 Localisation::toRobot(const Vec2& onField) const { return rotation(heading_).inverse() * (onField - place_); }

void Localisation::update(const Percepts& percepts, const Posture& posture, const Vec2& moved) {
  age_ = std::min(kTrust, age_ + kCycle);
  heading_ = normalized(heading_ + (posture.level() * percepts.gyro).z() * kCycle);
  place_ = toField(moved);
  if (percepts.seeing && !percepts.side.empty()) match(percepts, posture);
}

// Two landmarks or more: least-squares rotation and translation. One: keep the heading and correct the position.
void Localisation::match(const Percepts& percepts, const Posture& posture) {
  findHorizon(percepts, posture);
  const double flip = percepts.side == "right" ? -1 : 1;
  std::vector<std::pair<Vec2, Vec2>> seen;  // relative to the robot; on the field
  Vec2 robotMean = Vec2::Zero(), fieldMean = Vec2::Zero();
  for (const Sighting& s : percepts.sightings) {
    const Vec3 place = level(s.place, percepts, posture);
    seen.emplace_back(place.head<2>(), flip * s.landmark->place.head<2>());
    robotMean += seen.back().first;
    fieldMean += seen.back().second;
  }
  if (seen.empty()) return;
  robotMean /= static_cast<double>(seen.size());
  fieldMean /= static_cast<double>(seen.size());
  if (seen.size() == 1) {
    if (known() && robotMean.norm() < kNear) place_ += 0.1 * (fieldMean - toField(robotMean));
    return;
  }
  double across = 0, along = 0;
  for (const auto& [robot, field] : seen) {
    const Vec2 a = robot - robotMean, b = field - fieldMean;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const double heading = normalized(std::atan2(across, along) + kPi / 2);
  const double share = known() ? 0.4 : 1;
  heading_ = normalized(heading_ + share * normalized(heading - heading_));
  place_ += share * (fieldMean - toField(robotMean));
  age_ = 0;
}

}  // namespace humanoid
