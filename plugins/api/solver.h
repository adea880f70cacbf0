#pragma once
/// \file
/// ISolver: a constraint solver that replaces the engine's own.
///
/// The engine keeps bodies, joints and geoms and detects contacts. If its child `solver` implements ISolver, the engine
/// hands it the world as plain data in each step. The solver steps the islands that it can handle and defers the others
/// to the engine's own solver.
///
/// Time stepping is at the velocity level with soft constraints, as in ODE (Smith, ODE manual, "Concepts"). A joint or
/// contact is a set of scalar rows
///
///     J v + cfm * force = target velocity,     low <= force <= high,
///
/// and the target velocity of a row with the position error e [m or rad] is erp / dt * e. How a joint type becomes rows
/// is up to the solver; this header defines what the joint's numbers mean. SI units and radians.

#include <array>
#include <span>

#include "api/engine.h"
#include "spark/abi/api/solver.h"

namespace spark::engine {

/// A body. The engine owns it and the memory that its pointers refer to; both live as long as the body. Vectors are x y
/// z in the world frame.
struct SolverBody {
  double* position = nullptr;         ///< 3 elements [m], of the centre of mass; in and out
  double* quaternion = nullptr;       ///< 4 elements, w x y z, body to world, of length 1; in and out
  double* rotation = nullptr;         ///< 3 rows of 4 elements, the 4th unused: the same as a matrix; in and out
  double* linearVelocity = nullptr;   ///< 3 elements [m/s], of the centre of mass; in and out
  double* angularVelocity = nullptr;  ///< 3 elements [rad/s]; in and out
  double* force = nullptr;            ///< 3 elements [N], accumulated for this step; the solver clears it
  double* torque = nullptr;           ///< 3 elements [Nm], accumulated for this step; the solver clears it
  bool gravity = true;                ///< the world's gravity acts on the body
  bool gyroscopic = true;             ///< gyroscopic torque acts on the body, integrated implicitly
  bool awake = true;                  ///< in: the body's island is stepped; out: true for all bodies that were stepped
  bool deferred = false;              ///< out: the body's island is deferred to the engine and the body is unchanged
  std::uint32_t index = 0;            ///< position in SolverStep::bodies
  double mass = 1;                    ///< kg, above 0
  /// Inertia about the centre of mass [kg m^2] and its inverse, body frame; positive definite.
  Mat3 inertia = Mat3::Identity(), inverseInertia = Mat3::Identity();
};

/// Motor and stops of one axis of a joint (see JointParameter). Angles and velocities are those of body a relative to
/// b. A motor is off when maxForce is 0. Stops with lowStop above highStop have no effect, except on angular motors.
/// Forces are in N for sliders, in Nm for rotation.
struct SolverAxis {
  double lowStop = -HUGE_VAL, highStop = HUGE_VAL;  ///< rad or m; equal stops lock the axis
  double velocity = 0;                              ///< target of the motor [rad/s or m/s]
  double maxForce = 0;                              ///< bound of the motor's force, at least 0
  double fudgeFactor = 1;                           ///< 0..1: scales a motor that drives away from the stop it is at
  double bounce = 0;                                ///< restitution of the stops, 0..1
  double cfm = 0;                                   ///< of the motor's row [velocity / force]
  double stopErp = 0;                               ///< of the stops' row, 0..1
  double stopCfm = 0;                               ///< of the stops' row [velocity / force]
};

/// A joint between two bodies, or between a body and the world. The engine owns it.
///
/// `a` is nullptr only if the joint is attached to nothing. A joint whose caller attached only a second body has that
/// body as `a`, and `reversed` is true. A vector "in a" (or b) is in the frame of that body, or in the world frame if
/// the body is nullptr. Directions have length 1, except those in b where b is nullptr. "When set" means when the
/// caller last set the anchor, an axis or the bodies.
struct SolverJoint {
  JointType type = JointType::hinge;
  SolverBody* a = nullptr;  ///< owned by the engine
  SolverBody* b = nullptr;  ///< owned by the engine; nullptr: the world
  /// Only a second body was attached. A slider's axis then points the other way, and an Euler motor's first and third
  /// axes change places.
  bool reversed = false;
  std::array<SolverAxis, 3> axes;  ///< only as many as the type has axes are used; ball and fixed joints have none
  /// The points [m] that coincide, in a and in b, except:
  /// fixed: b's centre when set, in a, and zero; without b zero and a's centre when set, in the world.
  /// slider: anchorB alone, a's centre when set, in b.
  Vec3 anchorA = Vec3::Zero(), anchorB = Vec3::Zero();
  /// Joint axes in a and in b. Hinge and slider: the axis is [0] of both. Universal and hinge2: axis 1 is axisA[0],
  /// axis 2 is axisB[1]. Angular motor: axis i is axisA[i] in the frame that `frame[i]` names; Euler: [0] in the first
  /// body and [2] in the second.
  std::array<Vec3, 3> axisA, axisB;
  /// Rotations when set, w x y z. Hinge, slider and fixed: initialRotationA is b's rotation relative to a. Universal:
  /// A is the orthonormal frame of (axis 1, axis 2) in a, B that of (axis 2, axis 1) in b. All zeros: a fixed joint
  /// that was never set, whose rotation drifts.
  std::array<double, 4> initialRotationA{1, 0, 0, 0}, initialRotationB{1, 0, 0, 0};
  /// hinge2: the directions from which angles are counted. [0] is the other axis when set, made perpendicular to this
  /// one; [1] completes the right-handed frame (axis, [0], [1]). planeA belongs to axis 1, in a; planeB to axis 2, in
  /// b.
  std::array<Vec3, 2> planeA{Vec3::Zero(), Vec3::Zero()}, planeB{Vec3::Zero(), Vec3::Zero()};
  double cosAxes = 0, sinAxes = 0;              ///< hinge2: cosine and sine of the angle between the axes when set
  double erp = 0.2, cfm = 1e-5;                 ///< ball and fixed: of the anchor's rows; other rows use the world's
  double suspensionErp = 0, suspensionCfm = 0;  ///< hinge2: of the row along axis 1
  int motorAxes = 0;                            ///< angular motor: number of axes, 0..3
  bool euler = false;                           ///< angular motor: axes and angles are Euler angles
  std::array<int, 3> frame{0, 0, 0};            ///< angular motor: axis i is fixed in 0 the world, 1 a, 2 b
  std::array<double, 3> angle{0, 0, 0};         ///< angular motor: the caller's angles [rad], unless `euler`
  /// Euler motor: the zero directions of its angles. reference1 is b's axis when set, in a; reference2 is a's axis when
  /// set, in b.
  Vec3 reference1 = Vec3::Zero(), reference2 = Vec3::Zero();
  bool wantsFeedback = false;  ///< the solver writes the four vectors below
  /// Out: total force [N] and torque about the body's centre [Nm] of the joint on a and on b, world frame.
  Vec3 forceA = Vec3::Zero(), torqueA = Vec3::Zero(), forceB = Vec3::Zero(), torqueB = Vec3::Zero();
};

/// The bodies of a contact. Both are nullptr if the contact is not to be solved; b is nullptr if it is with the static
/// world.
struct SolverPair {
  SolverBody* a = nullptr;
  SolverBody* b = nullptr;
  bool reversed = false;  ///< geomA of the contact is static: a is the body of geomB, and the normal points out of a
};

/// One step of a world. Valid during ISolver::step().
struct SolverStep {
  World world = World::none;             ///< key for what a solver keeps between steps
  std::span<SolverBody* const> bodies;   ///< in order of creation
  std::span<SolverJoint* const> joints;  ///< in order of creation, unattached ones included
  std::span<Contact> contacts;           ///< forceOnA is written where `feedback` is true
  std::span<const SolverPair> pairs;     ///< as many as contacts
  WorldParameters parameters;
  double dt = 0;                ///< s, above 0
  std::uint64_t structure = 0;  ///< changes when a body or joint is created, destroyed or attached
  /// The solver may defer islands that have more rows than this outside of joint trees: rows of contacts between two
  /// bodies and of joints that close loops.
  int maxCouplingRows = 0;
};

/// Steps worlds. One thread at a time calls it. It may use the kernel's jobs; results do not depend on their number of
/// threads.
class ISolver {
 public:
  SPARK_INTERFACE(ISolver, 1);
  virtual ~ISolver() = default;
  /// Steps each island that has an awake body: wakes all its bodies, solves joints and contacts, integrates velocities,
  /// positions and rotations by `dt`, clears forces and writes the feedback that is wanted. Returns the number of
  /// deferred bodies.
  /// Does not throw, and does not allocate while the world's structure and number of contacts repeat.
  virtual std::size_t step(SolverStep& step) = 0;
  /// Drops what was kept for a world that is being destroyed.
  virtual void forget(World) = 0;
};

}  // namespace spark::engine
