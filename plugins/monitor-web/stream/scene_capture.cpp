#include "scene_capture.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "api/physics.h"

namespace spark::web {

namespace {

/// The shape as viewers draw it. Empty for planes and rays, which are not drawn, and meshes, which are visual nodes.
std::optional<SceneShape> shapeOf(const engine::ShapeDescription& s) {
  switch (s.shape) {
    case engine::Shape::box:
      return SceneShape{SceneShape::Kind::box, {s.lengths.x(), s.lengths.y(), s.lengths.z()}};
    case engine::Shape::sphere:
      return SceneShape{SceneShape::Kind::sphere, {s.radius}};
    case engine::Shape::capsule:
      return SceneShape{SceneShape::Kind::capsule, {s.radius, s.length}};
    case engine::Shape::cylinder:
      return SceneShape{SceneShape::Kind::cylinder, {s.radius, s.length}};
    default:
      return std::nullopt;
  }
}

/// Collects the shapes of the colliders below `parent`, without those below another transform.
void collectShapes(const Node& parent, std::vector<SceneShape>& out) {
  for (const auto& child : parent.children()) {
    if (child->as<Transform>() || !child->asNode()) continue;
    if (const auto collider = child->as<ICollider>())
      if (const auto description = collider->shape())
        if (auto shape = shapeOf(*description)) {
          const Pose pose = collider->poseInTransform();
          const Eigen::Quaterniond q(pose.rotation);
          shape->position = pose.position;
          shape->rotation = {q.x(), q.y(), q.z(), q.w()};
          out.push_back(std::move(*shape));
        }
    collectShapes(*child->asNode(), out);
  }
}

NodeDescription describeNode(const FrameNode& node) {
  NodeDescription out;
  out.kind = node.kind;
  out.transparent = node.transparent;
  out.visible = node.visible;
  if (node.transform) {
    out.path = node.transform->path();
    collectShapes(*node.transform, out.shapes);
  }
  if (node.visual && node.kind != FrameNode::Kind::light) {
    out.load = node.visual->load();
    out.scale = node.visual->scale();
    out.materials = node.visual->materials();
  }
  if (node.visual && node.kind == FrameNode::Kind::light) out.colors = node.visual->lightColors();
  return out;
}

/// The materials that the nodes name, as far as the host has them, and the one that stands for all others.
std::vector<MaterialDescription> describeMaterials(const MonitorFrame& frame) {
  const Node* folder = nullptr;
  std::set<std::string_view> names{"default"};
  for (const FrameNode& node : frame.nodes) {
    if (!node.visual) continue;
    if (!folder && node.visual->leaf().isLinked())
      folder = node.visual->leaf().kernel().root().find<Node>(IMaterial::kFolder);
    for (const std::string& name : node.visual->materials()) names.insert(name);
  }
  std::vector<MaterialDescription> out;
  for (const std::string_view name : names)
    if (const Leaf* child = folder ? folder->child(name) : nullptr)
      if (const auto material = child->as<IMaterial>())
        out.push_back({std::string(name), material->look(), material->texture()});
  return out;
}

/// A length in whole tenths of a millimetre, so that one scene has one text.
float rounded(double metres) { return static_cast<float>(std::round(metres * 1e4) / 1e4); }

}  // namespace

std::vector<Mount> mountsOf(const std::vector<const Transform*>& transforms) {
  std::map<const Transform*, std::size_t> numbers;
  for (std::size_t i = 0; i < transforms.size(); ++i)
    if (transforms[i] && transforms[i]->isLinked()) numbers.insert({transforms[i], i});
  std::vector<Mount> out(transforms.size());
  if (numbers.empty()) return out;
  std::vector<IJoint*> joints;
  numbers.begin()->first->kernel().root().collect(joints);
  for (const IJoint* joint : joints) {
    const engine::JointType type = joint->jointType();
    const IRigidBody* const bodies[] = {joint->body(0), joint->body(1)};
    if (!bodies[0] || !bodies[1] || type == engine::JointType::angularMotor) continue;
    const auto a = numbers.find(bodies[0]->bodyTransform()), b = numbers.find(bodies[1]->bodyTransform());
    if (a == numbers.end() || b == numbers.end() || a == b || a->first->transform() != b->first->transform()) continue;
    const auto& [later, number] = *(a->second > b->second ? a : b);
    Mount& mount = out[number];
    if (mount.on >= 0) continue;
    mount.on = static_cast<int>(std::min(a->second, b->second));
    if (type == engine::JointType::slider || type == engine::JointType::fixed) continue;  // they hold no point
    const Matrix& world = later->world();
    const Vec3f pin = world.block<3, 3>(0, 0).transpose() * (joint->anchor().cast<float>() - positionOf(world));
    if (pin.norm() <= kMostPin) mount.pin = Vec3f(rounded(pin.x()), rounded(pin.y()), rounded(pin.z()));
  }
  return out;
}

std::shared_ptr<const SceneDescription> describeScene(const MonitorFrame& frame) {
  auto scene = std::make_shared<SceneDescription>();
  std::vector<const Transform*> transforms;
  std::vector<int> lastAtDepth;  // index of the last node of each depth, which is the parent of the next deeper ones
  for (const FrameNode& node : frame.nodes) {
    const auto depth = static_cast<std::size_t>(node.depth);
    lastAtDepth.resize(depth + 1, -1);
    if (node.kind == FrameNode::Kind::transform) transforms.push_back(node.transform);
    scene->nodes.push_back(describeNode(node));
    scene->nodes.back().parent = depth > 0 ? lastAtDepth[depth - 1] : -1;
    lastAtDepth[depth] = static_cast<int>(scene->nodes.size()) - 1;
  }
  scene->materials = describeMaterials(frame);
  scene->mounts = mountsOf(transforms);
  return scene;
}

void copyFrame(const NewestFrame& newest, double time, Snapshot& out) {
  const MonitorFrame& frame = newest.frame;
  out.shape = frame.shape;
  out.time = time;
  out.environment = frame.env;
  out.keys = newest.keys;
  out.transforms.clear();
  out.visible.resize(frame.nodes.size());
  for (std::size_t i = 0; i < frame.nodes.size(); ++i) {
    const FrameNode& node = frame.nodes[i];
    if (node.kind == FrameNode::Kind::transform) out.transforms.push_back(node.local);
    out.visible[i] = node.visible;
  }
}

}  // namespace spark::web
