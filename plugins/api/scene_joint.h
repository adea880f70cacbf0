#pragma once
/// \file
/// What the scene language of the installed base says of a joint beyond the model: numbers and calls in the terms of
/// the ODE manual. Blocks of Model::Extensions::sceneJoints; engines that are not soft, or take joints by their frames,
/// do not read them.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "api/model.h"
#include "spark/abi/api/scene_joint.h"

namespace spark::engine {

/// Names of the parameters of one axis of a joint: see JointAxis. The suspension parameters belong to axis 0 of hinge2.
enum class JointParameter {
  lowStop,
  highStop,
  velocity,
  maxForce,
  fudgeFactor,
  bounce,
  cfm,
  stopErp,
  stopCfm,
  suspensionErp,
  suspensionCfm,
  armature,
  damping,
  dryFriction
};

/// How soft a joint is, its motors and stops; names as in the section "Stop and motor parameters" of the ODE manual.
/// Every joint has one.
struct JointSoftness {
  static constexpr std::string_view kKind = "JointSoftness";
  struct Axis {
    double fudgeFactor = 1;  ///< 0..1: scales a motor that drives away from the stop it is at
    double bounce = 0;       ///< restitution of the stops, 0..1
    double cfm = 0;          ///< of the motor's row [velocity / force]
    double stopErp = 0;      ///< of the stops' row, 0..1
    double stopCfm = 0;      ///< of the stops' row [velocity / force]
  };
  std::array<Axis, 3> axes;
  double erp = 0.2, cfm = 1e-5;                 ///< ball and fixed: of the anchor's rows; other rows use the world's
  double suspensionErp = 0, suspensionCfm = 0;  ///< hinge2: of the row along axis 0
};

/// That of all joints of a model, by their indices. For ISolver::compile().
inline void readSoftness(const Model& model, std::vector<JointSoftness>& out) {
  out.clear();
  for (const Blocks& b : model.extensions.sceneJoints) out.push_back(b.get<JointSoftness>());
}

/// One call that set a joint, with the places of its bodies at that time. In exact replay an engine that takes joints
/// in world coordinates repeats them in the order of the blocks, motors first; the number of a block is numberOf(). Of
/// each kind and axis there is the last one.
struct JointCall {
  static constexpr std::string_view kKind = "JointCall";
  enum Kind : std::int64_t { anchor, setAxis, setMotor, setAngle, setFixed };
  struct Place {
    std::array<double, 3> position{};
    std::array<double, 4> quaternion{1, 0, 0, 0};
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< by columns
  };
  std::int64_t kind = anchor;
  std::int64_t axis = 0;          ///< of setAxis and setAngle; number of axes of setMotor
  std::int64_t frame = 0;         ///< of setAxis: as AngularMotor::frame; setMotor: 1 in Euler mode
  std::array<double, 3> world{};  ///< point [m] or direction; angle [rad] in [0]
  Place a, b;                     ///< of the bodies of the joint; of the world its origin
  /// Of the block of a call.
  int numberOf() const { return static_cast<int>(kind == setAxis || kind == setAngle ? 3 * kind + axis : 3 * kind); }
  static constexpr int kNumbers = 15;
};

}  // namespace spark::engine
