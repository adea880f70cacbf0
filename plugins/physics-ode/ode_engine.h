#pragma once
/// \file
/// The engine interface on ODE 0.16 in double precision. ODE's types do not leave this folder.
///
/// What this engine does differently from plain ODE, and why:
///  - Auto-disable: ODE's rule with ODE's thresholds, but the counters are kept here, where they can be saved. A
///  restored
///    world continues bit for bit.
///  - Order of pairs: the order in which ODE's spaces report pairs depends on history. Here pairs are collected, sorted
///  by
///    the age of their geoms, and then collided: the same tree in the same state gives the same contacts. (Except with
///    `exactReplay`: see README.md.)
///  - Spaces: each space collides its own geoms once per step.
///  - Large islands: the time of the direct solver grows with the cube of an island's constraints; thirty robots that
///  are
///    created in one place would take minutes. Islands of more than `directRows` rows are solved by ODE's iterative
///    solver (ode_islands.cpp).
///  - Solver: a child that offers engine::ISolver steps the islands that it can handle. ODE keeps bodies, joints and
///    geoms, detects contacts, and steps the deferred islands, which are all islands without such a child
///    (ode_solver.cpp).
///  - Faults: a body whose state is not finite after a step is reset to its last valid pose, at rest. Setters reject
///    numbers that are not finite.
///
///     detect:  sweep and prune -> close pairs -> filters -> sort -> narrow phase -> contacts
///     step:    contacts -> pairs of bodies -> auto-disable -> solver -> deferred islands: contact joints, dWorldStep
///              (large islands: dWorldQuickStep), feedback -> faults

#include <memory>
#include <vector>

#include "api/engine.h"
#include "api/solver.h"
#include "ode_process.h"
#include "ode_world.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// ODE as the engine of the physics server.
class OdeEngine : public Node, public engine::IEngine {
  SPARK_CLASS(OdeEngine, Node)
 public:
  ~OdeEngine() override;
  static void describe(Description<OdeEngine>& d) {
    d.doc(
        "Rigid bodies by the Open Dynamics Engine (direct solver). A child that offers ISolver replaces ODE's solver "
        "for "
        "the islands that it can handle.");
    d.implements<engine::IEngine>();
    d.property("version", &OdeEngine::version).doc("Configuration of the library.");
    d.property("directRows", &OdeEngine::directRows_)
        .min(0)
        .doc(
            "Maximum number of constraint rows (three per contact) of islands for the direct solver; larger islands "
            "are "
            "solved iteratively, which is approximate.");
    d.property("exactReplay", &OdeEngine::exactReplay_)
        .doc(
            "Worlds created from now on repeat recorded sessions of the installed base to the last digit: numbers at "
            "the "
            "engine interface are rounded to single precision, and contacts are solved in the order in which ODE's "
            "hash "
            "spaces report them.");
    d.property("approximateSteps", &OdeEngine::approximateSteps)
        .doc("Number of steps with an iteratively solved island.");
    d.property("messages", &OdeEngine::messages).doc("Number of error and warning messages from ODE.");
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
  /// Creates ODE's geom for g.shape; the caller places it.
  void createShape(ode::GeomData& g);
  /// Passes body, offset and pose of a geom to ODE.
  void place(ode::GeomData& g);
  /// Finds the bodies of each contact and counts constraint rows.
  void findContactPairs(ode::WorldData& w, const engine::Contacts& contacts);
  /// Auto-disable: puts bodies to sleep that have been idle long enough.
  void autoDisable(ode::WorldData& w, double dt);
  /// The child that offers a solver, as of the last change of the tree. nullptr: none; all bodies are deferred to ODE.
  engine::ISolver* solver();
  /// Steps the islands that the solver can handle. Returns the number of deferred bodies.
  std::size_t stepBySolver(ode::WorldData& w, engine::ISolver& solver, engine::Contacts& contacts, double dt);
  /// Steps all deferred bodies.
  void stepByOde(ode::WorldData& w, engine::Contacts& contacts, double dt);
  void addContactJoints(ode::WorldData& w, const engine::Contacts& contacts);
  void readFeedback(ode::WorldData& w, engine::Contacts& contacts);
  /// Runs ODE's solvers: the direct one, and the iterative one for islands that are too large for it.
  void solve(ode::WorldData& w, double dt);
  /// Runs dWorldStep, with the islands distributed over the kernel's threads.
  void solveDirectly(ode::WorldData& w, double dt);
  /// Computes the angles of all hinges that were read since the last step.
  void cacheAngles(ode::WorldData& w);
  /// Updates the awake flags and resets bodies with an invalid state. `byOde`: ODE's solver has run.
  void checkBodies(ode::WorldData& w, bool byOde);
  /// Logs the last message from ODE: the 1st, 2nd, 4th, 8th ... time.
  void report();

  ode::LibraryGuard library_;
  std::vector<std::unique_ptr<ode::WorldData>> worlds_;
  std::string odeMessage_;  ///< the last message from ODE that was not reported yet
  std::int64_t messages_ = 0, approximateSteps_ = 0;
  engine::ISolver* solver_ = nullptr;
  TreeWatch tree_;                ///< state of the tree in which solver_ was looked up
  std::uint64_t structures_ = 0;  ///< last value of a WorldData::structure
  int directRows_ = 1200;
  bool exactReplay_ = false;
};

}  // namespace spark
