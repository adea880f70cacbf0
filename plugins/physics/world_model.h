#pragma once
/// \file
/// The world of a scene: its elements, which are made and edited by handles.

#include "api/engine.h"
#include "api/scene_joint.h"
#include "body_watch.h"
#include "element_handles.h"
#include "joint_kinematics.h"
#include "mesh_pool.h"
#include "queries.h"

namespace spark::physics {

/// The kinematics of one joint. Valid until an element is removed.
struct JointAt {
  const JointKinematics& joints;
  engine::Index joint;
  Vec3 anchor() const { return joints.anchor(joint); }
  Vec3 axis(int axis) const { return joints.axis(joint, axis); }
  double angle(int axis) const { return joints.angle(joint, axis); }
  double angleOfPoses(int axis) const { return joints.angleOfPoses(joint, axis); }
  double angleRate(int axis) const { return joints.rate(joint, axis); }
  double coordinate(int axis) const { return joints.coordinate(joint, axis); }
  bool atStop(int axis) const { return joints.atStop(joint, axis); }
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
  /// See WorldData::poses.
  std::uint64_t poses() const { return data_.poses; }
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
  /// Appends the body's state, the counters of sleep included. The rotation is left out where it is that of the
  /// quaternion, as engines compute it.
  void saveBody(BodyHandle body, std::vector<double>& out) const;
  /// Restores what saveBody() wrote, bit for bit. Throws Error for another number of values.
  void loadBody(BodyHandle body, std::span<const double> in);
  /// What a body rests on, as bytes: beside saveBody(), of which it follows while nothing changes.
  std::string saveSupport(BodyHandle body) const;
  /// Restores it, behind loadBody(). Throws Error where it does not fit.
  void loadSupport(BodyHandle body, std::string_view bytes);
  /// The index in the model.
  engine::Index index(BodyHandle body) const { return bodies_[body]; }

  /// The meshes of its geoms, for those that make shapes.
  MeshPool& meshes() { return meshes_; }
  /// Creates a static geom at the identity pose. Throws Error for an invalid shape.
  GeomHandle createGeom(SpaceHandle space, const engine::ShapeDescription& shape, void* owner);
  void destroyGeom(GeomHandle geom);
  /// Throws Error for an invalid shape; the geom keeps the old one.
  void setShape(GeomHandle geom, const engine::ShapeDescription& shape);
  /// Attaches the geom to a body, at an offset in the body's frame; none: static. Throws Error for an offset that is
  /// not finite, and for a height field with a body.
  void setBody(GeomHandle geom, BodyHandle body, const Pose& offset);
  /// Sets the world pose of a static geom. Planes ignore it.
  void setPose(GeomHandle geom, const Pose& pose);
  /// World pose of a geom.
  Pose pose(GeomHandle geom) const { return poseOf(model_, state_, geoms_[geom]); }
  /// See Geom::part.
  void setPart(GeomHandle geom, int part);
  /// What single engines know: see Model::extensions.
  void setBlocks(const engine::Blocks& blocks);
  /// Sets the input of a block of the world; endInput() takes it back.
  void setInput(std::uint64_t kind, double value);
  void endInput(std::uint64_t kind);
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
  /// Ignored for parameters and axes that the joint does not have, and for values that make no sense.
  void setParameter(JointHandle joint, engine::JointParameter p, int axis, double v);
  /// 0 for parameters and axes that the joint does not have.
  double parameter(JointHandle joint, engine::JointParameter p, int axis) const;
  /// The first parameters of an axis, in the order of JointParameter, as many as `out` takes.
  void parameters(JointHandle joint, int axis, std::span<double> out) const;
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
  /// Where its axes are.
  JointAt at(JointHandle joint) const { return {kinematics_, joints_[joint]}; }
  /// Restores the turns of an axis: JointKinematics::load().
  void loadCoordinate(JointHandle joint, int axis, double angle) { kinematics_.load(joints_[joint], axis, angle); }
  void setFeedback(JointHandle joint, bool on);  ///< true: steps measure forces and torques of the joint
  /// Force [N] and torque [Nm] on the first and the second body in the last step; zero without feedback.
  void feedback(JointHandle joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const;
  engine::Index index(JointHandle joint) const { return joints_[joint]; }

  // For steps (stepper.h).
  WorldData& data() { return data_; }
  JointKinematics& kinematics() { return kinematics_; }
  BodyWatch& watch() { return watch_; }
  /// Removes dead elements from the arrays and gives the others their new indices.
  void compact();
  /// The geoms that were edited since clearEdited(), each once, in that order.
  std::span<const engine::Index> edited() const { return edited_; }
  void clearEdited();
  BodyHandle handleOf(engine::Index body) const { return bodies_.handleOf(body); }

 private:
  engine::DynamicState& of(BodyHandle body) { return state_.bodies[bodies_[body]]; }
  const engine::DynamicState& of(BodyHandle body) const { return state_.bodies[bodies_[body]]; }
  engine::Joint& of(JointHandle joint) { return model_.joints[joints_[joint]]; }
  const engine::Joint& of(JointHandle joint) const { return model_.joints[joints_[joint]]; }
  engine::Index indexOf(const engine::Joint& joint) const {
    return static_cast<engine::Index>(&joint - model_.joints.data());
  }
  const engine::DynamicState* stateAt(engine::Index body) const { return data_.stateAt(body); }
  template <class T>
  T rounded(const T& v) const {
    return data_.rounded(v);
  }
  void markEdited(engine::Index geom);
  void detach(engine::Index joint);
  /// Wakes the bodies of a joint: see BodyWatch::rouse().
  void rouse(const engine::Joint& joint);
  void compactWhenMany();
  void endControl(engine::Index joint, int axis);
  void listControls();
  /// Passes the motor of an axis on; where there is none, its dry friction acts in its place.
  void passMotor(engine::Index joint, int axis);

  // Frames of joints (world_joints.cpp).
  void remember(engine::Joint& joint, engine::JointCall::Kind kind, int axis, const Vec3& world, int frame = 0);
  void restart(const engine::Joint& joint) { kinematics_.restart(indexOf(joint)); }
  void anchorSet(engine::Joint& j, const Vec3& world);
  void axisSet(engine::Joint& j, int axis, const Vec3& world, int frame);
  void setRelativeRotation(engine::Joint& j);
  void setUniversalFrames(engine::Joint& j);
  void setHinge2Planes(engine::Joint& j);
  void setHinge2Axes(engine::Joint& j);
  void setSliderOffset(engine::Joint& j);
  void setEulerReferences(engine::Joint& j);

  WorldData data_;
  engine::Model& model_ = data_.model;
  engine::State& state_ = data_.state;
  JointKinematics kinematics_{data_};
  BodyWatch watch_{data_};
  Handles<BodyHandle> bodies_;
  Handles<SpaceHandle> spaces_;
  MeshPool meshes_;
  Handles<GeomHandle> geoms_;
  Handles<JointHandle> joints_;
  std::vector<engine::Index> edited_;                    ///< see edited()
  std::vector<std::uint8_t> geomEdited_;                 ///< by geom: it is in `edited_`
  std::vector<engine::Motors> motors_;                   ///< by joint: as they were set
  std::vector<std::array<engine::Index, 3>> controlAt_;  ///< by joint and axis: its place in State::controls
  std::uint64_t nextId_ = 1, attachments_ = 0, settings_ = 0;
};

}  // namespace spark::physics
