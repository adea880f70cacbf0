#pragma once
/// \file
/// The engine interface on ODE 0.16, double precision. ODE's types do not leave this folder.
///
/// What is ours and not ODE's, and why:
///  - Auto-disable: ODE's rule with ODE's thresholds, but its counters live here, where they can be saved. A restored
///  world goes on
///    bit for bit.
///  - Pair order: ODE's spaces report pairs in an order that depends on history. Pairs are collected, sorted by the age
///  of their
///    geoms, then collided: same tree, same state, same contacts. (Not with `exactReplay`: see there.)
///  - Spaces: each space collides its own geoms once per step, and never twice.
///  - Knots: the direct solver's time grows with the cube of an island's constraints, and thirty robots that appear in
///  one place would
///    take minutes. Islands of more than `directRows` rows are solved by ODE's iterative solver (see ode_islands.cpp).
///  - Solver: a child that offers engine::ISolver steps the islands that it knows how to step; ODE keeps bodies, joints
///  and geoms, finds
///    contacts, and steps the deferred islands, all of them where there is no such child (see ode_solver.cpp).
///  - Faults: a body whose state is no number after a step is put back to its last good pose, at rest. Numbers that are
///  no numbers do
///    not get in.
///
///     detect:  sweep and prune -> close pairs -> filters -> sort -> narrow phase -> contacts
///     step:    contacts -> pairs of bodies -> auto-disable -> solver -> what it defers: contact joints, dWorldStep
///              (knots: dWorldQuickStep), feedback -> faults

#include <ode/ode.h>

#include <atomic>
#include <memory>
#include <vector>

#include "api/engine.h"
#include "api/solver.h"
#include "ode_process.h"
#include "ode_threads.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {
namespace ode {

struct WorldData;

inline constexpr std::size_t kCacheLine = 64;  // bytes

/// Position and quaternion of a body, as ODE keeps them.
struct GoodPose {
  dReal position[3], quaternion[4];
};

/// Of a body: what every step looks at. It stands before what a solver sees of it, whose first part every step looks at
/// too.
struct BodyBasics {
  dBodyID id;
  WorldData* world;
  int joints = 0;               ///< joints attached, contacts not counted
  int stepsLeft;                ///< idle steps until it sleeps
  double timeLeft = 0;          ///< idle time until it sleeps [s]
  std::uint64_t touchedAt = 0;  ///< number of the step in which it last had a contact
  /// Memory of the body that was made some after this one: who comes to this one comes to that one soon. To be
  /// prefetched only, it may be gone.
  const void *ahead = nullptr, *odeAhead = nullptr;
};

/// What a solver sees of a body leads into ODE's memory. `awake` is what ODE says, `deferred` is true where no solver
/// steps.
struct alignas(kCacheLine) BodyData : BodyBasics, engine::SolverBody {
  GoodPose good;
  int staticRows = 0;          ///< rows of its contacts with the static world in that step
  std::uint64_t foundAt = 0;   ///< number of the step in which it was last found to be part of an awake island
  BodyData* island = nullptr;  ///< while islands are counted: the next body towards the island's first
  int rows = 0;                ///< at an island's first body: constraint rows of the island
};

struct SpaceData {
  dSpaceID id;
  WorldData* world;
  bool inner = true;
  bool top = false;  ///< exact replay: has no space around it
  std::uint64_t collidedAt =
      0;  ///< exact replay: number of the step in which its geoms were last collided with each other
};

struct MeshDeleter {
  void operator()(dTriMeshDataID mesh) const { dGeomTriMeshDataDestroy(mesh); }
};

struct alignas(kCacheLine) GeomData {
  dGeomID id;
  BodyData* body = nullptr;
  void* owner;
  std::uint64_t age;               ///< counts up in order of creation
  Pose offset;                     ///< in the body's frame, or in the world without a body
  engine::ShapeDescription shape;  ///< keeps the numbers of a mesh alive
  Pose base;                       ///< the shape's own frame: a ray's direction, else identity
  WorldData* world;
  dSpaceID space;
  std::unique_ptr<dxTriMeshData, MeshDeleter> mesh;
};

/// Of a joint: what every step looks at.
struct JointBasics {
  dJointID id;
  WorldData* world;
  /// A hinge's angle, as ODE tells it, and the state of the world's rotations for which it was asked last: effectors
  /// and sensors want the same number. Sensors ask in several threads.
  mutable std::atomic<double> lastAngle = 0;
  mutable std::atomic<std::uint64_t> angleAt = 0;
};

/// What a solver sees of a joint says the same as ODE's own; see ode_frames.cpp. With `reversed`, `a` is the body that
/// was given second.
struct alignas(kCacheLine) JointData : JointBasics, engine::SolverJoint {
  dJointFeedback feedback{};
  bool attached() const { return a != nullptr; }
};

/// Two geoms whose bounds overlap.
struct Pair {
  GeomData* a;
  GeomData* b;
  bool operator<(const Pair& o) const { return a->age != o.a->age ? a->age < o.a->age : b->age < o.b->age; }
};

struct WorldData {
  dWorldID id;
  std::unique_ptr<IslandThreads> threads;
  dSpaceID root;
  dJointGroupID contactJoints;
  engine::WorldParameters parameters;  ///< as ODE was told
  bool exactReplay = false;            ///< as the engine said when the world was made
  std::uint64_t steps = 0, nextAge = 1;
  std::uint64_t rotations = 1;  ///< another number when a body with joints turned or a joint was set anew
  std::uint64_t anglesAt = 1;   ///< the same after the last step of ODE's solver
  std::vector<std::unique_ptr<BodyData>> bodies;
  std::vector<std::unique_ptr<SpaceData>> spaces;
  std::vector<std::unique_ptr<GeomData>> geoms;
  std::vector<std::unique_ptr<JointData>> joints;
  engine::PairFilter filter = nullptr;
  std::vector<Pair> pairs;
  std::vector<engine::SolverPair> contactPairs;  ///< one for each contact of the step
  std::vector<dJointFeedback> feedback;
  std::vector<engine::Body> repaired;
  int unitingRows = 0, staticRows = 0,
      mostStaticRows =
          0;  ///< this step's rows of contacts between bodies; with the static world; most of those on one body
  int heldRows = 0, heldBodies = 0;  ///< most rows, and most bodies, that joints alone hold together
  std::uint64_t heldAt = 0;          ///< the structure for which they were counted
  std::vector<BodyData*> sleepers;   ///< bodies of islands kept out of a run of one of ODE's solvers
  std::vector<BodyData*> toVisit;    ///< while an island is walked through
  std::vector<BodyData*> solved;     ///< bodies that are kept out of ODE's step: they had theirs
  std::uint64_t structure = 0;       ///< another number when bodies or joints came, went or were attached anew
  std::uint64_t listedAt = 0;        ///< the structure of the lists below
  std::vector<engine::SolverBody*> solverBodies;
  std::vector<engine::SolverJoint*> solverJoints;
};

/// Bring what a solver sees of a joint up to what ODE's own was told in the same moment; numbers as they crossed the
/// engine's interface.
namespace frames {
void created(JointData& j);
void attached(JointData& j);
void anchored(JointData& j, const Vec3& world);
void turned(JointData& j, int axis, const Vec3& world, int frame);
void motorChosen(JointData& j, int axes, bool euler);
void fixed(JointData& j);
/// After the world's parameters changed, which some rows of most joints follow.
void worldChanged(JointData& j);
}  // namespace frames

/// Constraint rows that a contact and a joint add at most.
inline constexpr int kContactRows = 3;
int rowsOf(engine::JointType type);

/// Rounded to single precision. Through memory: g++ 12 vectorises pairs of conversions there and back to nothing.
inline double single(double v) {
  const volatile float rounded = static_cast<float>(v);
  return rounded;
}
/// As single(), for many; kept from being dropped by a barrier.
template <int N>
void makeSingle(double* v) {
  float rounded[N];
  for (int i = 0; i < N; ++i) rounded[i] = static_cast<float>(v[i]);
  __asm__ volatile("" : "+m"(rounded));
  for (int i = 0; i < N; ++i) v[i] = rounded[i];
}
inline Vec3 single(Vec3 v) {
  makeSingle<3>(v.data());
  return v;
}
inline Mat3 single(Mat3 m) {
  makeSingle<9>(m.data());
  return m;
}
/// A number as the world takes and gives it: rounded to single precision when recorded sessions are to repeat.
inline double crossing(const WorldData& w, double v) { return w.exactReplay ? single(v) : v; }
inline Vec3 crossing(const WorldData& w, const Vec3& v) { return w.exactReplay ? single(v) : v; }
inline Mat3 crossing(const WorldData& w, const Mat3& m) { return w.exactReplay ? single(m) : m; }

inline WorldData* data(engine::World h) { return reinterpret_cast<WorldData*>(h); }
inline SpaceData* data(engine::Space h) { return reinterpret_cast<SpaceData*>(h); }
inline BodyData* data(engine::Body h) { return reinterpret_cast<BodyData*>(h); }
inline GeomData* data(engine::Geom h) { return reinterpret_cast<GeomData*>(h); }
inline JointData* data(engine::Joint h) { return reinterpret_cast<JointData*>(h); }
inline BodyData* data(engine::SolverBody* b) { return static_cast<BodyData*>(b); }

inline Vec3 toVec(const dReal* v) { return {v[0], v[1], v[2]}; }
/// ODE's rotations are three rows of four.
inline Mat3 toMat(const dReal* r) {
  Mat3 m;
  m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return m;
}
inline void toOde(const Mat3& m, dReal* r) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) r[4 * row + column] = m(row, column);
    r[4 * row + 3] = 0;
  }
}
/// Finite and within reach of the broad phase: farther than 1e8 (m, m/s, rad/s) is nowhere: ODE ends the process
/// when a hash space meets coordinates that do not fit its cells.
inline bool sane(const dReal* v, int n) {
  dReal most = 0;
  for (int i = 0; i < n; ++i) most += std::abs(v[i]);
  return most < 1e8;
}
inline bool sane(const Vec3& v) { return sane(v.data(), 3); }
/// Forces [N, Nm] and what joints are told end here, far beyond what any body stands: ODE ends the process when a turn
/// overflows.
inline constexpr double kMost = 1e30;
inline double bounded(double v) { return std::clamp(v, -kMost, kMost); }
inline Vec3 bounded(const Vec3& v) { return v.cwiseMax(-kMost).cwiseMin(kMost); }
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.rotation * inner.position, outer.rotation * inner.rotation};
}
/// ODE's rule for sleeping with its default thresholds: slower than 0.01 m/s and 0.01 rad/s for 10 steps.
inline constexpr int kIdleSteps = 10;
inline constexpr dReal kIdleSpeedSquared = 0.01 * 0.01;
/// Contact points found for one pair at most, whatever is asked for.
inline constexpr int kMostPerPair = 16;

/// Puts a body to sleep or wakes it, here and in ODE.
inline void setAwake(BodyData& b, bool on) {
  on ? dBodyEnable(b.id) : dBodyDisable(b.id);
  b.awake = on;
}

/// Removes the element that points to `p`, keeping the others' order.
template <class T>
void forget(std::vector<std::unique_ptr<T>>& list, T* p) {
  for (auto it = list.begin(); it != list.end(); ++it)
    if (it->get() == p) {
      list.erase(it);
      return;
    }
}

}  // namespace ode

/// ODE as engine of the physics server.
class OdeEngine : public Node, public engine::IEngine {
  SPARK_CLASS(OdeEngine, Node)
 public:
  ~OdeEngine() override;
  static void describe(Description<OdeEngine>& d) {
    d.doc(
        "Rigid bodies by the Open Dynamics Engine (direct solver). A child that offers ISolver steps what it can in "
        "ODE's stead.");
    d.implements<engine::IEngine>();
    d.property("version", &OdeEngine::version).doc("The library's configuration.");
    d.property("directRows", &OdeEngine::directRows_)
        .min(0)
        .doc("Islands of more constraint rows (three a contact) are solved iteratively: not exactly, but in time.");
    d.property("exactReplay", &OdeEngine::exactReplay_)
        .doc(
            "Worlds made from now on repeat recorded sessions of the installed base to the last digit: numbers cross "
            "the engine's interface in "
            "single precision, and contacts are solved in the order in which ODE's hash spaces report them.");
    d.property("approximateSteps", &OdeEngine::approximateSteps).doc("How many steps had such an island.");
    d.property("messages", &OdeEngine::messages).doc("How often ODE complained about something.");
  }

  engine::World createWorld() override;
  void destroyWorld(engine::World world) override;
  void setWorldParameters(engine::World world, const engine::WorldParameters& p) override;

  engine::Space createSpace(engine::World world, engine::Space parent) override;
  void destroySpace(engine::Space space) override;
  void setInnerCollision(engine::Space space, bool on) override;

  engine::Body createBody(engine::World world) override;
  void destroyBody(engine::Body body) override;
  void setMass(engine::Body body, const engine::Mass& mass) override;
  engine::BodyState state(engine::Body body) const override;
  void posesOfAwake(std::span<const engine::Body> bodies, std::span<std::uint8_t> awake,
                    std::span<Matrix> out) const override;
  void setPosition(engine::Body body, const Vec3& p) override;
  void setRotation(engine::Body body, const Mat3& r) override;
  void setLinearVelocity(engine::Body body, const Vec3& v) override;
  void setAngularVelocity(engine::Body body, const Vec3& w) override;
  void addForce(engine::Body body, const Vec3& f) override;
  void addTorque(engine::Body body, const Vec3& t) override;
  void addDrag(engine::Body body, double linear, double angular) override;
  Vec3 force(engine::Body body) const override;
  Vec3 torque(engine::Body body) const override;
  void setForce(engine::Body body, const Vec3& f) override;
  void setTorque(engine::Body body, const Vec3& t) override;
  void setEnabled(engine::Body body, bool on) override;
  bool enabled(engine::Body body) const override;
  void setGravityMode(engine::Body body, bool on) override;
  void saveBody(engine::Body body, std::vector<double>& out) const override;
  void loadBody(engine::Body body, std::span<const double> in) override;

  engine::Geom createGeom(engine::Space space, const engine::ShapeDescription& shape, void* owner) override;
  void destroyGeom(engine::Geom geom) override;
  void setShape(engine::Geom geom, const engine::ShapeDescription& shape) override;
  void setBody(engine::Geom geom, engine::Body body, const Pose& offset) override;
  void setPose(engine::Geom geom, const Pose& pose) override;
  Pose pose(engine::Geom geom) const override;
  void setCollides(engine::Geom geom, bool on) override;

  engine::Joint createJoint(engine::World world, engine::JointType type) override;
  void destroyJoint(engine::Joint joint) override;
  void attach(engine::Joint joint, engine::Body a, engine::Body b) override;
  void setAnchor(engine::Joint joint, const Vec3& world) override;
  void setAxis(engine::Joint joint, int axis, const Vec3& world, int frame) override;
  void setAngularMotor(engine::Joint joint, int axes, bool euler) override;
  void setMotorAngle(engine::Joint joint, int axis, double angle) override;
  void setFixed(engine::Joint joint) override;
  Vec3 anchor(engine::Joint joint) const override;
  Vec3 axis(engine::Joint joint, int axis) const override;
  void setParameter(engine::Joint joint, engine::JointParameter p, int axis, double v) override;
  double parameter(engine::Joint joint, engine::JointParameter p, int axis) const override;
  void drive(engine::Joint joint, int axis, double speed) override;
  bool atStop(engine::Joint joint, int axis) const override;
  double angle(engine::Joint joint, int axis) const override;
  double angleRate(engine::Joint joint, int axis) const override;
  void setFeedback(engine::Joint joint, bool on) override;
  void feedback(engine::Joint joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const override;

  void detect(engine::World world, engine::PairFilter filter, int perPair, engine::Contacts& out) override;
  void step(engine::World world, engine::Contacts& contacts, double dt) override;
  std::span<const engine::Body> repaired(engine::World world) const override;

 private:
  std::string version() const { return dGetConfiguration(); }
  std::int64_t messages() const { return messages_; }
  std::int64_t approximateSteps() const { return approximateSteps_; }
  void makeShape(ode::GeomData& g);
  void place(ode::GeomData& g);
  /// Finds the bodies of each contact.
  void pairUp(ode::WorldData& w, const engine::Contacts& contacts);
  void sleep(ode::WorldData& w, double dt);
  /// The child that offers a solver, as of the last change of the tree; nullptr: none, and all bodies are deferred to
  /// ODE.
  engine::ISolver* solver();
  /// Steps what the solver knows how to step. Returns the number of deferred bodies.
  std::size_t stepBySolver(ode::WorldData& w, engine::ISolver& solver, engine::Contacts& contacts, double dt);
  /// Steps all deferred bodies.
  void stepByOde(ode::WorldData& w, engine::Contacts& contacts, double dt);
  void addContactJoints(ode::WorldData& w, const engine::Contacts& contacts);
  void readFeedback(ode::WorldData& w, engine::Contacts& contacts);
  /// Steps the world, islands that are too large for the direct solver by the iterative one.
  void solve(ode::WorldData& w, double dt);
  /// Tells the angles of hinges that were asked for since the last step.
  void tellAngles(ode::WorldData& w);
  /// dWorldStep, the islands in the kernel's threads.
  void solveDirectly(ode::WorldData& w, double dt);
  /// Notes who is awake, and puts back who is nowhere.
  void lookAfterStep(ode::WorldData& w, bool byOde);
  /// Logs what ODE said since the last call: the first time, the second, the fourth ...
  void report();

  ode::ProcessUse use_;
  std::vector<std::unique_ptr<ode::WorldData>> worlds_;
  std::string said_;
  std::int64_t messages_ = 0, approximateSteps_ = 0;
  engine::ISolver* solver_ = nullptr;
  TreeWatch tree_;                ///< in which solver_ was found
  std::uint64_t structures_ = 0;  ///< numbers given to structures of worlds so far
  int directRows_ = 1200;
  bool exactReplay_ = false;
};

}  // namespace spark
