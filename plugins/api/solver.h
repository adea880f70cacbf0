#pragma once
/// \file
/// A solver in an engine's stead. The engine keeps bodies, joints and geoms and finds contacts; a node that offers
/// ISolver as the engine's child `solver` steps the world from plain data. The engine's own solver does the islands
/// that it leaves.
///
/// The formulation is that of a first-order velocity step with soft constraints (J M^-1 J^T + cfm/dt, error reduction
/// erp/dt, rows with bounds): what a row is for each joint type stands where the solver is; what the numbers below mean
/// stands here.

#include <array>
#include <span>

#include "api/engine.h"
#include "spark/abi/api/solver.h"

namespace spark::engine {

/// A body, as the engine keeps it. Pointers lead into the engine's memory and stay valid as long as the body; vectors
/// have 3 elements (of 4).
struct SolverBody {
  double* position = nullptr;    ///< m, of the centre of mass
  double* quaternion = nullptr;  ///< w x y z
  double* rotation = nullptr;    ///< three rows of four
  double* velocity = nullptr;    ///< m/s
  double* spin = nullptr;        ///< rad/s, world frame
  double* force = nullptr;       ///< N, world frame, accumulated for this step; the solver clears it
  double* torque = nullptr;      ///< Nm, world frame; the solver clears it
  bool gravity = true;           ///< the world's gravity acts
  bool gyroscopic = true;        ///< gyroscopic torque acts, by the implicit formula
  bool awake = true;  ///< in: is stepped, and so is all that hangs on it; out: true for all bodies that were stepped
  bool left = false;  ///< out: its island was left to the engine, nothing of it is changed
  std::uint32_t index = 0;                                             ///< its place in SolverStep::bodies
  double mass = 1;                                                     ///< kg
  Mat3 inertia = Mat3::Identity(), inverseInertia = Mat3::Identity();  ///< kg m^2 and its inverse, body frame
};

/// Motor and stops of one axis of a joint (JointParameter).
struct SolverAxis {
  double lowStop = -HUGE_VAL, highStop = HUGE_VAL;  ///< rad or m
  double velocity = 0, maxForce = 0, fudgeFactor = 1, bounce = 0;
  double cfm = 0, stopErp = 0, stopCfm = 0;
};

/// A joint between two bodies, or one body and the world. `a` is there unless the joint holds nothing; an engine that
/// was given only a second body puts it first. Vectors "in a" are in the body's frame, or the world's where the body is
/// none.
struct SolverJoint {
  JointType type = JointType::hinge;
  SolverBody* a = nullptr;
  SolverBody* b = nullptr;
  bool reversed = false;  ///< was given only a second body, which stands first here: a slider without b and an Euler
                          ///< motor count the other way round
  std::array<SolverAxis, 3> axes;
  /// The points that meet, in a and in b. fixed: b's centre as it was set in a, and 0; without b 0 and a's place.
  /// slider: anchorB alone counts: a's centre as it was set in b, or a's place without b.
  Vec3 anchorA = Vec3::Zero(), anchorB = Vec3::Zero();
  std::array<Vec3, 3> axisA,
      axisB;  ///< in a, in b. Hinge and slider: [0] of both. Universal and hinge2: axisA[0] in a, axisB[1] in b.
              ///< Angular motor: axisA[i] in what `frame[i]` says (Euler: [0] and [2] in the body to which they belong)
  std::array<double, 4> relativeA{1, 0, 0, 0},
      relativeB{1, 0, 0,
                0};  ///< rotations between the bodies when the joint was set (w x y z); universal has one for each axis
  Vec3 v1 = Vec3::Zero(), v2 = Vec3::Zero(), w1 = Vec3::Zero(),
       w2 = Vec3::Zero();                       ///< hinge2: reference directions for its angles
  double c0 = 0, s0 = 0;                        ///< hinge2: cosine and sine between its axes
  double erp = 0.2, cfm = 1e-5;                 ///< of rows that are neither motor nor stop
  double suspensionErp = 0, suspensionCfm = 0;  ///< hinge2
  int motorAxes = 0;                            ///< angular motor: how many
  bool euler = false;
  std::array<int, 3> frame{0, 0, 0};                          ///< angular motor: 0 world, 1 a, 2 b
  std::array<double, 3> angle{0, 0, 0};                       ///< angular motor: as set, rad
  Vec3 reference1 = Vec3::Zero(), reference2 = Vec3::Zero();  ///< angular motor, euler
  bool wantsFeedback = false;
  Vec3 forceA = Vec3::Zero(), torqueA = Vec3::Zero(), forceB = Vec3::Zero(),
       torqueB = Vec3::Zero();  ///< N, Nm: out, when wanted
};

/// The bodies of a contact; both nullptr when it is not to be solved. A contact with the world alone has it as b.
struct SolverPair {
  SolverBody* a = nullptr;
  SolverBody* b = nullptr;
  bool reversed = false;  ///< the contact's first geom is the world's: a is the body of the second, and the normal
                          ///< counts the other way round
};

/// One step of a world.
struct SolverStep {
  World id = World::none;                ///< what a solver keeps between steps, it keeps for this world
  std::span<SolverBody* const> bodies;   ///< in order of creation
  std::span<SolverJoint* const> joints;  ///< in order of creation
  std::span<Contact> contacts;           ///< forceOnA is written where `feedback` says so
  std::span<const SolverPair> pairs;     ///< one for each contact
  WorldParameters parameters;
  double dt = 0;                ///< s
  std::uint64_t structure = 0;  ///< another number when bodies or joints came, went or were attached anew
  int mostRows = 0;  ///< islands with more rows between bodies that no tree of joints holds together (contacts, loops)
                     ///< may be left to the engine
};

/// Steps worlds. Used by one thread at a time; may use the kernel's jobs; the result does not depend on how many
/// threads these have.
class ISolver {
 public:
  SPARK_INTERFACE(ISolver, 1);
  virtual ~ISolver() = default;
  /// Wakes what hangs on something awake, solves joints and contacts, integrates velocity, place and rotation, clears
  /// forces, writes wanted feedback. Returns how many bodies were left to the engine. Allocates nothing when worlds
  /// repeat themselves; does not throw.
  virtual std::size_t step(SolverStep& step) = 0;
  /// The world is gone: what was kept for it goes too.
  virtual void forget(World) = 0;
};

}  // namespace spark::engine
