#pragma once
/// \file
/// A world with one of the engines, and helpers that make bodies, geoms and joints.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <optional>

#include "../../plugins/physics/stepper.h"
#include "test_support.h"

namespace spark::test {

using engine::JointParameter;
using engine::JointType;
using engine::Shape;
using physics::BodyHandle;
using physics::GeomHandle;
using physics::JointHandle;

/// An engine that is tested.
struct EngineKind {
  const char* name;  ///< its class
  const char* plugin;
  bool built() const {
    return std::string(plugin) == "point-masses" || std::string(plugin) == "late-contacts" ||
           std::filesystem::exists(pluginFolder() / (std::string(plugin) + ".so"));
  }
};

/// All engines. The last two are examples: a minimal engine, and one whose contacts appear within its step.
inline const EngineKind kEngines[] = {
    {"OdeEngine", "physics-ode"},        {"ArticulatedEngine", "physics-articulated"},
    {"MujocoEngine", "physics-mujoco"},  {"BulletEngine", "physics-bullet"},
    {"PointMassEngine", "point-masses"}, {"LateEngine", "late-contacts"},
};

/// Lets a kernel find the plugins of all engines.
inline void scanEngines(Kernel& kernel) {
  kernel.plugins().scan(pluginFolder().parent_path() / "tests" / "engine-plugins");
}

/// Keeps the plugins of all engines loaded, see loadedPlugins().
inline void keepEnginesLoaded() { [[maybe_unused]] static const bool loaded = (scanEngines(*loadedPlugins()), true); }

/// A shape with triangles: a mesh, or a convex one.
inline engine::ShapeDescription meshOf(engine::Mesh mesh, Shape shape = Shape::mesh) {
  return {.shape = shape, .mesh = std::make_shared<const engine::Mesh>(std::move(mesh))};
}

struct EngineWorld : TestHost, engine::IContactSink {
  const EngineKind& kind;
  engine::ICollision* collision = nullptr;  ///< nullptr: the engine detects contacts
  engine::IEngine* engine;
  engine::Capabilities can;
  physics::WorldModel world;
  physics::Stepper stepper{world};
  physics::SpaceHandle space;
  engine::Contacts contacts;
  engine::Surface surface;  ///< of all contacts
  double dt = 0.01;         ///< s
  int most = 4;             ///< contacts of two geoms
  bool solve = true;        ///< contacts with a body are solved

  explicit EngineWorld(const EngineKind& k, bool exactReplay = false)
      : kind(k), world(exactReplay), space(world.createSpace(physics::SpaceHandle::none)) {
    keepEnginesLoaded();
    scanEngines(kernel);
    kernel.plugins().use("physics-ode");
    kernel.plugins().use(k.plugin);
    makeEngine();
    makeCollision();
    setGravity(9.81);
  }
  /// ODE's collision detection, unless the engine has its own.
  void makeCollision() {
    if (!can.findsContacts()) collision = &kernel.create<engine::ICollision>("OdeCollision", "/sys/collision");
  }
  void makeEngine() {
    engine = &kernel.create<engine::IEngine>(kind.name, "/sys/engine");
    can = engine->capabilities();
    if (std::string(kind.name) == "ArticulatedEngine") kernel.create("OdeEngine", "/sys/engine/deferred");
  }
  /// Replaces the engine by a new one.
  void replaceEngine() {
    engine->leaf().parent()->remove(engine->leaf());
    makeEngine();
  }
  void replaceCollision() {
    if (!collision) return replaceEngine();
    collision->leaf().parent()->remove(collision->leaf());
    makeCollision();
  }
  void setGravity(double g, bool autoDisable = false) {
    engine::WorldParameters p;
    p.gravity = {0, 0, -g};
    p.autoDisable = autoDisable;
    world.setParameters(p);
  }

  BodyHandle body(const Vec3& at, double mass = 1, const Mat3& inertia = Mat3::Identity() * 0.1) {
    const BodyHandle b = world.createBody();
    world.setPosition(b, at);
    world.setMass(b, {mass, Vec3::Zero(), inertia});
    return b;
  }
  GeomHandle geom(const engine::ShapeDescription& shape, BodyHandle b = BodyHandle::none, const Pose& offset = {},
                  void* owner = nullptr) {
    const GeomHandle g = world.createGeom(space, shape, owner);
    world.setBody(g, b, offset);
    return g;
  }
  /// A body with the collider and the mass of a box.
  BodyHandle block(const Vec3& at, const Vec3& edges, double mass = 1) {
    const Vec3 squares = edges.cwiseProduct(edges);
    const BodyHandle b = body(at, mass, Mat3((Vec3::Constant(squares.sum()) - squares).asDiagonal()) * (mass / 12));
    geom({.shape = Shape::box, .lengths = edges}, b);
    return b;
  }
  BodyHandle sphere(const Vec3& at, double radius, double mass = 1) {
    const BodyHandle b = body(at, mass, Mat3::Identity() * (0.4 * mass * radius * radius));
    geom({.shape = Shape::sphere, .radius = radius}, b);
    return b;
  }
  /// A static plane at z = 0.
  void ground() { geom({.shape = Shape::plane}); }
  JointHandle joint(JointType type, BodyHandle a, BodyHandle b, const Vec3& at, const Vec3& axis = Vec3::UnitZ(),
                    const Vec3& second = Vec3::UnitX()) {
    const JointHandle j = world.createJoint(type);
    world.attach(j, a, b);
    world.setAnchor(j, at);
    if (type == JointType::angularMotor) world.setAngularMotor(j, 2, false);
    world.setAxis(j, 0, axis, 1);
    world.setAxis(j, 1, second, 2);
    world.setFixed(j);
    return j;
  }
  void motor(JointHandle j, int axis, double speed, double force) {
    world.setParameter(j, JointParameter::maxForce, axis, force);
    world.drive(j, axis, speed);
  }
  void stops(JointHandle j, int axis, double low, double high) {
    world.setParameter(j, JointParameter::lowStop, axis, low);
    world.setParameter(j, JointParameter::highStop, axis, high);
    world.setParameter(j, JointParameter::stopErp, axis, 0.5);
  }

  int perPair() const override { return most; }
  bool decide(std::span<engine::Contact> points) override {
    for (engine::Contact& c : points) {
      c.solve = solve && (c.bodyA != engine::kNone || c.bodyB != engine::kNone);
      c.feedback = true;
      c.surface = surface;
    }
    return true;
  }
  void report(std::span<const engine::Contact> found) override {
    contacts.assign(found.begin(), found.end());
    std::stable_sort(contacts.begin(), contacts.end(), [&](const engine::Contact& a, const engine::Contact& b) {
      return std::pair(a.geomA, a.geomB) < std::pair(b.geomA, b.geomB);
    });
  }
  /// Finds the contacts of the present poses, before a step; a late engine finds them in it.
  void detect() {
    if (can.late) return;
    contacts.clear();
    stepper.detect(*engine, collision, nullptr, most, contacts);
    decide(contacts);
  }
  /// The step after detect().
  void step() { stepper.step(*engine, contacts, dt, this); }
  /// Finds the contacts: before a step, or in one of nearly no time.
  void touch() {
    detect();
    if (!can.late) return;
    stepper.step(*engine, contacts, 1e-9, this);
  }
  /// Steps the world. All contacts are solved.
  void run(double seconds) {
    for (int i = 0, n = static_cast<int>(std::lround(seconds / dt)); i < n; ++i) {
      detect();
      step();
    }
  }
  Vec3 position(BodyHandle b) const { return world.state(b).position; }
  Vec3 velocity(BodyHandle b) const { return world.state(b).linearVelocity; }
  Vec3 spin(BodyHandle b) const { return world.state(b).angularVelocity; }
  std::vector<double> saved(std::span<const BodyHandle> bodies) const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    return out;
  }
};

/// Runs a test with each engine that has the capabilities `needs`.
template <class F>
void withEngines(F&& f, std::initializer_list<bool engine::Capabilities::*> needs = {}) {
  for (const EngineKind& kind : kEngines) {
    if (!kind.built()) continue;
    INFO(kind.name);
    EngineWorld w(kind);
    if (std::all_of(needs.begin(), needs.end(), [&](auto need) { return w.can.*need; })) f(w);
  }
}

}  // namespace spark::test
