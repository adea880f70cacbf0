#include "effects.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <unordered_map>

#include "api/joint_trees.h"

namespace spark::physics {

using engine::Index;
using engine::kNone;

void Effects::check(engine::IEngine& engine, const engine::Model& model) {
  if (engine_.get() != &engine.leaf()) {
    engine_ = Ref<Leaf>(&engine.leaf());
    engineName_ = engine.leaf().classObject()->name();
    said_ = {};
    saidOf_.clear();
    seen_ = {};
  }
  const std::array now{model.structure, model.dynamics, model.collision};
  if (std::exchange(seen_, now) == now) return;
  const engine::Capabilities can = engine.capabilities();
  checkJoints(can, model);
  if (!can.surfaces) checkSurfaces(engine);
  if (can.findsContacts()) checkShapes(can);
  checkExtensions(engine);
}

void Effects::checkJoints(const engine::Capabilities& can, const engine::Model& model) {
  for (const Joint* node : joints) {
    const Index i = node->index();
    if (i == kNone || model.joints[i].a == kNone) continue;
    const engine::Joint& j = model.joints[i];
    if (!can.joints) return say(kJoints, *node, "joints have");
    if (!can.jointForces && j.wantsFeedback) say(kJointForces, *node, "the measuring of forces has");
    if (!can.armature && std::any_of(j.axes.begin(), j.axes.end(), [](const auto& a) { return a.armature > 0; }))
      say(kArmature, *node, "the inertia of rotors (armature) has");
  }
  if (!can.loops && !(said_[kLoops] && said_[kAngularMotors])) checkLoops(model);
}

void Effects::checkLoops(const engine::Model& model) {
  const std::vector<Index> leftOver = engine::JointTrees(model).leftOver;
  for (const Joint* node : joints) {
    const Index i = node->index();
    if (!std::binary_search(leftOver.begin(), leftOver.end(), i)) continue;
    if (model.joints[i].type == engine::JointType::angularMotor)
      say(kAngularMotors, *node, "angular motors have");
    else
      say(kLoops, *node, "joints that close a loop of bodies have");
  }
}

namespace {
/// True if the collider above a handler has a surface that is the engine's own.
bool hasOwnSurface(const Leaf& handler, const engine::IEngine& engine) {
  for (const auto& child : handler.parent()->children())
    if (const auto extension = child->as<engine::IExtension>(); extension && engine.reads(extension->kind()))
      return true;
  return false;
}
}  // namespace

void Effects::checkSurfaces(const engine::IEngine& engine) {
  for (const CollisionHandler* node : handlers) {
    const engine::Surface* const s = node->surface();
    if (!s) continue;
    if (s->bounceOn && s->bounce > 0) say(kBounce, *node, "bounce has");
    if (s->slipOn) say(kSlip, *node, "slip has");
    if (!s->pyramid && std::isfinite(s->mu)) say(kForceFriction, *node, "friction that is a force has");
    if (s->pyramid && s->mu != 1 && !said_[kFriction] && !hasOwnSurface(*node, engine))
      say(kFriction, *node, "a coefficient of friction (contactMu) has");
  }
}

namespace {
/// True if no corner of a mesh is above one of its triangles. Of huge meshes it is not known: false.
bool isConvex(const engine::Mesh& m) {
  const std::size_t corners = m.vertices.size() / 3, triangles = m.triangles.size() / 3;
  if (corners * triangles > 100'000'000) return false;
  double size = 0;
  for (const double v : m.vertices) size = std::max(size, std::abs(v));
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto at = [&](std::size_t k) { return m.vertex(m.triangles[3 * t + k]); };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (std::size_t i = 0; i < corners; ++i)
      if (normal.dot(m.vertex(i) - at(0)) > 1e-6 * size) return false;
  }
  return true;
}
}  // namespace

void Effects::checkShapes(const engine::Capabilities& can) {
  std::unordered_map<const engine::Mesh*, bool> convex;  // many colliders may share a mesh
  const auto isKnownConvex = [&convex](const engine::Mesh& m) {
    const auto [known, isNew] = convex.try_emplace(&m);
    if (isNew) known->second = isConvex(m);
    return known->second;
  };
  for (const Collider* node : colliders) {
    const auto s = node->shape();
    if (!s) continue;
    if (s->shape == engine::Shape::heightField && !can.heightFields && !std::exchange(said_[kHeightFields], true))
      node->kernel().log().warning("{}: height fields do not collide with {}: take a TriMeshCollider, or boxes",
                                   node->path(), engineName_);
    if (s->shape != engine::Shape::mesh || said_[kMeshes]) continue;
    if ((node->body() ? can.bodyMeshes : can.meshes) || isKnownConvex(*s->mesh)) continue;
    said_[kMeshes] = true;
    node->kernel().log().warning(
        "{}: a {} mesh collides as its convex hull with {}, its hollows are filled: take a ConvexCollider for each "
        "convex part of it{}",
        node->path(), node->body() ? "body's" : "static", engineName_,
        can.heightFields ? ", or for ground a HeightFieldCollider" : "");
  }
}

void Effects::checkExtensions(const engine::IEngine& engine) {
  for (engine::IExtension* const e : extensions) {
    if (engine.reads(e->kind()) || std::find(saidOf_.begin(), saidOf_.end(), e->kind()) != saidOf_.end()) continue;
    const std::string written = e->writtenAs();
    if (written.empty()) continue;
    saidOf_.push_back(e->kind());
    const Leaf& node = e->leaf();
    node.kernel().log().warning("{}: {} has no effect with {}", node.path(), written, engineName_);
  }
}

void Effects::say(Kind kind, const Leaf& node, const char* what) {
  if (std::exchange(said_[kind], true)) return;
  node.kernel().log().warning("{}: {} no effect with {}", node.path(), what, engineName_);
}

}  // namespace spark::physics
