#pragma once
/// \file
/// What acts in MuJoCo alone: actuators that no controller of a joint can be, pairs of colliders with a surface of
/// their own, and what balls and free bodies have beside their coordinates.

#include "api/physics.h"
#include "mujoco_constraints.h"

namespace spark {

namespace mujoco {

/// An actuator (MuJoCo's documentation, "actuator/general"). Points and rotations in the frames of links, or of the
/// world.
struct ActuatorNumbers {
  static constexpr std::string_view kKind = "MujocoActuator";
  static constexpr std::array kTypes{"joint", "jointinparent", "slidercrank", "tendon", "site", "body"};
  static constexpr std::array kDynamics{"none", "integrator", "filter", "muscle"};
  static constexpr std::array kGains{"fixed", "affine", "muscle"}, kBiases{"none", "affine", "muscle"};
  std::int64_t type = 0;                       ///< index of kTypes
  std::uint64_t target = 0, reference = 0;     ///< joint or body; tendon: its number and 1; body of the second point
  std::int64_t ofFreeBody = 0;                 ///< 1: `target` is a body, whose free joint it drives
  std::int64_t lacks = 0;                      ///< 1: the target, 2: the reference is not there
  std::int64_t hasReference = 0;               ///< the second point counts: slider of a crank, frame of a site
  std::int64_t part = 0;                       ///< of a body: index in Body::parts
  std::array<double, 3> point{}, point2{};     ///< site, or crank; its reference, or slider [m]
  std::array<double, 4> rotation{1, 0, 0, 0};  ///< of the site, w x y z
  std::array<double, 4> rotation2{1, 0, 0, 0};
  std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
  double crankLength = 0;                         ///< m
  std::int64_t dynamics = 0, gain = 0, bias = 0;  ///< indices of the names above
  std::array<double, 10> dynamicsNumbers{1};      ///< time constants [s]
  std::array<double, 10> gainNumbers{1}, biasNumbers{};
  std::array<double, 2> controlRange{}, forceRange{}, activationRange{}, lengthRange{};  ///< equal: none
};

/// A pair of colliders with a surface of its own (MuJoCo's documentation, "contact/pair").
struct PairNumbers {
  static constexpr std::string_view kKind = "MujocoPair";
  std::uint64_t first = 0, second = 0;  ///< geoms
  std::int64_t condim = 3;
  std::array<double, 5> friction{1, 1, 0.005, 0.0001, 0.0001};  ///< two of sliding; torsional, two of rolling [m]
  std::array<double, 2> solref{0.02, 1};
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};
  double margin = 0, gap = 0;  ///< m
};

/// A ball, or the six degrees of freedom of a free body (MuJoCo's documentation, "joint").
struct FreedomNumbers {
  static constexpr std::string_view kKind = "MujocoFreedom";
  std::uint64_t of = 0;     ///< joint, or body
  std::int64_t ofBody = 0;  ///< 1: it is a body
  double armature = 0, frictionLoss = 0, stiffness = 0;
  std::array<double, 4> restRotation{1, 0, 0, 0};  ///< where coordinates are 0 and the spring rests, w x y z
  std::array<double, 3> restPosition{};            ///< of a free body's link, world frame [m]
  double mostAngle = 0;                            ///< of a ball from there [rad]; 0: no limit
  std::array<double, 2> stopSolref{0.02, 1}, frictionSolref{0.02, 1};
  std::array<double, 5> stopSolimp{0.9, 0.95, 0.001, 0.5, 2}, frictionSolimp{0.9, 0.95, 0.001, 0.5, 2};
  double stopMargin = 0;  ///< rad
};

}  // namespace mujoco

/// An actuator of MuJoCo.
class MujocoActuator : public MujocoConstraint<mujoco::ActuatorNumbers>, public IActuator {
  SPARK_CLASS(MujocoActuator, Leaf)
 public:
  static void describe(Description<MujocoActuator>& d);
  void setControl(double u) override;

 protected:
  void onLink() override;
  void onUnlink() override;

 private:
  template <auto Member, auto& Names>
  std::string name() const {
    return Names[static_cast<std::size_t>(numbers().*Member)];
  }
  template <auto Member, auto& Names>
  void setName(const std::string& name);
  const std::string& target() const { return target_; }
  const std::string& reference() const { return reference_; }
  void setTarget(const std::string& path) { target_ = path, resolve(); }
  void setReference(const std::string& path) { reference_ = path, resolve(); }
  bool hasReference() const { return numbers().hasReference != 0; }
  void setHasReference(bool on) { set<&mujoco::ActuatorNumbers::hasReference>(on), resolve(); }
  void resolve();
  double control() const { return control_; }

  std::string target_, reference_;
  double control_ = 0;
  engine::IExtendedWorld* world_ = nullptr;
};

/// A pair of colliders that touch with a surface of its own.
class MujocoPair : public MujocoConstraint<mujoco::PairNumbers> {
  SPARK_CLASS(MujocoPair, Leaf)
 public:
  static void describe(Description<MujocoPair>& d);

 protected:
  void onLink() override;

 private:
  const std::string& first() const { return paths_[0]; }
  const std::string& second() const { return paths_[1]; }
  void setFirst(const std::string& path) { paths_[0] = path, resolve(); }
  void setSecond(const std::string& path) { paths_[1] = path, resolve(); }
  void resolve();
  std::array<std::string, 2> paths_;
};

/// What a ball or a free body has beside its coordinates.
class MujocoFreedom : public MujocoConstraint<mujoco::FreedomNumbers> {
  SPARK_CLASS(MujocoFreedom, Leaf)
 public:
  static void describe(Description<MujocoFreedom>& d);

 protected:
  void onLink() override;

 private:
  const std::string& of() const { return path_; }
  void setOf(const std::string& path) { path_ = path, resolve(); }
  void resolve();
  std::string path_;
};

}  // namespace spark
