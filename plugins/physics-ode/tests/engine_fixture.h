#pragma once
/// \file
/// A house with only the engine, and short ways to bodies and geoms.

#include <catch2/catch.hpp>

#include "api/engine.h"
#include "test_support.h"

namespace spark::test {

struct EngineHouse : House {
  engine::IEngine& ode;
  engine::World world;
  engine::Space space;
  engine::Contacts contacts;
  EngineHouse() : ode(make(*this)), world(ode.createWorld()), space(ode.createSpace(world, engine::Space::none)) {}
  static engine::IEngine& make(House& h) {
    h.kernel.plugins().use("physics-ode");
    return h.kernel.create<engine::IEngine>("OdeEngine", "/sys/server/physics/engine");
  }
  void setGravity(double g, bool autoDisable = false) {
    engine::WorldParameters p;
    p.gravity = {0, 0, -g};
    p.autoDisable = autoDisable;
    ode.setWorldParameters(world, p);
  }
  engine::Body body(const Vec3& at) {
    const engine::Body b = ode.createBody(world);
    ode.setPosition(b, at);
    return b;
  }
  engine::Geom geom(const engine::ShapeDescription& shape, engine::Body b = engine::Body::none,
                    const Pose& offset = {}) {
    const engine::Geom g = ode.createGeom(space, shape, nullptr);
    ode.setBody(g, b, offset);
    return g;
  }
  /// One step of dt in which all contacts are solved with `surface`.
  void step(double dt = 0.02, const engine::Surface& surface = {}) {
    contacts.clear();
    ode.detect(world, nullptr, 4, contacts);
    for (auto& c : contacts) c.solve = true, c.surface = surface;
    ode.step(world, contacts, dt);
  }
  Vec3 position(engine::Body b) const { return ode.state(b).position; }
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
/// A cube of edge `e` as triangles.
inline engine::ShapeDescription mesh(double e) {
  engine::ShapeDescription s;
  s.shape = engine::Shape::mesh;
  const double h = e / 2;
  s.vertices = {-h, -h, -h, h, -h, -h, h, h, -h, -h, h, -h, -h, -h, h, h, -h, h, h, h, h, -h, h, h};
  s.triangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  return s;
}

}  // namespace spark::test
