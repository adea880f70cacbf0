#pragma once
/// \file
/// The same scene in two engines: one steps by ODE alone, the other by the solver. Before every step the second takes
/// over the first one's state; after it, what they say must agree.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "api/engine.h"
#include "test_support.h"

namespace spark::test {

/// Every type of joint.
inline constexpr engine::JointType kTypes[] = {
    engine::JointType::ball,      engine::JointType::hinge, engine::JointType::hinge2,      engine::JointType::slider,
    engine::JointType::universal, engine::JointType::fixed, engine::JointType::angularMotor};

/// One engine's world with what was put into it.
struct Scene {
  engine::IEngine& engine;
  engine::World world;
  engine::Space space;
  engine::Contacts contacts;
  std::vector<engine::Body> bodies;
  std::vector<engine::Joint> joints;
  explicit Scene(engine::IEngine& e)
      : engine(e), world(e.createWorld()), space(e.createSpace(world, engine::Space::none)) {}
};

/// Largest differences found.
struct Differences {
  double velocity = 0, place = 0, feedback = 0;  ///< relative to the largest in the world
};

class Twins : public House {
 public:
  Scene plain, solved;
  engine::WorldParameters parameters;
  engine::Surface surface;
  double dt = 0.02;
  std::mt19937 random;

  explicit Twins(unsigned seed = 1)
      : plain(make(kernel, "/sys/plain")), solved(make(kernel, "/sys/solved")), random(seed) {
    kernel.plugins().use("physics-articulated");
    newSolver();
    parameters.autoDisable = false;
    apply();
  }
  /// A solver that remembers nothing.
  void newSolver() {
    if (solver_) solver_->parent()->remove(*solver_);
    solver_ = &kernel.create("ArticulatedSolver", "/sys/solved/solver");
  }
  void apply() {
    each([&](Scene& s) { s.engine.setWorldParameters(s.world, parameters); });
  }
  template <class F>
  void each(F&& f) {
    f(plain);
    f(solved);
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  int pick(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
  Vec3 anyVector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Mat3 anyRotation() {
    return (Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitX()) * Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitY()) *
            Eigen::AngleAxisd(uniform(-3, 3), Vec3::UnitZ()))
        .toRotationMatrix();
  }
  Mat3 anyInertia(double mass, double size) {
    const Mat3 r = anyRotation();
    const Vec3 sizes(uniform(0.5, 1), uniform(0.5, 1), uniform(0.5, 1));
    const Vec3 squares = sizes.cwiseProduct(sizes) * size * size;
    return r *
           (mass / 12 * Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
               .asDiagonal() *
           r.transpose();
  }

  std::size_t body(const Vec3& at, double mass, const Mat3& inertia, const Mat3& rotation = Mat3::Identity()) {
    each([&](Scene& s) {
      const engine::Body b = s.engine.createBody(s.world);
      s.engine.setMass(b, {mass, Vec3::Zero(), inertia});
      s.engine.setPosition(b, at);
      s.engine.setRotation(b, rotation);
      s.bodies.push_back(b);
    });
    return plain.bodies.size() - 1;
  }
  std::size_t anyBody(const Vec3& at) {
    const double mass = uniform(0.1, 3);
    return body(at, mass, anyInertia(mass, 0.3), anyRotation());
  }
  void geom(const engine::ShapeDescription& shape, int body) {
    each([&](Scene& s) {
      const engine::Geom g = s.engine.createGeom(s.space, shape, nullptr);
      s.engine.setBody(g, body < 0 ? engine::Body::none : s.bodies[static_cast<std::size_t>(body)], {});
    });
  }
  /// Geoms from now on stand in a space of their own and do not touch each other.
  void newSpace() {
    each([&](Scene& s) {
      s.space = s.engine.createSpace(s.world, engine::Space::none);
      s.engine.setInnerCollision(s.space, false);
    });
  }
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
  /// -1: the world.
  std::size_t joint(engine::JointType type, int a, int b, bool feedback = true) {
    each([&](Scene& s) {
      const auto of = [&](int i) { return i < 0 ? engine::Body::none : s.bodies[static_cast<std::size_t>(i)]; };
      const engine::Joint j = s.engine.createJoint(s.world, type);
      s.engine.attach(j, of(a), of(b));
      s.engine.setFeedback(j, feedback);
      s.joints.push_back(j);
    });
    return plain.joints.size() - 1;
  }
  template <class F>
  void eachJoint(std::size_t joint, F&& f) {
    each([&](Scene& s) { f(s.engine, s.joints[joint]); });
  }
  void set(std::size_t joint, engine::JointParameter p, int axis, double v) {
    eachJoint(joint, [&](engine::IEngine& e, engine::Joint j) { e.setParameter(j, p, axis, v); });
  }

  /// Velocities of all bodies as `random` has them, and a push.
  void shake(double speed = 1) {
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      const Vec3 v = anyVector(speed), w = anyVector(3 * speed), f = anyVector(2 * speed), q = anyVector(speed);
      each([&](Scene& s) {
        s.engine.setLinearVelocity(s.bodies[i], v);
        s.engine.setAngularVelocity(s.bodies[i], w);
        s.engine.addForce(s.bodies[i], f);
        s.engine.addTorque(s.bodies[i], q);
      });
    }
  }
  /// Checks some steps, each from the plain one's state.
  void checkSteps(int steps, double forces = 1e-6) {
    Differences worst;
    for (int i = 0; i < steps; ++i) {
      const Differences d = step();
      worst.velocity = std::max(worst.velocity, d.velocity);
      worst.place = std::max(worst.place, d.place);
      worst.feedback = std::max(worst.feedback, d.feedback);
    }
    CHECK(worst.velocity < 1e-8);
    CHECK(worst.place < 1e-8);
    CHECK(worst.feedback < forces);
    CHECK(counted("islands") > 0);
    CHECK(counted("deferredIslands") == 0);
  }

  /// One step of both from the state of the plain one.
  Differences step(bool takeOver = true) {
    if (takeOver) copyState();
    Differences d;
    each([&](Scene& s) {
      touch(s);
      s.engine.step(s.world, s.contacts, dt);
    });
    REQUIRE(plain.contacts.size() == solved.contacts.size());
    compare(d);
    return d;
  }
  /// Finds contacts.
  void touch(Scene& s) {
    s.contacts.clear();
    s.engine.detect(s.world, nullptr, 4, s.contacts);
    for (auto& c : s.contacts) c.solve = c.feedback = true, c.surface = surface;
  }
  void copyState() {
    std::vector<double> state;
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      state.clear();
      plain.engine.saveBody(plain.bodies[i], state);
      solved.engine.loadBody(solved.bodies[i], state);
    }
  }
  Leaf& solver() { return *solver_; }
  std::int64_t counted(const char* property) { return getProperty(*solver_, property).toInteger(); }

  /// Of velocities, as in Differences.
  double difference() {
    Differences d;
    compare(d);
    return d.velocity;
  }

 private:
  static engine::IEngine& make(Kernel& kernel, const char* path) {
    kernel.plugins().use("physics-ode");
    return kernel.create<engine::IEngine>("OdeEngine", path);
  }
  void compare(Differences& d) {
    double fastest = 1e-3, strongest = 1e-3;
    double velocity = 0, force = 0;
    const auto differ = [](const Vec3& a, const Vec3& b, double& difference, double& size) {
      difference = std::max(difference, (a - b).norm());
      size = std::max(size, a.norm());
      if (!a.allFinite() || !b.allFinite()) difference = HUGE_VAL;
    };
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      const engine::BodyState a = plain.engine.state(plain.bodies[i]), b = solved.engine.state(solved.bodies[i]);
      differ(a.linearVelocity, b.linearVelocity, velocity, fastest);
      differ(a.angularVelocity, b.angularVelocity, velocity, fastest);
      d.place = std::max({d.place, (a.position - b.position).norm(), (a.rotation - b.rotation).norm()});
      CHECK(plain.engine.enabled(plain.bodies[i]) == solved.engine.enabled(solved.bodies[i]));
    }
    for (std::size_t i = 0; i < plain.joints.size(); ++i) {
      Vec3 a[4], b[4];
      plain.engine.feedback(plain.joints[i], a[0], a[1], a[2], a[3]);
      solved.engine.feedback(solved.joints[i], b[0], b[1], b[2], b[3]);
      for (int k = 0; k < 4; ++k) differ(a[k], b[k], force, strongest);
    }
    for (std::size_t i = 0; i < plain.contacts.size(); ++i)
      differ(plain.contacts[i].forceOnA, solved.contacts[i].forceOnA, force, strongest);
    d.velocity = velocity / fastest;
    d.feedback = force / strongest;
  }
  Leaf* solver_ = nullptr;
};

}  // namespace spark::test
