#pragma once
/// \file
/// The same scene in two worlds. ODE's direct solver steps one of them, the articulated engine the other. Before each
/// step the state of the first is copied to the second; after it, the states and forces of both must agree.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "../../physics/stepper.h"
#include "test_support.h"

namespace spark::test {

/// All joint types.
inline constexpr engine::JointType kTypes[] = {
    engine::JointType::ball,      engine::JointType::hinge, engine::JointType::hinge2,      engine::JointType::slider,
    engine::JointType::universal, engine::JointType::fixed, engine::JointType::angularMotor};

/// A world with its engine, and its bodies and joints in order of creation.
struct Scene {
  engine::ICollision& collision;
  engine::IEngine* engine = nullptr;  ///< owned by the kernel
  physics::WorldModel world;
  physics::Stepper stepper{world};
  physics::SpaceHandle space = world.createSpace(physics::SpaceHandle::none);
  engine::Contacts contacts;
  std::vector<physics::BodyHandle> bodies;
  std::vector<physics::JointHandle> joints;
  explicit Scene(engine::ICollision& c) : collision(c) {}
  void step(double dt) { stepper.step(*engine, contacts, dt); }
};

/// Largest differences between the two worlds. Velocities and feedback are relative to the largest in the world;
/// position is in m, or an element of the rotation matrix.
struct Differences {
  double velocity = 0, position = 0, feedback = 0;
};

/// Builds the scene in both worlds and steps it. All random numbers come from `random`, so a scene depends only on its
/// seed.
class Twins : public TestHost {
 public:
  Scene plain, solved;  ///< stepped by ODE alone; stepped by the articulated engine
  engine::WorldParameters parameters;
  engine::Surface surface;  ///< of all contacts
  double dt = 0.02;         ///< s
  std::mt19937 random;

  explicit Twins(unsigned seed = 1)
      : plain(makeCollision(kernel, "/sys/plain/collision")),
        solved(makeCollision(kernel, "/sys/solved/collision")),
        random(seed) {
    kernel.plugins().use("physics-articulated");
    plain.engine = &kernel.create<engine::IEngine>("OdeEngine", "/sys/plain/engine");
    newEngine();
    parameters.autoDisable = false;
    apply();
  }
  /// Replaces the articulated engine by a new one, which has no warm start.
  void newEngine() {
    if (Leaf* old = kernel.root().find(kSolvedEngine)) old->parent()->remove(*old);
    auto& made = kernel.create<Node>("ArticulatedEngine", kSolvedEngine);
    made.create("OdeEngine", "deferred");
    solved.engine = made.as<engine::IEngine>();
  }
  /// Sets `parameters` in both worlds.
  void apply() {
    forBoth([&](Scene& s) { s.world.setParameters(parameters); });
  }
  /// Calls f for both scenes.
  template <class F>
  void forBoth(F&& f) {
    f(plain);
    f(solved);
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  /// A random integer in 0..n-1.
  int randomInt(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
  /// A random vector with elements in -size..size.
  Vec3 randomVector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Mat3 randomRotation() {
    return (Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitX()) * Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitY()) *
            Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitZ()))
        .toRotationMatrix();
  }
  /// The inertia of a box with edges of size / 2 .. size [m] in a random orientation.
  Mat3 randomInertia(double mass, double size) {
    const Mat3 r = randomRotation();
    const Vec3 sizes(uniform(0.5, 1), uniform(0.5, 1), uniform(0.5, 1));
    const Vec3 squares = sizes.cwiseProduct(sizes) * size * size;
    return r *
           (mass / 12 * Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
               .asDiagonal() *
           r.transpose();
  }

  /// Adds a body; returns its index in Scene::bodies.
  std::size_t body(const Vec3& at, double mass, const Mat3& inertia, const Mat3& rotation = Mat3::Identity()) {
    forBoth([&](Scene& s) {
      const physics::BodyHandle b = s.world.createBody();
      s.world.setMass(b, {mass, Vec3::Zero(), inertia});
      s.world.setPosition(b, at);
      s.world.setRotation(b, rotation);
      s.bodies.push_back(b);
    });
    return plain.bodies.size() - 1;
  }
  std::size_t randomBody(const Vec3& at) {
    const double mass = uniform(0.1, 3);
    return body(at, mass, randomInertia(mass, 0.3), randomRotation());
  }
  /// Adds a geom to a body; -1: static.
  void geom(const engine::ShapeDescription& shape, int body) {
    forBoth([&](Scene& s) {
      const physics::GeomHandle g = s.world.createGeom(s.space, shape, nullptr);
      s.world.setBody(g, body < 0 ? physics::BodyHandle::none : s.bodies[static_cast<std::size_t>(body)], {});
    });
  }
  /// Makes a new space for the geoms that are added from now on. They do not collide with each other.
  void newSpace() {
    forBoth([&](Scene& s) {
      s.space = s.world.createSpace(physics::SpaceHandle::none);
      s.world.setInnerCollision(s.space, false);
    });
  }
  /// A static plane at z = 0.
  void ground() {
    engine::ShapeDescription s;
    s.shape = engine::Shape::plane;
    geom(s, -1);
  }
  void box(const Vec3& lengths, std::size_t body) {
    engine::ShapeDescription s;
    s.lengths = lengths;
    geom(s, static_cast<int>(body));
  }
  /// Adds a joint between two bodies; -1: the world. Returns its index in Scene::joints.
  std::size_t joint(engine::JointType type, int a, int b, bool feedback = true) {
    forBoth([&](Scene& s) {
      const auto of = [&](int i) { return i < 0 ? physics::BodyHandle::none : s.bodies[static_cast<std::size_t>(i)]; };
      const physics::JointHandle j = s.world.createJoint(type);
      s.world.attach(j, of(a), of(b));
      s.world.setFeedback(j, feedback);
      s.joints.push_back(j);
    });
    return plain.joints.size() - 1;
  }
  /// Calls f(world, joint) for both scenes.
  template <class F>
  void forBothJoints(std::size_t joint, F&& f) {
    forBoth([&](Scene& s) { f(s.world, s.joints[joint]); });
  }
  void set(std::size_t joint, engine::JointParameter p, int axis, double v) {
    forBothJoints(joint, [&](physics::WorldModel& w, physics::JointHandle j) { w.setParameter(j, p, axis, v); });
  }

  /// Gives all bodies random velocities, forces and torques.
  void shake(double speed = 1) {
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      const Vec3 v = randomVector(speed), w = randomVector(3 * speed), f = randomVector(2 * speed),
                 q = randomVector(speed);
      forBoth([&](Scene& s) {
        s.world.setLinearVelocity(s.bodies[i], v);
        s.world.setAngularVelocity(s.bodies[i], w);
        s.world.addForce(s.bodies[i], f);
        s.world.addTorque(s.bodies[i], q);
      });
    }
  }
  /// Steps both worlds, each time from the state of `plain`, and checks that they agree: velocities and positions to
  /// 1e-8, feedback to `forces`.
  void checkSteps(int steps, double forces = 1e-6) {
    Differences worst;
    for (int i = 0; i < steps; ++i) {
      const Differences d = step();
      worst.velocity = std::max(worst.velocity, d.velocity);
      worst.position = std::max(worst.position, d.position);
      worst.feedback = std::max(worst.feedback, d.feedback);
    }
    CHECK(worst.velocity < 1e-8);
    CHECK(worst.position < 1e-8);
    CHECK(worst.feedback < forces);
    CHECK(counted("islands") > 0);
    CHECK(counted("deferredIslands") == 0);
  }

  /// Makes one step of both worlds from the state of `plain`.
  Differences step() {
    copyState();
    Differences d;
    forBoth([&](Scene& s) {
      detectContacts(s);
      s.step(dt);
    });
    REQUIRE(plain.contacts.size() == solved.contacts.size());
    compare(d);
    return d;
  }
  /// Detects contacts and stores them in Scene::contacts.
  void detectContacts(Scene& s) {
    s.contacts.clear();
    s.stepper.detect(*s.engine, &s.collision, nullptr, 4, s.contacts);
    for (auto& c : s.contacts) c.solve = c.feedback = true, c.surface = surface;
  }
  /// Copies the state of `plain` to `solved`.
  void copyState() {
    std::vector<double> state;
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      state.clear();
      plain.world.saveBody(plain.bodies[i], state);
      solved.world.loadBody(solved.bodies[i], state);
    }
  }
  /// The articulated engine.
  Leaf& articulated() { return kernel.root().require<Leaf>(kSolvedEngine); }
  /// A counter of the articulated engine.
  std::int64_t counted(const char* property) { return getProperty(articulated(), property).toInteger(); }
  /// Path of the engine of `solved`.
  static constexpr const char* kSolvedEngine = "/sys/solved/engine";

 private:
  static engine::ICollision& makeCollision(Kernel& kernel, const char* path) {
    kernel.plugins().use("physics-ode");
    return kernel.create<engine::ICollision>("OdeCollision", path);
  }
  void compare(Differences& d) {
    double largestVelocity = 1e-3, largestForce = 1e-3;
    double velocity = 0, force = 0;
    const auto differ = [](const Vec3& a, const Vec3& b, double& difference, double& size) {
      difference = std::max(difference, (a - b).norm());
      size = std::max(size, a.norm());
      if (!a.allFinite() || !b.allFinite()) difference = HUGE_VAL;
    };
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      const engine::BodyState a = plain.world.state(plain.bodies[i]), b = solved.world.state(solved.bodies[i]);
      differ(a.linearVelocity, b.linearVelocity, velocity, largestVelocity);
      differ(a.angularVelocity, b.angularVelocity, velocity, largestVelocity);
      d.position = std::max({d.position, (a.position - b.position).norm(), (a.rotation - b.rotation).norm()});
      CHECK(plain.world.enabled(plain.bodies[i]) == solved.world.enabled(solved.bodies[i]));
    }
    for (std::size_t i = 0; i < plain.joints.size(); ++i) {
      Vec3 a[4], b[4];
      plain.world.feedback(plain.joints[i], a[0], a[1], a[2], a[3]);
      solved.world.feedback(solved.joints[i], b[0], b[1], b[2], b[3]);
      for (int k = 0; k < 4; ++k) differ(a[k], b[k], force, largestForce);
    }
    for (std::size_t i = 0; i < plain.contacts.size(); ++i)
      differ(plain.contacts[i].forceOnA, solved.contacts[i].forceOnA, force, largestForce);
    d.velocity = velocity / largestVelocity;
    d.feedback = force / largestForce;
  }
};

}  // namespace spark::test
