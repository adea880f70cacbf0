#pragma once
/// \file
/// The data that the engine keeps for ODE's objects: worlds, spaces, bodies, geoms, joints. A handle of the engine
/// interface is the address of such an object. Each is owned by its world, and the world by the engine.
///
/// Bodies and joints are also what a solver works on (engine::SolverBody, engine::SolverJoint). The pointers of a
/// SolverBody refer to ODE's memory. A SolverJoint mirrors numbers that ODE does not give access to (see
/// ode_mirror.cpp).

#include <ode/ode.h>

#include <atomic>
#include <memory>
#include <vector>

#include "api/engine.h"
#include "api/solver.h"
#include "ode_numbers.h"
#include "ode_threads.h"

namespace spark::ode {

struct WorldData;

inline constexpr std::size_t kCacheLine = 64;  // bytes

/// Position [m] and quaternion (w x y z) of a body, in ODE's numbers.
struct RawPose {
  dReal position[3], quaternion[4];
};

/// The part of a body that every step reads. It is a base class of its own, so that it lies directly before the first
/// members of engine::SolverBody, which every step reads, too.
struct BodyStepData {
  dBodyID id;
  WorldData* world;
  int joints = 0;  ///< number of attached joints, contacts excluded
  // Auto-disable (ODE manual, "Automatic enabling and disabling").
  int idleStepsLeft;                  ///< idle steps until the body falls asleep
  double idleTimeLeft = 0;            ///< idle time until the body falls asleep [s]
  std::uint64_t lastContactStep = 0;  ///< number of the last step with a contact
  /// Prefetch hints: data and ODE memory of a body that was created a few later, which is often read soon after this
  /// one. They may dangle, and are never dereferenced.
  const void *nextData = nullptr, *nextOde = nullptr;
};

/// A body. `awake` mirrors ODE's flag; `deferred` is true when there is no solver.
struct alignas(kCacheLine) BodyData : BodyStepData, engine::SolverBody {
  RawPose lastValid;                 ///< pose after the last step with a valid state
  int staticRows = 0;                ///< constraint rows of its contacts with static geoms, in step lastContactStep
  std::uint64_t visitedStep = 0;     ///< number of the last step in which moveGeomsInOrder() visited the body
  BodyData* islandParent = nullptr;  ///< parent in the disjoint sets of findIslands()
  int islandRows = 0;                ///< root of a set: constraint rows of the island
};

/// A collision space.
struct SpaceData {
  dSpaceID id;
  WorldData* world;
  bool inner = true;  ///< its geoms collide with each other
  // Exact replay:
  bool top = false;              ///< not inside another space
  std::uint64_t collidedAt = 0;  ///< number of the step in which its geoms were last collided with each other
};

struct MeshDeleter {
  void operator()(dTriMeshDataID mesh) const { dGeomTriMeshDataDestroy(mesh); }
};

/// A geom.
struct alignas(kCacheLine) GeomData {
  dGeomID id;
  BodyData* body = nullptr;        ///< nullptr: static
  void* owner;                     ///< as given to createGeom()
  std::uint64_t age;               ///< number in order of creation; newer geoms have higher ones
  Pose offset;                     ///< in the body's frame; the world pose of a static geom
  engine::ShapeDescription shape;  ///< ODE refers to the vertices and triangles of a mesh in here
  Pose base;  ///< pose of ODE's shape in the geom's frame: origin and direction of a ray, else identity
  WorldData* world;
  dSpaceID space;
  std::unique_ptr<dxTriMeshData, MeshDeleter> mesh;
};

/// The part of a joint that every step reads.
struct JointStepData {
  dJointID id;
  WorldData* world;
  /// Cached angle of a hinge [rad], because effectors and sensors read the same number. It is valid while
  /// `angleVersion` equals WorldData::angleVersion. Atomic, because sensors read it in several threads.
  mutable std::atomic<double> cachedAngle = 0;
  mutable std::atomic<std::uint64_t> angleVersion = 0;
};

/// A joint. When `reversed`, `a` is the second body of attach().
struct alignas(kCacheLine) JointData : JointStepData, engine::SolverJoint {
  dJointFeedback feedback{};
  bool attached() const { return a != nullptr; }
};

/// Two geoms whose bounds overlap, ordered by age.
struct Pair {
  GeomData* a;
  GeomData* b;
  bool operator<(const Pair& o) const { return a->age != o.a->age ? a->age < o.a->age : b->age < o.b->age; }
};

/// A world.
struct WorldData {
  dWorldID id;
  std::unique_ptr<IslandThreads> threads;
  dSpaceID root;                       ///< the space around all top-level spaces
  dJointGroupID contactJoints;         ///< contact joints of the current step
  engine::WorldParameters parameters;  ///< as passed to ODE
  bool exactReplay = false;            ///< the engine's exactReplay when the world was created
  std::uint64_t steps = 0, nextAge = 1;
  std::uint64_t angleVersion = 1;      ///< changes when a joint angle may have changed
  std::uint64_t stepAngleVersion = 1;  ///< angleVersion after the last step of ODE's solver
  std::vector<std::unique_ptr<BodyData>> bodies;
  std::vector<std::unique_ptr<SpaceData>> spaces;
  std::vector<std::unique_ptr<GeomData>> geoms;
  std::vector<std::unique_ptr<JointData>> joints;
  engine::PairFilter filter = nullptr;           ///< of the current detect()
  std::vector<Pair> pairs;                       ///< close pairs of the current detect()
  std::vector<engine::SolverPair> contactPairs;  ///< of each contact of the step
  std::vector<dJointFeedback> feedback;          ///< of each contact joint that needs it
  std::vector<engine::Body> repaired;            ///< as IEngine::repaired()

  // Constraint rows of this step's contacts, for the bound on the size of islands.
  int couplingRows = 0;           ///< of contacts between two bodies
  int staticRows = 0;             ///< of contacts with static geoms
  int maxStaticRows = 0;          ///< largest BodyData::staticRows
  int maxJointRows = 0;           ///< most rows of joints in a set of bodies that joints connect
  int maxJointBodies = 0;         ///< most bodies in such a set
  std::uint64_t jointRowsAt = 0;  ///< `structure` for which the last two were counted

  std::vector<BodyData*> excluded;    ///< bodies disabled during a run of one of ODE's solvers
  std::vector<BodyData*> visitStack;  ///< of moveGeomsInOrder()
  std::vector<BodyData*> solved;      ///< bodies that the solver has stepped
  std::uint64_t structure = 0;        ///< changes when a body or joint is created, destroyed or attached
  std::uint64_t listedAt = 0;         ///< `structure` for which the two lists below were made
  std::vector<engine::SolverBody*> solverBodies;
  std::vector<engine::SolverJoint*> solverJoints;
};

// A handle is the address of its data.
// NOLINTBEGIN(performance-no-int-to-ptr)
inline WorldData* data(engine::World h) { return reinterpret_cast<WorldData*>(h); }
inline SpaceData* data(engine::Space h) { return reinterpret_cast<SpaceData*>(h); }
inline BodyData* data(engine::Body h) { return reinterpret_cast<BodyData*>(h); }
inline GeomData* data(engine::Geom h) { return reinterpret_cast<GeomData*>(h); }
inline JointData* data(engine::Joint h) { return reinterpret_cast<JointData*>(h); }
// NOLINTEND(performance-no-int-to-ptr)
inline BodyData* data(engine::SolverBody* b) { return static_cast<BodyData*>(b); }

inline engine::World handle(WorldData& w) { return engine::World{reinterpret_cast<std::uintptr_t>(&w)}; }
inline engine::Space handle(SpaceData& s) { return engine::Space{reinterpret_cast<std::uintptr_t>(&s)}; }
inline engine::Body handle(BodyData& b) { return engine::Body{reinterpret_cast<std::uintptr_t>(&b)}; }
inline engine::Geom handle(GeomData& g) { return engine::Geom{reinterpret_cast<std::uintptr_t>(&g)}; }
inline engine::Joint handle(JointData& j) { return engine::Joint{reinterpret_cast<std::uintptr_t>(&j)}; }

/// A number at the engine interface: rounded to single precision when the world replays recorded sessions exactly.
inline double rounded(const WorldData& w, double v) { return w.exactReplay ? roundToFloat(v) : v; }
inline Vec3 rounded(const WorldData& w, const Vec3& v) { return w.exactReplay ? roundToFloat(v) : v; }
inline Mat3 rounded(const WorldData& w, const Mat3& m) { return w.exactReplay ? roundToFloat(m) : m; }

/// Keep the SolverJoint part of a joint equal to ODE's own data. Each is called right after the ODE call that it
/// mirrors, with the same numbers.
namespace mirror {
/// After dJointCreate...
void created(JointData& j);
/// After dJointAttach.
void attached(JointData& j);
/// After the anchor was set to the point `world` [m].
void anchorSet(JointData& j, const Vec3& world);
/// After `axis` was set to the direction `world`, which turns with `frame`: 0 the world, 1 the first body, 2 the
/// second.
void axisSet(JointData& j, int axis, const Vec3& world, int frame);
/// After mode and number of axes of an angular motor were set.
void motorModeSet(JointData& j, int axes, bool euler);
/// After dJointSetFixed.
void fixedSet(JointData& j);
/// After the world's ERP or CFM changed, which some rows of most joint types use.
void worldParametersSet(JointData& j);
}  // namespace mirror

/// Most constraint rows that a contact adds to an island.
inline constexpr int kContactRows = 3;
/// Most constraint rows that a joint adds to an island.
int rowsOf(engine::JointType type);

// ODE's default thresholds of auto-disable: slower than 0.01 m/s and 0.01 rad/s for 10 steps.
inline constexpr int kIdleSteps = 10;
inline constexpr dReal kIdleSpeedSquared = 0.01 * 0.01;
/// Upper limit of contact points per pair of geoms, whatever detect() is called with.
inline constexpr int kMaxPerPair = 16;

/// Wakes a body or puts it to sleep, here and in ODE.
inline void setAwake(BodyData& b, bool on) {
  on ? dBodyEnable(b.id) : dBodyDisable(b.id);
  b.awake = on;
}

/// Removes and destroys the element that points to `p`; the others keep their order.
template <class T>
void removeFrom(std::vector<std::unique_ptr<T>>& list, T* p) {
  for (auto it = list.begin(); it != list.end(); ++it)
    if (it->get() == p) {
      list.erase(it);
      return;
    }
}

}  // namespace spark::ode
