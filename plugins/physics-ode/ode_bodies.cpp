#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ode_engine.h"
#include "spark/prefetch.h"

namespace spark {

using namespace ode;
using engine::Body;

namespace {
constexpr std::ptrdiff_t kAhead = 4;  // bodies
constexpr std::size_t kMotion = 128;  // bytes of ODE's from a body's velocity to its torque
}  // namespace

Body OdeEngine::createBody(engine::World world) {
  WorldData& w = *data(world);
  auto b = std::make_unique<BodyData>();
  b->id = dBodyCreate(w.id);
  b->position = const_cast<dReal*>(dBodyGetPosition(b->id));
  b->quaternion = const_cast<dReal*>(dBodyGetQuaternion(b->id));
  b->rotation = const_cast<dReal*>(dBodyGetRotation(b->id));
  b->linearVelocity = const_cast<dReal*>(dBodyGetLinearVel(b->id));
  b->angularVelocity = const_cast<dReal*>(dBodyGetAngularVel(b->id));
  b->force = const_cast<dReal*>(dBodyGetForce(b->id));
  b->torque = const_cast<dReal*>(dBodyGetTorque(b->id));
  b->deferred = !solver_;
  b->world = &w;
  b->stepsLeft = kIdleSteps;
  b->good = {{0, 0, 0}, {1, 0, 0, 0}};
  dBodySetData(b->id, b.get());
  const Body handle{reinterpret_cast<std::uintptr_t>(b.get())};
  w.bodies.push_back(std::move(b));
  if (w.bodies.size() > kAhead) {
    BodyData& before = **(w.bodies.rbegin() + kAhead);
    before.ahead = w.bodies.back().get();
    before.odeAhead = w.bodies.back()->linearVelocity;
  }
  w.repaired.reserve(w.bodies.size());
  w.sleepers.reserve(w.bodies.size());
  w.toVisit.reserve(w.bodies.size());
  w.solved.reserve(w.bodies.size());
  w.structure = ++structures_;
  return handle;
}

void OdeEngine::destroyBody(Body body) {
  BodyData* b = data(body);
  WorldData& w = *b->world;
  for (const auto& g : w.geoms)
    if (g->body == b) {
      g->offset = pose(engine::Geom{reinterpret_cast<std::uintptr_t>(g.get())});
      g->body = nullptr;
      dGeomSetBody(g->id, nullptr);
    }
  for (const auto& j : w.joints) {
    if (j->a != b && j->b != b) continue;
    dJointAttach(j->id, nullptr, nullptr);
    if (j->a && j->a != b) --data(j->a)->joints;
    if (j->b && j->b != b) --data(j->b)->joints;
    j->a = j->b = nullptr;
  }
  w.structure = ++structures_;
  dBodyDestroy(b->id);
  forget(w.bodies, b);
}

void OdeEngine::setMass(Body body, const engine::Mass& mass) {
  const bool finite = std::isfinite(mass.mass) && mass.center.allFinite() && mass.inertia.allFinite();
  if (!finite || mass.mass <= 0)
    throw Error("expected a mass above 0 kg and finite numbers, found " + std::to_string(mass.mass) + " kg");
  if (mass.center.norm() > 1e-9)
    throw Error("expected a centre of mass at the body's origin; move the body there first");
  if (Eigen::LLT<Mat3>(mass.inertia).info() != Eigen::Success || !mass.inertia.isApprox(mass.inertia.transpose(), 1e-9))
    throw Error(
        "expected a symmetric, positive definite inertia: no real body has the one given. Check its diagonal and "
        "products of inertia");
  dMass m;
  dMassSetZero(&m);
  m.mass = mass.mass;
  toOde(mass.inertia, m.I);
  BodyData& b = *data(body);
  dBodySetMass(b.id, &m);
  b.mass = mass.mass;
  b.inertia = mass.inertia;
  b.inverseInertia = mass.inertia.inverse();
}

engine::BodyState OdeEngine::state(Body body) const {
  const BodyData& b = *data(body);
  const WorldData& w = *b.world;
  return {crossing(w, toVec(b.position)), crossing(w, toVec(b.linearVelocity)), crossing(w, toVec(b.angularVelocity)),
          crossing(w, toMat(b.rotation))};
}

void OdeEngine::posesOfAwake(std::span<const Body> bodies, std::span<std::uint8_t> awake, std::span<Matrix> out) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyData& b = *data(bodies[i]);
    awake[i] = b.awake;
    if (!b.awake) continue;
    const dReal *r = b.rotation, *p = b.position;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) out[i](row, column) = static_cast<float>(r[4 * row + column]);
      out[i](row, 3) = static_cast<float>(p[row]);
    }
    out[i].row(3) << 0, 0, 0, 1;
  }
}

void OdeEngine::setPosition(Body body, const Vec3& wanted) {
  if (!sane(wanted)) return;
  BodyData& b = *data(body);
  const Vec3 p = crossing(*b.world, wanted);
  dBodySetPosition(b.id, p.x(), p.y(), p.z());
  std::copy(p.data(), p.data() + 3, b.good.position);
}

namespace {

/// Rounding of single precision stays below; what is worse is made right-angled before it grows: who turns a robot by
/// what its own rotation says, again and again within one step, doubles the error each time.
constexpr double kRightAngled = 1e-5;

/// The rotation nearest to `m` by its first two rows.
Mat3 rightAngled(const Mat3& m) {
  if ((m * m.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRightAngled) return m;
  Mat3 out;
  out.row(0) = m.row(0).normalized();
  out.row(1) = (m.row(1) - m.row(1).dot(out.row(0)) * out.row(0)).normalized();
  out.row(2) = out.row(0).cross(out.row(1));
  return out;
}

}  // namespace

void OdeEngine::setRotation(Body body, const Mat3& wanted) {
  if (!sane(wanted.data(), 9) || std::abs(wanted.determinant()) < 1e-6) return;
  const Mat3 r = rightAngled(wanted);
  BodyData& b = *data(body);
  dMatrix3 m;
  toOde(crossing(*b.world, r), m);
  dBodySetRotation(b.id, m);
  if (b.joints > 0) ++b.world->rotations;
  std::copy(dBodyGetQuaternion(b.id), dBodyGetQuaternion(b.id) + 4, b.good.quaternion);
}

void OdeEngine::setLinearVelocity(Body body, const Vec3& wanted) {
  if (!sane(wanted)) return;
  const BodyData& b = *data(body);
  const Vec3 v = crossing(*b.world, wanted);
  dBodySetLinearVel(b.id, v.x(), v.y(), v.z());
}

void OdeEngine::setAngularVelocity(Body body, const Vec3& wanted) {
  if (!sane(wanted)) return;
  const BodyData& b = *data(body);
  const Vec3 w = crossing(*b.world, wanted);
  dBodySetAngularVel(b.id, w.x(), w.y(), w.z());
}

void OdeEngine::addForce(Body body, const Vec3& wanted) {
  if (!wanted.allFinite()) return;
  const BodyData& b = *data(body);
  const Vec3 f = crossing(*b.world, bounded(wanted));
  for (int i = 0; i < 3; ++i) b.force[i] += f[i];
}

void OdeEngine::addTorque(Body body, const Vec3& wanted) {
  if (!wanted.allFinite()) return;
  const BodyData& b = *data(body);
  const Vec3 t = crossing(*b.world, bounded(wanted));
  for (int i = 0; i < 3; ++i) b.torque[i] += t[i];
}

void OdeEngine::addDrag(Body body, double linear, double angular) {
  const BodyData& b = *data(body);
  prefetch(b.ahead, 2 * kCacheLine);
  prefetch(b.odeAhead, kMotion);
  if (!b.awake) return;
  OdeEngine::addForce(body, crossing(*b.world, toVec(b.linearVelocity)) * -linear);
  OdeEngine::addTorque(body, crossing(*b.world, toVec(b.angularVelocity)) * -angular);
}

Vec3 OdeEngine::force(Body body) const { return toVec(dBodyGetForce(data(body)->id)); }
Vec3 OdeEngine::torque(Body body) const { return toVec(dBodyGetTorque(data(body)->id)); }

void OdeEngine::setForce(Body body, const Vec3& wanted) {
  const Vec3 f = bounded(wanted);
  if (wanted.allFinite()) dBodySetForce(data(body)->id, f.x(), f.y(), f.z());
}

void OdeEngine::setTorque(Body body, const Vec3& wanted) {
  const Vec3 t = bounded(wanted);
  if (wanted.allFinite()) dBodySetTorque(data(body)->id, t.x(), t.y(), t.z());
}

void OdeEngine::setEnabled(Body body, bool on) {
  BodyData& b = *data(body);
  setAwake(b, on);
  if (!on) return;
  b.stepsLeft = kIdleSteps;
  b.timeLeft = 0;
}

bool OdeEngine::enabled(Body body) const { return data(body)->awake; }

void OdeEngine::setGravityMode(Body body, bool on) {
  BodyData& b = *data(body);
  dBodySetGravityMode(b.id, on);
  b.gravity = on;
}

// Position, quaternion, rotation, velocities, accumulated force and torque, then what decides about sleep and gravity.
constexpr std::size_t kSaved = 3 + 4 + 12 + 3 + 3 + 3 + 3 + 4;

void OdeEngine::saveBody(Body body, std::vector<double>& out) const {
  const BodyData& b = *data(body);
  const auto put = [&](const dReal* from, int n) { out.insert(out.end(), from, from + n); };
  put(dBodyGetPosition(b.id), 3);
  put(dBodyGetQuaternion(b.id), 4);
  put(dBodyGetRotation(b.id), 12);
  put(dBodyGetLinearVel(b.id), 3);
  put(dBodyGetAngularVel(b.id), 3);
  put(dBodyGetForce(b.id), 3);
  put(dBodyGetTorque(b.id), 3);
  const double rest[] = {double(b.awake), double(b.gravity), double(b.stepsLeft), b.timeLeft};
  put(rest, 4);
}

void OdeEngine::loadBody(Body body, std::span<const double> in) {
  if (in.size() != kSaved)
    throw Error("expected " + std::to_string(kSaved) + " numbers of a body's saved state, found " +
                std::to_string(in.size()));
  BodyData& b = *data(body);
  const double* p = in.data();
  // ODE's own setters normalise again, which may change the last bit: the state is written where ODE keeps it.
  std::copy(p + 3, p + 7, const_cast<dReal*>(dBodyGetQuaternion(b.id)));
  ++b.world->rotations;
  std::copy(p + 7, p + 19, const_cast<dReal*>(dBodyGetRotation(b.id)));
  dBodySetPosition(b.id, p[0], p[1], p[2]);  // also tells the geoms
  dBodySetLinearVel(b.id, p[19], p[20], p[21]);
  dBodySetAngularVel(b.id, p[22], p[23], p[24]);
  dBodySetForce(b.id, p[25], p[26], p[27]);
  dBodySetTorque(b.id, p[28], p[29], p[30]);
  setAwake(b, p[31] != 0);
  OdeEngine::setGravityMode(body, p[32] != 0);
  b.stepsLeft = static_cast<int>(p[33]);
  b.timeLeft = p[34];
  std::copy(p, p + 3, b.good.position);
  std::copy(p + 3, p + 7, b.good.quaternion);
}

}  // namespace spark
