#pragma once
/// \file
/// The world of a scene: owns model and state, edits and reads them, and has engines step them.

#include <algorithm>
#include <memory>
#include <vector>

#include "api/engine.h"
#include "api/scene_joint.h"
#include "api/single_precision.h"
#include "queries.h"
#include "rotations.h"

namespace spark::physics {

// Handles of elements. Valid from the create call to the destroy call, while indices in the model change.
enum class BodyHandle : engine::Index { none = engine::kNone };
enum class SpaceHandle : engine::Index { none = engine::kNone };
enum class GeomHandle : engine::Index { none = engine::kNone };
enum class JointHandle : engine::Index { none = engine::kNone };

/// The elements of one kind: which handle belongs to which index. Removed elements stay in the arrays until compact().
template <class Handle>
class Handles {
 public:
  /// The handle of a new last element.
  Handle add() {
    const auto index = static_cast<engine::Index>(handleOf_.size());
    if (free_.empty()) {
      free_.push_back(static_cast<Handle>(indexOf_.size()));
      indexOf_.push_back(engine::kNone);
    }
    const Handle handle = free_.back();
    free_.pop_back();
    indexOf_[static_cast<engine::Index>(handle)] = index;
    handleOf_.push_back(handle);
    return handle;
  }
  /// Frees the handle; its element has none from now on.
  void remove(Handle handle) {
    handleOf_[(*this)[handle]] = Handle::none;
    indexOf_[static_cast<engine::Index>(handle)] = engine::kNone;
    free_.push_back(handle);
    ++removed_;
  }
  /// The index of an element; kNone for Handle::none.
  engine::Index operator[](Handle handle) const {
    return handle == Handle::none ? engine::kNone : indexOf_[static_cast<engine::Index>(handle)];
  }
  Handle handleOf(engine::Index index) const { return handleOf_[index]; }
  bool alive(engine::Index index) const { return handleOf_[index] != Handle::none; }
  /// Number of removed elements that are still in the arrays.
  std::size_t removed() const { return removed_; }
  std::size_t size() const { return handleOf_.size(); }
  /// Removes the elements without a handle from each array. Returns the new index of each old one, kNone for removed
  /// ones.
  template <class... Arrays>
  std::vector<engine::Index> compact(Arrays&... arrays) {
    std::vector<engine::Index> now(handleOf_.size(), engine::kNone);
    engine::Index next = 0;
    for (engine::Index i = 0; i < handleOf_.size(); ++i) {
      if (!alive(i)) continue;
      if (i != next) ((arrays[next] = std::move(arrays[i])), ...), handleOf_[next] = handleOf_[i];
      indexOf_[static_cast<engine::Index>(handleOf_[next])] = next;
      now[i] = next++;
    }
    (arrays.resize(next), ...);
    handleOf_.resize(next);
    removed_ = 0;
    return now;
  }

 private:
  std::vector<engine::Index> indexOf_;  ///< by handle
  std::vector<Handle> handleOf_;        ///< by index
  std::vector<Handle> free_;
  std::size_t removed_ = 0;
};

/// A world. Setters ignore numbers that are not finite or out of range; functions that throw say so. Const functions
/// may be called from several threads, between two steps.
class WorldModel {
 public:
  /// See Model::exactReplay.
  explicit WorldModel(bool exactReplay = false);
  WorldModel(const WorldModel&) = delete;
  WorldModel& operator=(const WorldModel&) = delete;

  const engine::Model& model() const { return model_; }
  const engine::State& state() const { return state_; }
  /// Throws Error for a gravity that is not finite.
  void setParameters(const engine::WorldParameters& p);

  /// Creates a collision space. `parent` none: a top-level space of the world.
  SpaceHandle createSpace(SpaceHandle parent);
  /// Destroys an empty space.
  void destroySpace(SpaceHandle space);
  /// False: geoms directly in this space do not collide with each other. True by default.
  void setInnerCollision(SpaceHandle space, bool on);

  /// Creates a body of 1 kg and unit inertia, awake and at rest in the world's origin.
  BodyHandle createBody();
  /// Destroys a body. Its geoms become static, its joints are detached.
  void destroyBody(BodyHandle body);
  /// Throws Error for a mass that is not above 0, a centre that is not the origin, and an inertia that is not symmetric
  /// and positive definite.
  void setMass(BodyHandle body, const engine::Mass& mass);
  engine::BodyState state(BodyHandle body) const;
  /// Centre of mass [m]. This and the three setters below do not wake the body.
  void setPosition(BodyHandle body, const Vec3& position);
  void setRotation(BodyHandle body, const Mat3& rotation);
  void setLinearVelocity(BodyHandle body, const Vec3& v);   ///< m/s
  void setAngularVelocity(BodyHandle body, const Vec3& w);  ///< rad/s
  void addForce(BodyHandle body, const Vec3& f);            ///< at the centre of mass, for the next step [N]
  void addTorque(BodyHandle body, const Vec3& t);           ///< for the next step [Nm]
  /// Adds the force -linear v and the torque -angular w for the current velocities v and w [N s/m, N m s]; nothing
  /// while the body sleeps.
  void addDrag(BodyHandle body, double linear, double angular);
  /// Force [N] and torque [Nm] accumulated for the next step.
  Vec3 force(BodyHandle body) const { return of(body).force; }
  Vec3 torque(BodyHandle body) const { return of(body).torque; }
  /// True: wakes the body; false: puts it to sleep.
  void setEnabled(BodyHandle body, bool on);
  /// False: the body sleeps.
  bool enabled(BodyHandle body) const { return of(body).awake; }
  /// Sets Body::linearDamping and angularDamping, at most 1e9 each. Numbers below 0 and no numbers are ignored.
  void setDamping(BodyHandle body, double linear, double angular);
  /// See Body::connector.
  void setConnector(BodyHandle body, bool on);
  /// See Body::parts. Numbers that are not finite or too large, and masses below 0, are ignored with the whole list.
  void setParts(BodyHandle body, const std::vector<engine::Part>& parts);
  /// See Body::linkOrigin.
  void setLinkOrigin(BodyHandle body, const Vec3& origin);
  /// False: gravity does not act on the body.
  void setGravityMode(BodyHandle body, bool on);
  /// Appends the body's state, the counters of sleep included: a fixed number of values.
  void saveBody(BodyHandle body, std::vector<double>& out) const;
  /// Restores what saveBody() wrote, bit for bit. Throws Error for another number of values.
  void loadBody(BodyHandle body, std::span<const double> in);
  /// The index in the model.
  engine::Index index(BodyHandle body) const { return bodies_[body]; }

  /// Creates a static geom at the identity pose. Throws Error for an invalid shape.
  GeomHandle createGeom(SpaceHandle space, const engine::ShapeDescription& shape, void* owner);
  void destroyGeom(GeomHandle geom);
  /// Throws Error for an invalid shape; the geom keeps the old one.
  void setShape(GeomHandle geom, const engine::ShapeDescription& shape);
  /// Attaches the geom to a body, at an offset in the body's frame; none: static. Throws Error for an offset that is
  /// not finite.
  void setBody(GeomHandle geom, BodyHandle body, const Pose& offset);
  /// Sets the world pose of a static geom. Planes ignore it.
  void setPose(GeomHandle geom, const Pose& pose);
  /// World pose of a geom.
  Pose pose(GeomHandle geom) const { return poseOf(model_, state_, geoms_[geom]); }
  /// See Geom::part.
  void setPart(GeomHandle geom, int part);
  /// What single engines know: see Model::extensions.
  void setBlocks(const engine::Blocks& blocks);
  void setBlocks(GeomHandle geom, const engine::Blocks& blocks);
  void setBlocks(JointHandle joint, const engine::Blocks& blocks);
  /// False: the geom is left out of detect(). True by default.
  void setCollides(GeomHandle geom, bool on);
  engine::Index index(GeomHandle geom) const { return geoms_[geom]; }

  /// Creates a joint that is not attached.
  JointHandle createJoint(engine::JointType type);
  void destroyJoint(JointHandle joint);
  /// Attaches the joint to two bodies; none is the static world. A joint that was attached before keeps anchor and axes
  /// as they are in the world at its first body. Throws Error for one body twice, and for a hinge2 with only one body.
  void attach(JointHandle joint, BodyHandle a, BodyHandle b);
  /// The common point of both bodies [m]. Ignored before attach() and by joints without such a point.
  void setAnchor(JointHandle joint, const Vec3& world);
  /// Sets axis 0, 1 or 2 to a world direction of any length above 0; throws Error for a shorter one. Ignored before
  /// attach(). Angular motor: the axis turns with `frame` 0 the world, 1 the first body, 2 the second body.
  void setAxis(JointHandle joint, int axis, const Vec3& world, int frame = 0);
  /// Sets number of axes (0 to 3; throws Error for others) and mode of an angular motor. `euler`: three Euler angles.
  void setAngularMotor(JointHandle joint, int axes, bool euler);
  /// Sets the angle [rad] about an axis of an angular motor that is not in Euler mode.
  void setMotorAngle(JointHandle joint, int axis, double angle);
  /// Makes a fixed joint hold the current relative pose of its bodies.
  void setFixed(JointHandle joint);
  Vec3 anchor(JointHandle joint) const;          ///< m; zero for joints without one
  Vec3 axis(JointHandle joint, int axis) const;  ///< unit vector; zero when the joint has no such axis
  /// Ignored for parameters and axes that the joint does not have, and for values that make no sense.
  void setParameter(JointHandle joint, engine::JointParameter p, int axis, double v);
  /// 0 for parameters and axes that the joint does not have.
  double parameter(JointHandle joint, engine::JointParameter p, int axis) const;
  /// Sets the passive spring of an axis: stiffness [Nm/rad or N/m], 0: none, and where it is at rest [rad or m].
  void setSpring(JointHandle joint, int axis, double stiffness, double position);
  /// Sets JointParameter::velocity; a speed other than 0 wakes the first body of attach(). An axis has one command:
  /// velocity and maxForce end a controller, and a controller ends the motor.
  void drive(JointHandle joint, int axis, double speed);
  /// Puts a controller in place of the axis' motor, or changes its targets; numbers that make no sense are ignored. A
  /// controller wakes body a of the joint.
  void control(JointHandle joint, int axis, const engine::Control& control);
  /// The controller of an axis; nullptr: none. Valid until one is added or removed.
  const engine::Control* controlOf(JointHandle joint, int axis) const;
  /// True when the axis is at one of its stops or beyond.
  bool atStop(JointHandle joint, int axis) const;
  /// First body relative to the second [rad; slider: m]. Continuous: see engine::JointCoordinates.
  double angle(JointHandle joint, int axis) const;
  /// The same within one turn, -pi..pi, as its poses have it.
  double angleOfPoses(JointHandle joint, int axis) const;
  /// The continuous angle as the stops count it, for loadCoordinate() [rad]; 0 for axes that count no turns.
  double coordinate(JointHandle joint, int axis) const;
  /// Restores the turns of an axis.
  void loadCoordinate(JointHandle joint, int axis, double angle);
  double angleRate(JointHandle joint, int axis) const;  ///< its rate [rad/s; slider: m/s]
  void setFeedback(JointHandle joint, bool on);         ///< true: steps measure forces and torques of the joint
  /// Force [N] and torque [Nm] on the first and the second body in the last step; zero without feedback.
  void feedback(JointHandle joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const;
  /// Another number whenever a body was moved or the angle of a joint may have changed.
  std::uint64_t poses() const { return poses_; }
  engine::Index index(JointHandle joint) const { return joints_[joint]; }

  /// Detects contacts: see IDetector::detect(). `collision` is used unless the engine detects them itself; otherwise it
  /// may be nullptr.
  void detect(engine::IEngine& engine, engine::ICollision* collision, engine::PairFilter filter, int perPair,
              engine::Contacts& out);
  /// Puts bodies that have been idle long enough to sleep, steps the world, and puts bodies whose state is no number or
  /// out of range back to their last valid pose, at rest. `contacts` are those of the last detect(), and nothing was
  /// removed since.
  /// `sink`: for an engine with Capabilities::late; `contacts` are then those of the step before.
  void step(engine::IEngine& engine, engine::Contacts& contacts, double dt, engine::IContactSink* sink = nullptr);
  /// Keeps the forces and torques on the bodies, for a step of the simulation that has several of the engine's.
  void keepForces(bool on);
  /// Adds the kept ones again, before a further step of the engine.
  void repeatForces();
  /// The bodies that were put back after the last step. Valid until the next step of the
  /// simulation.
  std::span<const BodyHandle> repaired() const { return repaired_; }

 private:
  /// What is kept of a body beside model and state.
  struct Watch {
    // Auto-disable (ODE manual, "Automatic enabling and disabling"), with ODE's default thresholds.
    int idleStepsLeft = 10;             ///< idle steps until the body falls asleep
    double idleTimeLeft = 0;            ///< idle time until the body falls asleep [s]
    std::uint64_t lastContactStep = 0;  ///< number of the last step with a solved contact
    Vec3 validPosition = Vec3::Zero();  ///< pose after the last step with a valid state
    Quaternion validQuaternion{1, 0, 0, 0};
  };
  /// The angle of a hinge [rad], because effectors and sensors read the same number. It is valid while `at` is poses_.
  /// Sensors read it in several threads.
  struct CachedAngle {
    double angle = 0;
    std::uint64_t at = 0;
  };
  /// What steps the model, or finds its contacts, and the versions of the model that it has compiled.
  template <class Maker>
  struct Compiled {
    engine::Attached<Maker> attached;
    std::uint64_t structure = 0, part = 0;
    /// Calls compile(the part) unless it has this version. Returns the part.
    template <class F>
    typename Maker::Part& bring(Maker& maker, const engine::Model& model, std::uint64_t version, F&& compile);
  };
  engine::ISolver& solver(engine::IEngine& engine);
  /// Compiles an engine's own detector where the model changed.
  void bringOwn(engine::IDetector& detector);

  engine::DynamicState& of(BodyHandle body) { return state_.bodies[bodies_[body]]; }
  const engine::DynamicState& of(BodyHandle body) const { return state_.bodies[bodies_[body]]; }
  engine::Joint& of(JointHandle joint) { return model_.joints[joints_[joint]]; }
  const engine::Joint& of(JointHandle joint) const { return model_.joints[joints_[joint]]; }
  /// The state of a joint's body; nullptr: the world.
  const engine::DynamicState* stateAt(engine::Index body) const {
    return body == engine::kNone ? nullptr : &state_.bodies[body];
  }
  /// As the number enters an engine: rounded in exact replay.
  template <class T>
  T rounded(const T& v) const {
    return model_.exactReplay ? T(roundToFloat(v)) : v;
  }
  void markEdited(engine::Index geom);
  void detach(engine::Joint& joint);
  /// Removes dead elements from the arrays and gives the others their new indices.
  void compact();
  void compactWhenMany();
  void putToSleep(const engine::Contacts& contacts, double dt);
  /// Add the forces of controllers and of damping to those on the bodies.
  void applyControls();
  void applyDamping();
  /// Adds the damping of bodies. That of a body without joints is implicit: it never turns it back, however strong it
  /// is. That of others is of the present velocity, as that of joints: too strong for their inertia and the step, it
  /// throws them about.
  void applyBodyDamping(double dt);
  void applySprings();
  /// False for a joint whose bodies sleep: forces on them would pile up.
  bool acts(const engine::Joint& joint) const;
  /// The rate of an axis' angle, or place, without ODE's rounding [rad/s or m/s].
  double exactRate(engine::Index joint, int axis) const;
  void addAlong(const engine::Joint& joint, int axis, double force);
  void endControl(engine::Index joint, int axis);
  void listControls();
  /// Passes the motor of an axis on; where there is none, its dry friction acts in its place.
  void passMotor(engine::Index joint, int axis);
  void checkBodies();

  // Joints (world_joints.cpp, world_axes.cpp, world_turns.cpp).
  void remember(engine::Joint& joint, engine::JointCall::Kind kind, int axis, const Vec3& world, int frame = 0);
  void anchorSet(engine::Joint& j, const Vec3& world);
  void axisSet(engine::Joint& j, int axis, const Vec3& world, int frame);
  void setRelativeRotation(engine::Joint& j);
  void setUniversalFrames(engine::Joint& j);
  void setHinge2Planes(engine::Joint& j);
  void setHinge2Axes(engine::Joint& j);
  void setSliderOffset(engine::Joint& j);
  void setEulerReferences(engine::Joint& j);
  std::array<Vec3, 3> eulerAxes(const engine::Joint& j) const;
  double eulerAngle(const engine::Joint& j, int axis) const;
  double angleOf(engine::Index joint, int axis) const;
  /// The axis and the sign by which the angle of an axis is that of a stop; see Joint::reversed.
  struct AxisView {
    int axis;
    double sign;
  };
  AxisView viewOf(const engine::Joint& j, int axis) const;
  /// The angle of a rotational axis within one turn, as its stops count it.
  double rawAngle(engine::Index joint, int axis) const;
  /// The turns of an axis, at the present poses.
  std::int32_t turnsNow(engine::Index joint, int axis, double raw) const;
  void countTurns();
  void listTurning();
  void startCoordinates(const engine::Joint& j);
  /// Sets the turns of an axis, and counts them in State::turned.
  void setTurns(engine::JointCoordinates& c, int axis, std::int32_t turns);
  double rateOf(engine::Index joint, int axis) const;
  double hingeAngle(engine::Index joint) const;
  double universalAngle(const engine::Joint& j, int axis) const;
  double sliderPosition(const engine::Joint& j) const;
  double hinge2Angle(const engine::Joint& j, int axis) const;
  Vec3 worldAxis(const engine::Joint& j, int axis) const;

  engine::Model model_;
  engine::State state_;
  Handles<BodyHandle> bodies_;
  Handles<SpaceHandle> spaces_;
  Handles<GeomHandle> geoms_;
  Handles<JointHandle> joints_;
  std::vector<engine::Index> edited_;                    ///< the geoms that were edited since the last detect()
  std::vector<std::uint8_t> geomEdited_;                 ///< by geom: it is in `edited_`
  std::vector<Watch> watch_;                             ///< by body
  mutable std::vector<CachedAngle> angles_;              ///< by joint
  std::uint64_t poses_ = 1;                              ///< see poses()
  std::vector<engine::Motors> motors_;                   ///< by joint: as they were set
  std::vector<std::array<engine::Index, 3>> controlAt_;  ///< by joint and axis: its place in State::controls
  bool damped_ = false;                                  ///< an axis has damping
  bool bodiesDamped_ = false;                            ///< a body has damping
  bool sprung_ = false;                                  ///< an axis has a spring
  /// The joints that count turns, and their bodies; valid for turningAt_, a version of the structure.
  struct Turning {
    engine::Index joint, a, b;
    int axes;
  };
  std::vector<Turning> turning_;
  std::uint64_t turningAt_ = 0;
  std::uint64_t countedAt_ = 0;  ///< poses_ when turns were counted last
  std::vector<BodyHandle> repaired_;
  struct KeptForce {
    BodyHandle body;
    Vec3 force, torque;
  };
  std::vector<KeptForce> kept_;
  bool again_ = false;  ///< the next step is a further one
  std::uint64_t nextId_ = 1, steps_ = 0, attachments_ = 0, settings_ = 0;
  Compiled<engine::ICollision> collision_;
  Compiled<engine::IEngine> engine_;
  std::pair<std::uint64_t, std::uint64_t> ownAt_;  ///< structure and collision that its own detector has
};

/// True when the magnitudes of `n` numbers (m, m/s, rad/s) sum up to less than 1e8; false also for NaN. Larger
/// coordinates do not fit the cells of hash spaces.
inline bool inRange(const double* v, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += std::abs(v[i]);
  return sum < 1e8;
}
inline bool inRange(const Vec3& v) { return inRange(v.data(), 3); }

/// The nearest number within +-1e30: larger forces, torques and joint parameters make engines overflow.
inline double bounded(double v) { return std::clamp(v, -1e30, 1e30); }
inline Vec3 bounded(const Vec3& v) { return v.cwiseMax(-1e30).cwiseMin(1e30); }

}  // namespace spark::physics
