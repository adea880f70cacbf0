#include "frames.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "api/appearance.h"
#include "api/physics.h"
#include "foxglove.h"

namespace spark::recorder {

namespace {
constexpr int kDigits = 3;         // decimals of lengths [m] and quaternions
constexpr double kLeast = 0.5e-3;  // what is smaller is written as zero

/// Writes a number; no zero has a sign.
void writeNumber(JsonWriter& json, const char* key, double v) {
  json.key(key).fixed(std::abs(v) < kLeast ? 0.0 : v, kDigits);
}

void writeVector(JsonWriter& json, const char* key, double x, double y, double z) {
  json.key(key).beginObject();
  writeNumber(json, "x", x);
  writeNumber(json, "y", y);
  writeNumber(json, "z", z);
  json.endObject();
}

void writeRotation(JsonWriter& json, const char* key, const Eigen::Quaterniond& q) {
  json.key(key).beginObject();
  writeNumber(json, "x", q.x());
  writeNumber(json, "y", q.y());
  writeNumber(json, "z", q.z());
  writeNumber(json, "w", q.w());
  json.endObject();
}

/// The colliders directly below a transform: not those below another one.
void collectColliders(const Node& parent, std::vector<const ICollider*>& out) {
  for (const auto& child : parent.children()) {
    if (!child->asNode() || child->as<Transform>()) continue;
    if (const auto collider = child->as<ICollider>())
      if (const auto shape = collider->shape())
        if (shape->shape != engine::Shape::plane && shape->shape != engine::Shape::ray) out.push_back(collider.object);
    collectColliders(*child->asNode(), out);
  }
}

/// The colour of the first visual node below a transform; grey if it has none.
Color colorOf(Kernel& kernel, const Node& transform) {
  for (const auto& child : transform.children()) {
    const auto visual = child->as<IVisual>();
    if (!visual || visual->materials().empty()) continue;
    const Leaf* const material =
        kernel.root().find(fmt::format("{}/{}", IMaterial::kFolder, visual->materials().front()));
    if (const auto* look = material ? material->as<IMaterial>().object : nullptr) return look->look().diffuse;
  }
  return {0.6f, 0.6f, 0.65f, 1};
}

void writePose(JsonWriter& json, const ICollider& collider) {
  const Pose pose = collider.poseInTransform();
  json.key("pose").beginObject();
  writeVector(json, "position", pose.position.x(), pose.position.y(), pose.position.z());
  writeRotation(json, "orientation", Eigen::Quaterniond(pose.rotation));
  json.endObject();
}

void writeColor(JsonWriter& json, const Color& color) {
  json.key("color").beginObject().key("r").fixed(color.r, 3).key("g").fixed(color.g, 3);
  json.key("b").fixed(color.b, 3).key("a").fixed(color.a, 3).endObject();
}

/// One shape, as a primitive of foxglove.SceneEntity; capsules are cylinders with the length of the whole.
void writeShape(JsonWriter& json, const ICollider& collider, const engine::ShapeDescription& s, const Color& color) {
  using engine::Shape;
  json.beginObject();
  writePose(json, collider);
  writeColor(json, color);
  const double width = 2 * s.radius;
  if (s.shape == Shape::box)
    writeVector(json, "size", s.lengths.x(), s.lengths.y(), s.lengths.z());
  else if (s.shape == Shape::sphere)
    writeVector(json, "size", width, width, width);
  else if (!s.mesh)
    writeVector(json, "size", width, width, s.length + (s.shape == Shape::capsule ? width : 0));
  if (s.shape == Shape::cylinder || s.shape == Shape::capsule) json.member("bottom_scale", 1).member("top_scale", 1);
  if (s.mesh) {
    const std::vector<double>& v = s.mesh->vertices;
    json.key("points").beginArray();
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
      json.beginObject().key("x").fixed(v[i], kDigits).key("y").fixed(v[i + 1], kDigits);
      json.key("z").fixed(v[i + 2], kDigits).endObject();
    }
    json.endArray().key("colors").beginArray().endArray().key("indices").beginArray();
    for (const std::uint32_t index : s.mesh->triangles) json.value(index);
    json.endArray();
  }
  json.endObject();
}
}  // namespace

bool Frames::refresh() {
  auto* const server = kernel_.root().find<ISceneServer>();
  const std::uint64_t modified = server ? server->modifiedCount() : 0;
  if (!tree_.changed(kernel_.root()) && modified == modified_) return false;
  modified_ = modified;
  transforms_.clear();
  std::vector<const Transform*> all;
  if (const Node* scene = server ? server->activeScene() : nullptr) scene->collect(all);
  // A limb is relative to the nearest part before it that has a shape: what it moves by then hardly changes.
  const std::vector<web::Mount> mounts = web::mountsOf(all);
  auto frames = std::make_shared<std::vector<Places::Frame>>();
  std::vector<int> numbers(all.size(), -1);  // of those with shapes; of others that of the one that they are on
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (mounts[i].on >= 0) numbers[i] = numbers[static_cast<std::size_t>(mounts[i].on)];
    std::vector<const ICollider*> colliders;
    collectColliders(*all[i], colliders);
    if (colliders.empty()) continue;
    frames->push_back({all[i]->path(), numbers[i]});
    numbers[i] = static_cast<int>(transforms_.size());
    transforms_.push_back(all[i]);
  }
  frames_ = std::move(frames);
  return true;
}

std::string Frames::shapes(mcap::Time time) const {
  using engine::Shape;
  std::string out;
  JsonWriter json(out);
  json.beginObject().key("deletions").beginArray().beginObject();
  writeTime(json, "timestamp", time);
  json.member("type", 1).member("id", "").endObject().endArray().key("entities").beginArray();
  for (std::size_t i = 0; i < transforms_.size(); ++i) {
    std::vector<const ICollider*> colliders;
    collectColliders(*transforms_[i], colliders);
    const Color color = colorOf(kernel_, *transforms_[i]);
    json.beginObject();
    writeTime(json, "timestamp", time);
    const std::string& path = (*frames_)[i].path;
    json.member("frame_id", path).member("id", path);
    writeTime(json, "lifetime", 0);
    json.member("frame_locked", true);
    for (const char* none : {"metadata", "arrows", "lines", "texts", "models"}) json.key(none).beginArray().endArray();
    const auto list = [&](const char* key, const auto& fits) {
      json.key(key).beginArray();
      for (const ICollider* c : colliders)
        if (const auto shape = c->shape(); shape && fits(shape->shape)) writeShape(json, *c, *shape, color);
      json.endArray();
    };
    list("cubes", [](Shape s) { return s == Shape::box; });
    list("spheres", [](Shape s) { return s == Shape::sphere; });
    list("cylinders", [](Shape s) { return s == Shape::cylinder || s == Shape::capsule; });
    list("triangles", [](Shape s) { return s == Shape::mesh || s == Shape::convex; });
    json.endObject();
  }
  json.endArray().endObject();
  return out;
}

Places Frames::places() const {
  Places out{frames_, {}};
  out.worlds.reserve(transforms_.size());
  for (const Transform* t : transforms_) out.worlds.push_back(t->world());
  return out;
}

std::string Places::message(mcap::Time time) const {
  std::string out;
  JsonWriter json(out);
  json.beginObject().key("transforms").beginArray();
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const auto& [path, parent] = (*frames)[i];
    const auto above = static_cast<std::size_t>(parent);
    const Matrix m = parent < 0 ? worlds[i] : Matrix(worlds[above].inverse() * worlds[i]);
    json.beginObject();
    writeTime(json, "timestamp", time);
    json.member("parent_frame_id", parent < 0 ? "world" : (*frames)[above].path).member("child_frame_id", path);
    writeVector(json, "translation", m(0, 3), m(1, 3), m(2, 3));
    const Eigen::Matrix3f rotation = m.block<3, 3>(0, 0);
    writeRotation(json, "rotation", Eigen::Quaterniond(Eigen::Quaternionf(rotation).cast<double>()));
    json.endObject();
  }
  json.endArray().endObject();
  return out;
}

}  // namespace spark::recorder
