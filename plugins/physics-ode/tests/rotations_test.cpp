#include "../../physics/rotations.h"

#include <ode/ode.h>

#include <random>

#include "engine_fixture.h"

// Rotations in the model are bit-identical to ODE's, because recorded sessions depend on every digit.

using namespace spark;
using namespace spark::test;
using engine::JointType;
using physics::BodyHandle;
using physics::JointHandle;
using physics::Quaternion;

namespace {

struct Numbers {
  std::mt19937 random{7};
  double next() { return std::normal_distribution<double>()(random); }
  Vec3 vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Quaternion quaternion() {
    Quaternion q;
    for (double& v : q) v = next();
    return physics::normalized(q);
  }
  Mat3 rotation() { return rotationOf(quaternion()); }
};

Mat3 matrixOf(const dReal* r) {
  Mat3 m;
  m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return m;
}

/// A world of ODE with two bodies.
struct Plain {
  dWorldID world = dWorldCreate();
  dBodyID a = dBodyCreate(world), b = dBodyCreate(world);
  ~Plain() { dWorldDestroy(world); }
  static void put(dBodyID body, const Pose& pose) {
    dMatrix3 r{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) r[4 * i + k] = pose.rotation(i, k);
    dBodySetPosition(body, pose.position.x(), pose.position.y(), pose.position.z());
    dBodySetRotation(body, r);
  }
};

}  // namespace

TEST_CASE("products and conversions of rotations equal ODE's, bit for bit") {
  Numbers n;
  for (int i = 0; i < 2000; ++i) {
    const Quaternion a = n.quaternion(), b = n.quaternion();
    Quaternion c;
    dQMultiply1(c.data(), a.data(), b.data());
    REQUIRE(physics::conjugateTimes(a, b) == c);
    dQMultiply2(c.data(), a.data(), b.data());
    REQUIRE(physics::timesConjugate(a, b) == c);
    dQMultiply3(c.data(), a.data(), b.data());
    REQUIRE(physics::conjugateTimesConjugate(a, b) == c);
    const Vec3 x = n.vector(), y = n.vector();
    dMatrix3 r;
    dRFrom2Axes(r, x[0], x[1], x[2], y[0], y[1], y[2]);
    REQUIRE((physics::frameFromAxes(x, y).array() == matrixOf(r).array()).all());
    dRtoQ(r, c.data());
    REQUIRE(physics::quaternionOf(matrixOf(r)) == c);
    dQtoR(a.data(), r);
    REQUIRE((rotationOf(a).array() == matrixOf(r).array()).all());
  }
}

TEST_CASE("the rotation of a body equals that of ODE's body, bit for bit") {
  const EngineHost keepsOde;  // ODE is initialized while an engine exists
  Plain plain;
  Numbers n;
  physics::WorldModel world;
  const BodyHandle body = world.createBody();
  for (int i = 0; i < 2000; ++i) {
    Mat3 r = n.rotation();
    if (i % 2) r = r.cast<float>().eval().cast<double>();
    world.setRotation(body, r);
    Plain::put(plain.a, {Vec3::Zero(), r});
    const engine::DynamicState& state = world.state().bodies[0];
    REQUIRE((state.rotation.array() == matrixOf(dBodyGetRotation(plain.a)).array()).all());
    REQUIRE(std::equal(state.quaternion.begin(), state.quaternion.end(), dBodyGetQuaternion(plain.a)));
  }
}

TEST_CASE("joint angles equal ODE's, for hinges bit for bit, with either order of bodies and with the world") {
  const EngineHost keepsOde;
  Numbers n;
  for (const int order : {0, 1, 2, 3})
    for (int i = 0; i < 200; ++i) {
      CAPTURE(order, i);
      Plain plain;
      physics::WorldModel world;
      const BodyHandle a = world.createBody(), b = world.createBody();
      const auto put = [&] {
        const Pose poses[] = {{n.vector(), n.rotation()}, {n.vector(), n.rotation()}};
        for (int k = 0; k < 2; ++k) {
          world.setPosition(k ? b : a, poses[k].position);
          world.setRotation(k ? b : a, poses[k].rotation);
          Plain::put(k ? plain.b : plain.a, poses[k]);
        }
      };
      put();
      const std::pair<BodyHandle, BodyHandle> handles[] = {
          {a, b}, {b, a}, {a, BodyHandle::none}, {BodyHandle::none, a}};
      const std::pair<dBodyID, dBodyID> ids[] = {
          {plain.a, plain.b}, {plain.b, plain.a}, {plain.a, nullptr}, {nullptr, plain.a}};
      const auto join = [&](JointType type, dJointID id) {
        const JointHandle j = world.createJoint(type);
        world.attach(j, handles[order].first, handles[order].second);
        dJointAttach(id, ids[order].first, ids[order].second);
        return j;
      };
      const Vec3 p = n.vector(), u = n.vector(), v = n.vector();
      const dJointID hinge = dJointCreateHinge(plain.world, nullptr), slider = dJointCreateSlider(plain.world, nullptr),
                     universal = dJointCreateUniversal(plain.world, nullptr);
      const JointHandle h = join(JointType::hinge, hinge), s = join(JointType::slider, slider),
                        c = join(JointType::universal, universal);
      world.setAnchor(h, p), dJointSetHingeAnchor(hinge, p.x(), p.y(), p.z());
      world.setAxis(h, 0, u), dJointSetHingeAxis(hinge, u.x(), u.y(), u.z());
      world.setAxis(s, 0, u), dJointSetSliderAxis(slider, u.x(), u.y(), u.z());
      world.setAnchor(c, p), dJointSetUniversalAnchor(universal, p.x(), p.y(), p.z());
      world.setAxis(c, 0, u), dJointSetUniversalAxis1(universal, u.x(), u.y(), u.z());
      world.setAxis(c, 1, v), dJointSetUniversalAxis2(universal, v.x(), v.y(), v.z());
      put();
      CHECK(world.at(h).angle(0) == dJointGetHingeAngle(hinge));
      CHECK(world.at(s).angle(0) == Approx(dJointGetSliderPosition(slider)).margin(1e-12));
      CHECK(world.at(c).angle(0) == Approx(dJointGetUniversalAngle1(universal)).margin(1e-9));
      CHECK(world.at(c).angle(1) == Approx(dJointGetUniversalAngle2(universal)).margin(1e-9));
      dVector3 found;
      dJointGetHingeAxis(hinge, found);
      CHECK((world.at(h).axis(0) - Vec3(found[0], found[1], found[2])).norm() < 1e-12);
      dJointGetUniversalAxis1(universal, found);
      CHECK((world.at(c).axis(0) - Vec3(found[0], found[1], found[2])).norm() < 1e-12);
      dJointGetUniversalAxis2(universal, found);
      CHECK((world.at(c).axis(1) - Vec3(found[0], found[1], found[2])).norm() < 1e-12);
    }
}
