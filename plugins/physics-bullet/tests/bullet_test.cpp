#include "../../../tests/engines/engine_world.h"

// What Bullet has beyond the suite of all engines (tests/engines).

using namespace spark;
using namespace spark::test;

namespace {

const EngineKind kOde{"OdeEngine", "physics-ode"}, kBullet{"BulletEngine", "physics-bullet"};

using Feedback = std::array<Vec3, 4>;
Feedback feedbackOf(EngineWorld& w, JointHandle j) {
  Feedback f;
  w.world.feedback(j, f[0], f[1], f[2], f[3]);
  return f;
}

/// A zigzag of four bodies that hangs from the world and swings; with a loop, between two places. Each second joint has
/// the upper body first.
std::vector<Feedback> chainForces(EngineWorld& w, bool loop) {
  w.dt = 0.0005;
  std::vector<BodyHandle> bodies;
  std::vector<JointHandle> joints;
  const auto at = [](int i) { return Vec3(i, 0, i % 2 ? 2.5 : 3); };
  for (int i = 0; i < 4; ++i) {
    bodies.push_back(w.body((at(i) + at(i + 1)) / 2, 1 + i, Mat3(Vec3(0.1, 0.2, 0.3).asDiagonal())));
    const BodyHandle above = i == 0 ? BodyHandle::none : bodies[static_cast<std::size_t>(i) - 1];
    const bool upperFirst = i % 2 == 1;
    joints.push_back(w.joint(JointType::hinge, upperFirst ? above : bodies.back(), upperFirst ? bodies.back() : above,
                             at(i), Vec3::UnitY()));
    w.motor(joints.back(), 0, 0, 3);
    w.world.setFeedback(joints.back(), true);
  }
  if (loop) {
    joints.push_back(w.joint(JointType::ball, bodies.back(), BodyHandle::none, at(4)));
    w.world.setFeedback(joints.back(), true);
  }
  w.world.addForce(bodies[1], {0, 5, 0});
  w.run(0.1);
  std::vector<Feedback> out;
  for (const JointHandle j : joints) out.push_back(feedbackOf(w, j));
  return out;
}

/// A box as a mesh.
engine::ShapeDescription meshBox(const Vec3& edges) {
  engine::Mesh s;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) s.vertices.push_back((i >> k & 1 ? 0.5 : -0.5) * edges[k]);
  s.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return {.shape = Shape::mesh, .mesh = std::make_shared<const engine::Mesh>(std::move(s))};
}

}  // namespace

TEST_CASE("joints carry the forces that they carry in ODE, with and without a loop") {
  const bool loop = GENERATE(false, true);
  EngineWorld bullet(kBullet), ode(kOde);
  const auto found = chainForces(bullet, loop), expected = chainForces(ode, loop);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      CAPTURE(loop, i, k, found[i][k].transpose(), expected[i][k].transpose());
      CHECK((found[i][k] - expected[i][k]).norm() < 0.03 * expected[0][0].norm());
    }
}

TEST_CASE("each shape rests on a plane, on a box and on a mesh") {
  const std::vector<engine::ShapeDescription> shapes{{.shape = Shape::box, .lengths = {0.4, 0.4, 0.4}},
                                                     {.shape = Shape::sphere, .radius = 0.2},
                                                     {.shape = Shape::capsule, .radius = 0.2, .length = 0.4},
                                                     {.shape = Shape::cylinder, .radius = 0.2, .length = 0.4},
                                                     meshBox({0.4, 0.4, 0.4})};
  const int on = GENERATE(0, 1, 2);
  for (const engine::ShapeDescription& shape : shapes) {
    CAPTURE(on, int(shape.shape));
    EngineWorld w(kBullet);
    if (on == 0) w.ground();
    const Vec3 below(3, 3, 1);
    if (on > 0)
      w.geom(on == 1 ? engine::ShapeDescription{.shape = Shape::box, .lengths = below} : meshBox(below),
             BodyHandle::none, {{0, 0, -0.5}, Mat3::Identity()});
    const bool lies = shape.shape == Shape::capsule;
    const BodyHandle b = w.body({0, 0, 0.22}, 2, Mat3::Identity() * 0.05);
    w.geom(shape, b,
           {Vec3::Zero(), lies ? Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix() : Mat3::Identity()});
    w.run(2);
    CHECK(w.position(b).z() == Approx(0.2).margin(0.004));
    CHECK(w.velocity(b).norm() < 0.01);
    double sum = 0;
    for (const engine::Contact& c : w.contacts) sum += c.forceOnA.z();
    CHECK(sum == Approx(2 * 9.81).epsilon(0.02));
  }
}

TEST_CASE("a stack stands whether its rows are solved directly or by iterations") {
  for (const int direct : {0, 1000}) {
    CAPTURE(direct);
    EngineWorld w(kBullet);
    setProperty(w.engine->leaf(), "direct", direct);
    w.ground();
    std::vector<BodyHandle> stack;
    for (int i = 0; i < 4; ++i) stack.push_back(w.block({0, 0, 0.2 + 0.4 * i}, {0.4, 0.4, 0.4}));
    w.run(3);
    for (int i = 0; i < 4; ++i) CHECK((w.position(stack[i]) - Vec3(0, 0, 0.2 + 0.4 * i)).norm() < 0.01);
  }
}

TEST_CASE("a shape that is set anew counts in the next step") {
  EngineWorld w(kBullet);
  w.setGravity(0);
  w.ground();
  const BodyHandle b = w.body({0, 0, 1});
  const GeomHandle g = w.geom({.shape = Shape::sphere, .radius = 0.5}, b);
  w.detect();
  CHECK(w.contacts.empty());
  w.world.setShape(g, {.shape = Shape::sphere, .radius = 1.1});
  w.detect();
  REQUIRE(w.contacts.size() == 1);
  CHECK(w.contacts[0].depth == Approx(0.1));
}

TEST_CASE("a body that tumbles fast keeps its energy in long steps") {
  EngineWorld w(kBullet);
  w.setGravity(0);
  w.dt = 0.02;
  const Mat3 inertia = Vec3(0.01, 0.1, 0.11).asDiagonal();
  const BodyHandle b = w.body({0, 0, 0}, 1, inertia);
  w.world.setAngularVelocity(b, {0.5, 12, 0.3});
  const auto energy = [&] {
    const engine::BodyState s = w.world.state(b);
    const Vec3 spin = s.rotation.transpose() * s.angularVelocity;
    return spin.dot(inertia * spin) / 2;
  };
  const double before = energy();
  w.run(10);
  CHECK(energy() == Approx(before).epsilon(1e-3));
}

TEST_CASE("light links that whip at the end of a chain gain no energy in long steps") {
  EngineWorld w(kBullet);
  w.setGravity(0);
  w.dt = 0.02;
  const Mat3 inertia = 1e-6 * Mat3::Identity();
  std::vector<BodyHandle> links;
  for (int i = 0; i < 4; ++i) {
    links.push_back(w.body({0.05 + 0.1 * i, 0, 0}, 0.01, inertia));
    const JointHandle j =
        w.joint(JointType::hinge, links.back(), i == 0 ? BodyHandle::none : links[links.size() - 2], {0.1 * i, 0, 0});
    w.world.setAxis(j, 0, i % 2 == 0 ? Vec3::UnitY() : Vec3::UnitZ());
  }
  // The last link turns alone: 8 m/s at its end.
  w.world.setAngularVelocity(links.back(), {0, 0, 80});
  w.world.setLinearVelocity(links.back(), {0, 4, 0});
  for (int i = 0; i < 200; ++i) {
    w.run(w.dt);
    for (const BodyHandle b : links) REQUIRE(w.world.state(b).linearVelocity.norm() < 8);
  }
}
