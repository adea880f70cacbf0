#pragma once
/// \file
/// A world with ODE's collision detection and engine, and helpers that make bodies and geoms.

#include <catch2/catch.hpp>

#include "../../physics/stepper.h"
#include "test_support.h"

namespace spark::test {

struct EngineHost : TestHost {
  engine::ICollision& collision;
  engine::IEngine& engine;
  physics::WorldModel world;
  physics::Stepper stepper{world};
  physics::SpaceHandle space;
  engine::Contacts contacts;
  explicit EngineHost(bool exactReplay = false)
      : collision(make<engine::ICollision>(*this, "OdeCollision", "/sys/server/physics/collision")),
        engine(make<engine::IEngine>(*this, "OdeEngine", "/sys/server/physics/engine")),
        world(exactReplay),
        space(world.createSpace(physics::SpaceHandle::none)) {}
  template <class Interface>
  static Interface& make(TestHost& h, const char* name, const char* path) {
    h.kernel.plugins().use("physics-ode");
    return h.kernel.create<Interface>(name, path);
  }
  void setGravity(double g, bool autoDisable = false) {
    engine::WorldParameters p;
    p.gravity = {0, 0, -g};
    p.autoDisable = autoDisable;
    world.setParameters(p);
  }
  physics::BodyHandle body(const Vec3& at) {
    const physics::BodyHandle b = world.createBody();
    world.setPosition(b, at);
    return b;
  }
  physics::GeomHandle geom(const engine::ShapeDescription& shape, physics::BodyHandle b = physics::BodyHandle::none,
                           const Pose& offset = {}) {
    const physics::GeomHandle g = world.createGeom(space, shape, nullptr);
    world.setBody(g, b, offset);
    return g;
  }
  /// Appends the detected contacts to `contacts`.
  void detect(int perPair = 4, engine::PairFilter filter = nullptr) {
    stepper.detect(engine, &collision, filter, perPair, contacts);
  }
  /// Makes one step of dt [s]. All contacts are solved with `surface`.
  void step(double dt = 0.02, const engine::Surface& surface = {}) {
    contacts.clear();
    detect();
    for (auto& c : contacts) c.solve = true, c.surface = surface;
    stepper.step(engine, contacts, dt);
  }
  Vec3 position(physics::BodyHandle b) const { return world.state(b).position; }
};

inline engine::ShapeDescription box(double x, double y, double z) {
  engine::ShapeDescription s;
  s.shape = engine::Shape::box;
  s.lengths = {x, y, z};
  return s;
}
inline engine::ShapeDescription round(engine::Shape shape, double radius, double length = 1) {
  engine::ShapeDescription s;
  s.shape = shape;
  s.radius = radius;
  s.length = length;
  return s;
}
inline engine::ShapeDescription plane(double a, double b, double c, double d) {
  engine::ShapeDescription s;
  s.shape = engine::Shape::plane;
  s.plane[0] = a, s.plane[1] = b, s.plane[2] = c, s.plane[3] = d;
  return s;
}
inline engine::ShapeDescription ray(const Vec3& from, const Vec3& direction, double length) {
  engine::ShapeDescription s;
  s.shape = engine::Shape::ray;
  s.rayOrigin = from;
  s.rayDirection = direction;
  s.length = length;
  return s;
}
/// A cube with edges of length `e` as a triangle mesh.
inline engine::ShapeDescription mesh(double e) {
  const double h = e / 2;
  engine::Mesh m;
  m.vertices = {-h, -h, -h, h, -h, -h, h, h, -h, -h, h, -h, -h, -h, h, h, -h, h, h, h, h, -h, h, h};
  m.triangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  return {.shape = engine::Shape::mesh, .mesh = std::make_shared<const engine::Mesh>(std::move(m))};
}

}  // namespace spark::test
