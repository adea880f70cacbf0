#pragma once
/// \file
/// What the engine keeps of a world: ODE's bodies and joints, which follow the model and the state.

#include <ode/ode.h>

#include <array>
#include <memory>
#include <vector>

#include "api/engine.h"
#include "api/scene_joint.h"
#include "ode_numbers.h"
#include "ode_process.h"
#include "ode_threads.h"

namespace spark::ode {

/// A body of ODE. The pointers refer to its memory.
struct BodyData {
  std::uint64_t id = 0;  ///< as in the model
  dBodyID body = nullptr;
  dReal *position = nullptr, *quaternion = nullptr, *rotation = nullptr;  ///< 3, 4 and 3 x 4 elements
  dReal *linearVelocity = nullptr, *angularVelocity = nullptr, *force = nullptr, *torque = nullptr;
  double mass = 0;  ///< as passed to ODE, with the inertia
  Mat3 inertia = Mat3::Zero();
  bool gravity = true;
  std::uint32_t version = 0;          ///< of the state that ODE has, see DynamicState::version; 0: of none
  std::uint64_t movedStep = 0;        ///< number of the last step in which ODE moved it
  std::uint64_t lastContactStep = 0;  ///< number of the last step with a contact
  int staticRows = 0;                 ///< constraint rows of its contacts with static geoms, in step lastContactStep
  std::uint64_t visitedStep = 0;      ///< number of the last step in which the order of bodies was found
  engine::Index islandParent = 0;     ///< parent in the disjoint sets of findIslands()
  int islandRows = 0;                 ///< root of a set: constraint rows of the island
};

/// A joint of ODE.
struct JointData {
  std::uint64_t id = 0;  ///< as in the model
  dJointID joint = nullptr;
  engine::JointType type = engine::JointType::hinge;
  std::uint64_t attachedAt = 0, setAt = 0;  ///< as in the model
  std::array<engine::JointAxis, 3> axes;    ///< as passed to ODE
  engine::JointSoftness soft;               ///< as passed to ODE
  dJointFeedback feedback{};
  bool wantsFeedback = false;
};

/// A joint of ODE beside one of the model, for a law: a motor of its own, with a soft row.
struct LawJoint {
  std::uint64_t id = 0;  ///< of the model's joint
  bool slides = false;
  engine::Index a = engine::kNone, b = engine::kNone;
  dJointID joint = nullptr;
  bool isOf(const engine::Joint& j) const { return id == j.id && a == j.a && b == j.b; }
};

/// A world of ODE. The elements are as in the model.
struct WorldData {
  LibraryGuard library;
  dWorldID id;
  std::unique_ptr<IslandThreads> threads;
  dJointGroupID contactJoints;  ///< contact joints of the current step
  bool exactReplay;
  std::uint64_t structure = 0;  ///< of the model, when it was compiled
  std::uint64_t steps = 0;
  std::vector<BodyData> bodies;
  std::vector<std::unique_ptr<JointData>> joints;   ///< ODE refers to their feedback
  std::vector<LawJoint> laws;                       ///< of State::laws
  std::vector<dJointFeedback> feedback;             ///< of each contact joint that needs it
  std::vector<engine::Index> measured;              ///< the joints whose forces are measured
  std::vector<engine::Motors> motors;               ///< by joint, as passed to ODE
  std::vector<std::array<engine::Index, 2>> links;  ///< the bodies of each joint between two bodies
  std::vector<std::uint8_t> needed;                 ///< by body: it is awake, or connected to one that is
  std::vector<std::uint8_t> enabled;                ///< by body: as in ODE
  std::size_t awake = 0;                            ///< number of bodies that are awake before the step
  engine::State* state = nullptr;                   ///< during a step

  // Constraint rows of this step's contacts, for the bound on the size of islands.
  int couplingRows = 0;    ///< of contacts between two bodies
  int staticRows = 0;      ///< of contacts with static geoms
  int maxStaticRows = 0;   ///< largest BodyData::staticRows
  int maxJointRows = 0;    ///< most rows of joints in a set of bodies that joints connect
  int maxJointBodies = 0;  ///< most bodies in such a set
  bool jointRowsCounted = false;
  struct LimitedAxis {
    engine::Index joint;
    int axis;
    double stopErp;  ///< the model's
  };
  std::vector<LimitedAxis> limited;  ///< axes with a stop
  bool turned = false;               ///< ODE has the stops of joints that have turned

  std::vector<engine::Index> excluded;    ///< bodies disabled during a run of one of ODE's solvers
  std::vector<engine::Index> visitStack;  ///< of orderOfBodies()
  std::vector<engine::Index> order;       ///< the bodies that a step moves, in the order in which ODE moves them
  bool listOrder = false;                 ///< ODE's callback lists them

  WorldData(bool exactReplay, Jobs& jobs);
  ~WorldData();
  WorldData(const WorldData&) = delete;
  WorldData& operator=(const WorldData&) = delete;
};

/// Most constraint rows that a contact adds to an island.
inline constexpr int kContactRows = 3;
/// Most constraint rows that a joint adds to an island.
int rowsOf(engine::JointType type);

/// Brings ODE's joints up to date with the model (ode_joints.cpp).
void compileJoints(WorldData& w, const engine::Model& model, const engine::State& state);
/// Passes the stops of joints that have turned.
void passTurns(WorldData& w, const engine::Model& model, const engine::State& state);
/// Passes the ERP of stops that axes are far beyond: they come back at a bounded speed.
void passStopReturns(WorldData& w, const engine::Step& step);
/// Passes the motors' speeds and forces, which change in every step.
void passMotors(WorldData& w, const engine::State& state);
/// Passes the laws of joints.
void passLaws(WorldData& w, const engine::Step& step);
/// Removes their joints: passLaws() makes them anew, so that their order does not depend on what was before.
void clearLaws(WorldData& w);
/// Copies what ODE measured at the joints of the stepped bodies.
void readJoints(const WorldData& w, const engine::Step& step);

}  // namespace spark::ode
