#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ode_engine.h"
#include "spark/prefetch.h"

namespace spark {

using namespace ode;
using engine::Body;

namespace {
constexpr std::ptrdiff_t kAhead = 4;  // prefetch distance of addDrag() [bodies]
constexpr std::size_t kMotion = 128;  // bytes in an ODE body from its linear velocity to its torque
}  // namespace

Body OdeEngine::createBody(engine::World world) {
  WorldData& w = *data(world);
  auto b = std::make_unique<BodyData>();
  b->id = dBodyCreate(w.id);
  // ODE's getters return pointers into the body, which stay valid as long as it lives.
  b->position = const_cast<dReal*>(dBodyGetPosition(b->id));
  b->quaternion = const_cast<dReal*>(dBodyGetQuaternion(b->id));
  b->rotation = const_cast<dReal*>(dBodyGetRotation(b->id));
  b->linearVelocity = const_cast<dReal*>(dBodyGetLinearVel(b->id));
  b->angularVelocity = const_cast<dReal*>(dBodyGetAngularVel(b->id));
  b->force = const_cast<dReal*>(dBodyGetForce(b->id));
  b->torque = const_cast<dReal*>(dBodyGetTorque(b->id));
  b->deferred = !solver_;
  b->world = &w;
  b->idleStepsLeft = kIdleSteps;
  b->lastValid = {{0, 0, 0}, {1, 0, 0, 0}};
  dBodySetData(b->id, b.get());
  const Body created = handle(*b);
  w.bodies.push_back(std::move(b));

  // The prefetch hint of the body that was created kAhead bodies before.
  if (w.bodies.size() > kAhead) {
    BodyData& earlier = **(w.bodies.rbegin() + kAhead);
    earlier.nextData = w.bodies.back().get();
    earlier.nextOde = w.bodies.back()->linearVelocity;
  }

  // A step must not allocate.
  w.repaired.reserve(w.bodies.size());
  w.excluded.reserve(w.bodies.size());
  w.visitStack.reserve(w.bodies.size());
  w.solved.reserve(w.bodies.size());
  w.structure = ++structures_;
  return created;
}

void OdeEngine::destroyBody(Body body) {
  BodyData* b = data(body);
  WorldData& w = *b->world;

  // Its geoms become static where they are.
  for (const auto& g : w.geoms)
    if (g->body == b) {
      g->offset = pose(handle(*g));
      g->body = nullptr;
      dGeomSetBody(g->id, nullptr);
    }

  // Its joints are detached.
  for (const auto& j : w.joints) {
    if (j->a != b && j->b != b) continue;
    dJointAttach(j->id, nullptr, nullptr);
    if (j->a && j->a != b) --data(j->a)->joints;
    if (j->b && j->b != b) --data(j->b)->joints;
    j->a = j->b = nullptr;
  }
  w.structure = ++structures_;
  dBodyDestroy(b->id);
  removeFrom(w.bodies, b);
}

void OdeEngine::setMass(Body body, const engine::Mass& mass) {
  const bool finite = std::isfinite(mass.mass) && mass.center.allFinite() && mass.inertia.allFinite();
  if (!finite || mass.mass <= 0)
    throw Error(fmt::format("expected a mass above 0 kg and finite numbers, found {:f} kg", mass.mass));
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
  return {rounded(w, toVec(b.position)), rounded(w, toVec(b.linearVelocity)), rounded(w, toVec(b.angularVelocity)),
          rounded(w, toMat(b.rotation))};
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
  if (!inRange(wanted)) return;
  BodyData& b = *data(body);
  const Vec3 p = rounded(*b.world, wanted);
  dBodySetPosition(b.id, p.x(), p.y(), p.z());
  std::copy(p.data(), p.data() + 3, b.lastValid.position);
}

namespace {

/// Largest deviation from orthonormality that is accepted as rounding to single precision. Larger ones are corrected
/// before they grow: a caller that composes a body's rotation with itself several times in one step doubles the error
/// each time.
constexpr double kOrthonormal = 1e-5;

/// `m` if it is orthonormal up to rounding; else the result of the Gram-Schmidt process on its rows.
Mat3 orthonormalized(const Mat3& m) {
  if ((m * m.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kOrthonormal) return m;
  Mat3 out;
  out.row(0) = m.row(0).normalized();
  out.row(1) = (m.row(1) - m.row(1).dot(out.row(0)) * out.row(0)).normalized();
  out.row(2) = out.row(0).cross(out.row(1));
  return out;
}

}  // namespace

void OdeEngine::setRotation(Body body, const Mat3& wanted) {
  if (!inRange(wanted.data(), 9) || std::abs(wanted.determinant()) < 1e-6) return;
  const Mat3 r = orthonormalized(wanted);
  BodyData& b = *data(body);
  dMatrix3 m;
  toOde(rounded(*b.world, r), m);
  dBodySetRotation(b.id, m);
  if (b.joints > 0) ++b.world->angleVersion;
  std::copy(dBodyGetQuaternion(b.id), dBodyGetQuaternion(b.id) + 4, b.lastValid.quaternion);
}

void OdeEngine::setLinearVelocity(Body body, const Vec3& wanted) {
  if (!inRange(wanted)) return;
  const BodyData& b = *data(body);
  const Vec3 v = rounded(*b.world, wanted);
  dBodySetLinearVel(b.id, v.x(), v.y(), v.z());
}

void OdeEngine::setAngularVelocity(Body body, const Vec3& wanted) {
  if (!inRange(wanted)) return;
  const BodyData& b = *data(body);
  const Vec3 w = rounded(*b.world, wanted);
  dBodySetAngularVel(b.id, w.x(), w.y(), w.z());
}

void OdeEngine::addForce(Body body, const Vec3& wanted) {
  if (!wanted.allFinite()) return;
  const BodyData& b = *data(body);
  const Vec3 f = rounded(*b.world, bounded(wanted));
  for (int i = 0; i < 3; ++i) b.force[i] += f[i];
}

void OdeEngine::addTorque(Body body, const Vec3& wanted) {
  if (!wanted.allFinite()) return;
  const BodyData& b = *data(body);
  const Vec3 t = rounded(*b.world, bounded(wanted));
  for (int i = 0; i < 3; ++i) b.torque[i] += t[i];
}

void OdeEngine::addDrag(Body body, double linear, double angular) {
  const BodyData& b = *data(body);
  prefetch(b.nextData, 2 * kCacheLine);
  prefetch(b.nextOde, kMotion);
  if (!b.awake) return;
  OdeEngine::addForce(body, rounded(*b.world, toVec(b.linearVelocity)) * -linear);
  OdeEngine::addTorque(body, rounded(*b.world, toVec(b.angularVelocity)) * -angular);
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
  b.idleStepsLeft = kIdleSteps;
  b.idleTimeLeft = 0;
}

bool OdeEngine::enabled(Body body) const { return data(body)->awake; }

void OdeEngine::setGravityMode(Body body, bool on) {
  BodyData& b = *data(body);
  dBodySetGravityMode(b.id, on);
  b.gravity = on;
}

// Position, quaternion, rotation, velocities, accumulated force and torque; then awake, gravity and the two counters of
// auto-disable.
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
  const double rest[] = {double(b.awake), double(b.gravity), double(b.idleStepsLeft), b.idleTimeLeft};
  put(rest, 4);
}

void OdeEngine::loadBody(Body body, std::span<const double> in) {
  if (in.size() != kSaved)
    throw Error(fmt::format("expected {} numbers of a body's saved state, found {}", kSaved, in.size()));
  BodyData& b = *data(body);
  const double* p = in.data();
  // ODE's setters normalise rotations, which may change the last bit: these are written to ODE's memory directly.
  std::copy(p + 3, p + 7, const_cast<dReal*>(dBodyGetQuaternion(b.id)));
  ++b.world->angleVersion;
  std::copy(p + 7, p + 19, const_cast<dReal*>(dBodyGetRotation(b.id)));
  dBodySetPosition(b.id, p[0], p[1], p[2]);  // also marks the geoms as moved
  dBodySetLinearVel(b.id, p[19], p[20], p[21]);
  dBodySetAngularVel(b.id, p[22], p[23], p[24]);
  dBodySetForce(b.id, p[25], p[26], p[27]);
  dBodySetTorque(b.id, p[28], p[29], p[30]);
  setAwake(b, p[31] != 0);
  OdeEngine::setGravityMode(body, p[32] != 0);
  b.idleStepsLeft = static_cast<int>(p[33]);
  b.idleTimeLeft = p[34];
  std::copy(p, p + 3, b.lastValid.position);
  std::copy(p + 3, p + 7, b.lastValid.quaternion);
}

}  // namespace spark
