#include "world_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <tuple>

#include "shapes.h"

namespace spark::physics {

using engine::DynamicState;
using engine::Index;
using engine::kNone;
using engine::Shape;
using engine::ShapeDescription;

namespace {

/// A new index after compact().
void remap(Index& index, const std::vector<Index>& now) {
  if (index != kNone) index = now[index];
}
void remap(std::vector<Index>& list, const std::vector<Index>& now) {
  for (Index& i : list) i = now[i];
  std::erase(list, kNone);
}

}  // namespace

WorldModel::WorldModel(bool exactReplay) {
  model_.exactReplay = exactReplay;
  setParameters({});
}

void WorldModel::setParameters(const engine::WorldParameters& p) {
  if (!inRange(p.gravity)) throw Error("expected a finite gravity for the world");
  if (p.joinedCollide != model_.parameters.joinedCollide) ++model_.structure;
  const engine::WorldParameters before = std::exchange(model_.parameters, p);
  model_.parameters.gravity = rounded(p.gravity);
  model_.parameters.cfm = rounded(p.cfm);
  model_.parameters.contactSurfaceLayer = rounded(p.contactSurfaceLayer);
  ++model_.dynamics;
  const auto all = [](const engine::WorldParameters& w) {
    return std::tuple(w.gravity.x(), w.gravity.y(), w.gravity.z(), w.erp, w.cfm, w.autoDisable, w.joinedCollide,
                      w.contactSurfaceLayer, w.timestep);
  };
  if (all(before) != all(model_.parameters)) watch_.rouseAll();
}

// ---- spaces ----

SpaceHandle WorldModel::createSpace(SpaceHandle parent) {
  model_.spaces.push_back({nextId_++, spaces_[parent], true});
  ++model_.structure;
  return spaces_.add();
}

void WorldModel::destroySpace(SpaceHandle space) {
  spaces_.remove(space);
  ++model_.structure;
  compactWhenMany();
}

void WorldModel::setInnerCollision(SpaceHandle space, bool on) {
  model_.spaces[spaces_[space]].inner = on;
  ++model_.collision;
}

// ---- bodies ----

BodyHandle WorldModel::createBody() {
  model_.bodies.emplace_back().id = nextId_++;
  state_.bodies.emplace_back();
  watch_.add();
  // A step must not allocate.
  state_.moved.reserve(state_.bodies.capacity());
  ++model_.structure;
  return bodies_.add();
}

void WorldModel::destroyBody(BodyHandle body) {
  const Index i = bodies_[body];
  for (Index g = 0; g < model_.geoms.size(); ++g) {
    if (model_.geoms[g].body != i || !geoms_.alive(g)) continue;
    model_.geoms[g].offset = poseOf(model_, state_, g);
    model_.geoms[g].body = kNone;
    model_.geoms[g].centred = false;
    markEdited(g);
  }
  for (Index j = 0; j < model_.joints.size(); ++j)
    if (model_.joints[j].a == i || model_.joints[j].b == i) detach(j);
  bodies_.remove(body);
  ++model_.structure;
  compactWhenMany();
}

void WorldModel::setMass(BodyHandle body, const engine::Mass& mass) {
  const bool finite = std::isfinite(mass.mass) && mass.center.allFinite() && mass.inertia.allFinite();
  if (!finite || mass.mass <= 0)
    throw Error(fmt::format("expected a mass above 0 kg and finite numbers, found {:g} kg", mass.mass));
  if (mass.mass < kLeastMass || mass.mass > kMostMass)
    throw Error(fmt::format("expected a mass of {:g} to {:g} kg, found {:g} kg", kLeastMass, kMostMass, mass.mass));
  if (mass.center.norm() > 1e-9)
    throw Error("expected a centre of mass at the body's origin; move the body there first");
  if (Eigen::LLT<Mat3>(mass.inertia).info() != Eigen::Success || !mass.inertia.isApprox(mass.inertia.transpose(), 1e-9))
    throw Error(
        "expected a symmetric, positive definite inertia: no real body has the one given. Check its diagonal and "
        "products of inertia");
  if (const double most = mass.inertia.cwiseAbs().maxCoeff(), least = 1 / mass.inertia.inverse().cwiseAbs().maxCoeff();
      !(least >= kLeastInertia && most <= kMostInertia))
    throw Error(fmt::format("expected moments of inertia of {:g} to {:g} kg m^2, found {:g} to {:g}", kLeastInertia,
                            kMostInertia, least, most));
  engine::Body& b = model_.bodies[bodies_[body]];
  if (b.mass == mass.mass && b.inertia == mass.inertia) return;
  b.mass = mass.mass;
  b.inertia = mass.inertia;
  b.inverseInertia = mass.inertia.inverse();
  ++model_.dynamics;
  watch_.rouse(bodies_[body]);
}

engine::BodyState WorldModel::state(BodyHandle body) const {
  const DynamicState& s = of(body);
  return {rounded(s.position), rounded(s.linearVelocity), rounded(s.angularVelocity), rounded(s.rotation)};
}

void WorldModel::setPosition(BodyHandle body, const Vec3& wanted) {
  if (!inRange(wanted)) return;
  const Index i = bodies_[body];
  ++data_.poses;
  state_.bodies[i].position = rounded(wanted);
  watch_.placed(i);
  ++state_.bodies[i].version;
  state_.markMoved(i);
}

namespace {

/// Largest deviation from orthonormality that is accepted as rounding to single precision. Larger ones are corrected
/// before they grow: a caller that composes a body's rotation with itself several times in one step doubles the error
/// each time.
constexpr double kOrthonormal = 1e-5;

/// `m` if it is orthonormal up to rounding; else the result of the Gram-Schmidt process on its rows.
Mat3 corrected(const Mat3& m) {
  if ((m * m.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kOrthonormal) return m;
  Mat3 out;
  out.row(0) = m.row(0).normalized();
  out.row(1) = (m.row(1) - m.row(1).dot(out.row(0)) * out.row(0)).normalized();
  out.row(2) = out.row(0).cross(out.row(1));
  return out;
}

}  // namespace

void WorldModel::setRotation(BodyHandle body, const Mat3& wanted) {
  if (!inRange(wanted.data(), 9) || std::abs(wanted.determinant()) < 1e-6) return;
  ++data_.poses;
  const Mat3 r = rounded(corrected(wanted));
  const Index i = bodies_[body];
  state_.bodies[i].rotation = orthogonalized(r);
  state_.bodies[i].quaternion = normalized(quaternionOf(r));
  watch_.placed(i);
  ++state_.bodies[i].version;
  state_.markMoved(i);
}

void WorldModel::setLinearVelocity(BodyHandle body, const Vec3& wanted) {
  if (!inRange(wanted)) return;
  of(body).linearVelocity = rounded(wanted);
  ++of(body).version;
}

void WorldModel::setAngularVelocity(BodyHandle body, const Vec3& wanted) {
  if (!inRange(wanted)) return;
  of(body).angularVelocity = rounded(wanted);
  ++of(body).version;
}

void WorldModel::addForce(BodyHandle body, const Vec3& wanted) {
  if (wanted.allFinite()) of(body).force += rounded(bounded(wanted));
}

void WorldModel::addTorque(BodyHandle body, const Vec3& wanted) {
  if (wanted.allFinite()) of(body).torque += rounded(bounded(wanted));
}

void WorldModel::addDrag(BodyHandle body, double linear, double angular) {
  const DynamicState& s = of(body);
  if (!s.awake) return;
  addForce(body, rounded(s.linearVelocity) * -linear);
  addTorque(body, rounded(s.angularVelocity) * -angular);
}

void WorldModel::setEnabled(BodyHandle body, bool on) {
  const Index i = bodies_[body];
  state_.bodies[i].awake = on;
  watch_.switched(i, on);
}

void WorldModel::setLinkOrigin(BodyHandle body, const Vec3& origin) {
  if (!inRange(origin)) return;
  model_.bodies[bodies_[body]].linkOrigin = origin;
  ++model_.dynamics;
}

void WorldModel::setParts(BodyHandle body, const std::vector<engine::Part>& parts) {
  for (const engine::Part& p : parts)
    if (!(p.mass >= 0) || !inRange(&p.mass, 1) || !inRange(p.center) || !inRange(p.inertia.data(), 9)) return;
  if (parts.empty() && model_.bodies[bodies_[body]].parts.empty()) return;
  model_.bodies[bodies_[body]].parts = parts;
  ++model_.dynamics;
}

void WorldModel::setDamping(BodyHandle body, double linear, double angular) {
  if (!(linear >= 0) || !(angular >= 0)) return;
  engine::Body& b = model_.bodies[bodies_[body]];
  linear = std::min(linear, 1e9);
  angular = std::min(angular, 1e9);
  if (b.linearDamping == linear && b.angularDamping == angular) return;
  b.linearDamping = linear;
  b.angularDamping = angular;
  ++model_.dynamics;
}

void WorldModel::setConnector(BodyHandle body, bool on) {
  model_.bodies[bodies_[body]].connector = on;
  ++model_.structure;
}

void WorldModel::setGravityMode(BodyHandle body, bool on) {
  const Index i = bodies_[body];
  ++model_.dynamics;
  if (std::exchange(model_.bodies[i].gravity, on) != on) watch_.rouse(i);
}

namespace {
// Position, quaternion, 1 if the rotation is that of the quaternion to the last bit, velocities, accumulated force and
// torque, awake, gravity and the two counters of auto-disable; at the end the rotation, if it is another one.
constexpr std::size_t kSaved = 3 + 4 + 1 + 3 + 3 + 3 + 3 + 4, kSavedRotation = 9;

/// True if they are equal to the last bit: 0 is not -0.
bool sameBits(const Mat3& a, const Mat3& b) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  return std::equal(a.data(), a.data() + a.size(), b.data(), [bits](double x, double y) { return bits(x) == bits(y); });
}
}  // namespace

void WorldModel::saveBody(BodyHandle body, std::vector<double>& out) const {
  const Index i = bodies_[body];
  const DynamicState& s = state_.bodies[i];
  const bool derived = sameBits(s.rotation, rotationOf(s.quaternion));
  out.reserve(out.size() + kSaved + kSavedRotation);
  const auto put = [&](const double* from, int n) { out.insert(out.end(), from, from + n); };
  put(s.position.data(), 3);
  put(s.quaternion.data(), 4);
  out.push_back(derived);
  for (const Vec3* v : {&s.linearVelocity, &s.angularVelocity, &s.force, &s.torque}) put(v->data(), 3);
  const double rest[] = {double(s.awake), double(model_.bodies[i].gravity), double(watch_.counters(i).idleStepsLeft),
                         watch_.counters(i).idleTimeLeft};
  put(rest, 4);
  if (!derived) put(s.rotation.data(), kSavedRotation);
}

void WorldModel::loadBody(BodyHandle body, std::span<const double> in) {
  constexpr std::size_t kDerived = 7;
  const bool derived = in.size() > kDerived && in[kDerived] != 0;
  if (const std::size_t size = derived ? kSaved : kSaved + kSavedRotation; in.size() != size)
    throw Error(fmt::format("expected {} numbers of a body's saved state, found {}", size, in.size()));
  const Index i = bodies_[body];
  DynamicState& s = state_.bodies[i];
  const double* p = in.data();
  const auto take = [&](double* to, int n) {
    std::copy(p, p + n, to);
    p += n;
  };
  take(s.position.data(), 3);
  take(s.quaternion.data(), 4);
  ++p;
  for (Vec3* v : {&s.linearVelocity, &s.angularVelocity, &s.force, &s.torque}) take(v->data(), 3);
  ++s.version;
  state_.loaded.resize(state_.bodies.size(), 0);
  state_.loaded[i] = s.version;
  ++data_.poses;
  s.awake = *p++ != 0;
  if (const bool gravity = *p++ != 0; gravity != model_.bodies[i].gravity) setGravityMode(body, gravity);
  watch_.loaded(i, {static_cast<int>(p[0]), p[1]}, {}, {s.position, s.quaternion});
  s.rotation = rotationOf(s.quaternion);
  if (!derived) std::copy_n(p + 2, kSavedRotation, s.rotation.data());
  watch_.placed(i);
  state_.markMoved(i);
}

std::string WorldModel::saveSupport(BodyHandle body) const {
  const BodyWatch::Support& s = watch_.support(bodies_[body]);
  const bool idles = watch_.idles(bodies_[body]);
  if (!s.known && s.contacts == 0 && !idles) return {};
  StateWriter out(true);
  out.write(s.digest);
  out.write(std::uint64_t{s.contacts} << 2 | std::uint64_t{s.slept} << 1 | std::uint64_t{s.known});
  if (idles) {
    const BodyWatch::Start& start = watch_.start(bodies_[body]);
    for (const double v : start.position) out.write(v);
    for (const double v : start.quaternion) out.write(v);
  }
  return out.take();
}

void WorldModel::loadSupport(BodyHandle body, std::string_view bytes) {
  if (bytes.empty()) return;
  StateReader in(bytes);
  const auto digest = static_cast<std::uint64_t>(in.readInteger());
  const auto rest = static_cast<std::uint64_t>(in.readInteger());
  const Index i = bodies_[body];
  BodyWatch::Start start = watch_.start(i);
  if (!in.atEnd()) {
    for (double& v : start.position) v = in.readNumber();
    for (double& v : start.quaternion) v = in.readNumber();
  }
  watch_.loaded(i, BodyWatch::Counters(watch_.counters(i)),
                {digest, static_cast<std::uint32_t>(rest >> 2), (rest & 1) != 0, (rest & 2) != 0}, start);
}

// ---- geoms ----

GeomHandle WorldModel::createGeom(SpaceHandle space, const ShapeDescription& shape, void* owner) {
  checkShape(shape);
  engine::Geom& g = model_.geoms.emplace_back();
  g.id = nextId_++;
  g.space = spaces_[space];
  g.shape = shape;
  g.owner = owner;
  geomEdited_.push_back(0);
  model_.extensions.geoms.emplace_back();
  ++model_.structure;
  return geoms_.add();
}

void WorldModel::destroyGeom(GeomHandle geom) {
  // Until the arrays are compacted, queries must not meet it.
  engine::Geom& g = model_.geoms[geoms_[geom]];
  g.collides = false;
  g.owner = nullptr;
  geoms_.remove(geom);
  ++model_.structure;
  compactWhenMany();
}

void WorldModel::markEdited(Index geom) {
  ++model_.collision;
  if (!std::exchange(geomEdited_[geom], 1)) edited_.push_back(geom);
}

void WorldModel::clearEdited() {
  for (const Index g : edited_) geomEdited_[g] = 0;
  edited_.clear();
}

void WorldModel::setShape(GeomHandle geom, const ShapeDescription& shape) {
  checkShape(shape);
  model_.geoms[geoms_[geom]].shape = shape;
  markEdited(geoms_[geom]);
}

void WorldModel::setBody(GeomHandle geom, BodyHandle body, const Pose& offset) {
  if (!inRange(offset.position) || !inRange(offset.rotation.data(), 9))
    throw Error("expected a finite offset of a collider");
  engine::Geom& g = model_.geoms[geoms_[geom]];
  if (g.shape.shape == Shape::heightField && body != BodyHandle::none)
    throw Error("a height field has no body: expected a TriMeshCollider or ConvexColliders on a body");
  g.body = g.shape.shape == Shape::plane ? kNone : bodies_[body];
  g.offset = offset;
  g.centred = g.body != kNone && offset.position.isZero(0) && offset.rotation.isIdentity(0);
  markEdited(geoms_[geom]);
}

void WorldModel::setPose(GeomHandle geom, const Pose& pose) {
  engine::Geom& g = model_.geoms[geoms_[geom]];
  if (g.body != kNone || !inRange(pose.position) || !inRange(pose.rotation.data(), 9)) return;
  g.offset = pose;
  markEdited(geoms_[geom]);
}

void WorldModel::setPart(GeomHandle geom, int part) {
  engine::Geom& g = model_.geoms[geoms_[geom]];
  if (std::exchange(g.part, part) != part) markEdited(geoms_[geom]);
}

void WorldModel::setBlocks(const engine::Blocks& blocks) {
  if (blocks.empty() && model_.extensions.world.empty()) return;
  model_.extensions.world = blocks;
  ++model_.dynamics;
  watch_.rouseAll();
}

void WorldModel::setInput(std::uint64_t kind, double value) {
  for (engine::BlockInput& input : state_.inputs)
    if (input.kind == kind) return void(input.value = value);
  state_.inputs.push_back({kind, value});
}

void WorldModel::endInput(std::uint64_t kind) {
  std::erase_if(state_.inputs, [kind](const engine::BlockInput& input) { return input.kind == kind; });
}

void WorldModel::setBlocks(GeomHandle geom, const engine::Blocks& blocks) {
  engine::Blocks& own = model_.extensions.geoms[geoms_[geom]];
  if (blocks.empty() && own.empty()) return;
  own = blocks;
  markEdited(geoms_[geom]);
  ++model_.dynamics;  // engines without a detection of their own read them, too
  const Index body = model_.geoms[geoms_[geom]].body;
  body == kNone ? watch_.rouseAll() : watch_.rouse(body);
}

void WorldModel::setBlocks(JointHandle joint, const engine::Blocks& blocks) {
  engine::Blocks& own = model_.extensions.joints[joints_[joint]];
  if (blocks.empty() && own.empty()) return;
  own = blocks;
  ++model_.dynamics;
  rouse(of(joint));
}

void WorldModel::setCollides(GeomHandle geom, bool on) {
  model_.geoms[geoms_[geom]].collides = on;
  markEdited(geoms_[geom]);
}

// ---- removed elements ----

void WorldModel::compact() {
  // Whoever keeps indices compares this version.
  if (bodies_.removed() + spaces_.removed() + geoms_.removed() + joints_.removed() > 0) ++model_.structure;
  if (bodies_.removed() > 0) {
    const std::vector<Index> now = bodies_.compact(model_.bodies, state_.bodies);
    watch_.renumber(now);
    state_.loaded.clear();
    for (engine::Geom& g : model_.geoms) remap(g.body, now);
    for (engine::Joint& j : model_.joints) remap(j.a, now), remap(j.b, now);
    remap(state_.moved, now);
  }
  if (spaces_.removed() > 0) {
    const std::vector<Index> now = spaces_.compact(model_.spaces);
    for (engine::Space& s : model_.spaces) remap(s.parent, now);
    for (engine::Geom& g : model_.geoms) remap(g.space, now);
  }
  if (geoms_.removed() > 0) remap(edited_, geoms_.compact(model_.geoms, model_.extensions.geoms, geomEdited_));
  if (joints_.removed() > 0) {
    const std::vector<Index> now = joints_.compact(
        model_.joints, model_.extensions.joints, model_.extensions.sceneJoints, state_.joints, state_.motors, motors_);
    kinematics_.renumber(now);
    for (engine::AxisControl& c : state_.controls) remap(c.joint, now);
    std::erase_if(state_.controls, [](const engine::AxisControl& c) { return c.joint == kNone; });
    listControls();
  }
}

/// While a world is edited and not stepped, removed elements must not pile up.
void WorldModel::compactWhenMany() {
  const auto many = [](const auto& handles) {
    return handles.removed() > 64 && handles.removed() > handles.size() / 2;
  };
  if (many(bodies_) || many(spaces_) || many(geoms_) || many(joints_)) compact();
}

}  // namespace spark::physics
