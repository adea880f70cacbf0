#pragma once
/// \file
/// Where the axes of joints are and how fast they move, from the poses and velocities of their bodies, and how often
/// they have turned.

#include "rotations.h"
#include "world_data.h"

namespace spark::physics {

/// True for the types whose bodies have a common point.
bool hasAnchor(engine::JointType type);

/// The sign of the rate of an axis' angle against the velocity of body a relative to b about the axis.
double angleSign(const engine::Joint& joint, int axis);

/// The kinematics of the joints of a world, by their indices. Angles are those of the first attached body relative to
/// the second. Axes that a joint does not have are at 0. Const functions may be called from several threads, between
/// two steps.
class JointKinematics {
 public:
  /// `world` must outlive it.
  explicit JointKinematics(WorldData& world) : world_(world) {}

  Vec3 anchor(engine::Index joint) const;          ///< world [m]; zero for joints without one
  Vec3 axis(engine::Index joint, int axis) const;  ///< world, unit vector; zero when the joint has no such axis
  /// [rad; slider: m]. Continuous: see engine::JointCoordinates.
  double angle(engine::Index joint, int axis) const;
  /// The same within one turn, -pi..pi, as its poses have it.
  double angleOfPoses(engine::Index joint, int axis) const;
  double rate(engine::Index joint, int axis) const;  ///< of the angle [rad/s; slider: m/s]
  /// The same without rounding as the installed base rounds.
  double exactRate(engine::Index joint, int axis) const;
  /// True when the axis is at one of its stops or beyond.
  bool atStop(engine::Index joint, int axis) const;
  /// World direction of an axis that the joint has.
  Vec3 worldAxis(const engine::Joint& joint, int axis) const;

  /// The continuous angle as the stops count it, for load() [rad]; 0 for axes that count no turns.
  double coordinate(engine::Index joint, int axis) const;
  /// Restores the turns of an axis.
  void load(engine::Index joint, int axis, double angle);
  /// A joint was set or attached: its turns are counted from the angle of its poses.
  void restart(engine::Index joint);
  /// Before a step: counts the turns of poses that were set since the last one.
  void begin();
  /// After a step.
  void countTurns();
  /// A joint was added at the end.
  void add();
  /// Joints were removed: see physics::renumber().
  void renumber(const std::vector<engine::Index>& now);

 private:
  /// The angle of a hinge [rad].
  struct HingeAngle {
    double ofPoses = 0;     ///< as angleOfPoses() has it
    double continuous = 0;  ///< as angle() has it
  };
  /// That angle, because effectors and sensors read the same number. It is valid while `at` is WorldData::poses.
  /// Sensors read and write it in several threads.
  struct CachedAngle {
    HingeAngle angle;
    std::uint64_t at = 0;
  };
  /// A joint that counts turns, and what its angle depends on: the joints of a model are too large to be read in each
  /// step.
  struct Turning {
    engine::Index joint, a, b;
    std::uint32_t versionA = 0, versionB = 0;  ///< of the bodies' states, the last time; 0: before, and of the world
    bool due = true;  ///< its bodies have moved since its turns were counted, which waits while both sleep
    int axes = 0;
    double hinge = 0;  ///< of a hinge: the sign of its AxisView; 0: another joint
    Quaternion rotation;
    Vec3 axis;  ///< as the rotation, of the hinge's frame in a
  };
  /// The axis and the sign by which the angle of an axis is that of a stop; see Joint::reversed.
  struct AxisView {
    int axis;
    double sign;
  };
  const engine::Model& model() const { return world_.model; }
  const engine::State& state() const { return world_.state; }
  engine::State& state() { return world_.state; }
  AxisView viewOf(const engine::Joint& joint, int axis) const;
  /// The angle of a rotational axis within one turn, as its stops count it.
  double rawAngle(engine::Index joint, int axis) const;
  /// The turns of an axis, at the present poses.
  std::int32_t turnsNow(engine::Index joint, int axis, double raw) const;
  /// Sets the turns of an axis, and counts them in State::turned.
  void setTurns(engine::JointCoordinates& c, int axis, std::int32_t turns);
  void listTurning();
  /// Counts the turns of joints with a body that is awake. `stepped`: all of these may have moved.
  void count(bool stepped);
  std::array<Vec3, 3> eulerAxes(const engine::Joint& joint) const;
  double eulerAngle(const engine::Joint& joint, int axis) const;
  /// True while the angle of a hinge is known; never of another joint.
  bool isCached(engine::Index joint) const;
  HingeAngle hingeAngle(engine::Index joint) const;
  double universalAngle(const engine::Joint& joint, int axis) const;
  double sliderPosition(const engine::Joint& joint) const;
  double hinge2Angle(const engine::Joint& joint, int axis) const;

  WorldData& world_;
  mutable std::vector<CachedAngle> cached_;  ///< by joint
  std::vector<Turning> turning_;             ///< valid for turningAt_, a version of the structure
  std::uint64_t turningAt_ = 0;
  std::uint64_t countedAt_ = 0;  ///< WorldData::poses when turns were counted last
};

}  // namespace spark::physics
