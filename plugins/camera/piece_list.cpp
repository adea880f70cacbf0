#include "piece_list.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>

namespace spark::camera {

namespace {

using Matrix4 = Eigen::Matrix4d;

constexpr std::array<float, 4> kUnitBox{0.5f, 0.5f, 0.5f, 0}, kUnitSphere{1, 1, 1, 1}, kUnitCylinder{1, 1, 0.5f, 1};

/// Size of a solid along z.
std::array<float, 4> longSize(double radius, double half) {
  const auto r = static_cast<float>(radius);
  return {r, r, static_cast<float>(half), r};
}

Matrix4 frameOf(const Mat3& rotation, const Vec3& position) {
  Matrix4 m = Matrix4::Identity();
  m.block<3, 3>(0, 0) = rotation, m.block<3, 1>(0, 3) = position;
  return m;
}

/// The frame of the plane ax + by + cz = d: its z axis is the normal.
Matrix4 planeFrame(const double (&plane)[4]) {
  const Vec3 normal(plane[0], plane[1], plane[2]);
  return frameOf(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix(),
                 normal * (plane[3] / normal.squaredNorm()));
}

/// "StdCapsule 0.1 0.2": both numbers.
std::array<double, 2> parameters(const std::string& load) {
  std::array<double, 2> out{1, 1};
  const char *at = load.data(), *const end = at + load.size();
  for (double& v : out) {
    at = std::find(at, end, ' ');
    if (at == end) break;
    at = std::from_chars(at + 1, end, v).ptr;
  }
  return out;
}

/// Sets shape and size of a standard mesh. False if it is none.
bool shapeOf(const std::string& load, Piece& piece) {
  if (load.starts_with("StdUnitBox")) {
    piece.kind.shape = Shape::box;
  } else if (load.starts_with("StdUnitSphere")) {
    piece.kind.shape = Shape::sphere, piece.size = kUnitSphere;
  } else if (load.starts_with("StdUnitCylinder")) {
    piece.kind.shape = Shape::cylinder, piece.size = kUnitCylinder;
  } else if (load.starts_with("StdCapsule")) {
    const auto [radius, length] = parameters(load);
    piece.kind.shape = Shape::capsule, piece.size = longSize(radius, length / 2 + radius);
  } else {
    return false;
  }
  return true;
}

/// False if contacts of the collider are only reported, as those of the box inside of a trap.
bool isSolid(const Node& collider) {
  bool reported = false;
  for (const Node* node = &collider; node && node->as<ICollider>(); node = node->parent())
    for (const auto& child : node->children()) {
      const auto handler = child->as<CollisionHandler>();
      if (handler && handler->surface()) return true;
      reported = reported || handler;
    }
  return !reported;
}

/// Appends the solid colliders with a shape among the children of `node`, and those inside of colliders without one.
void collidersOf(const Node& node, std::vector<ICollider*>& out) {
  for (const auto& child : node.children()) {
    const auto collider = child->as<ICollider>();
    const Node* const inner = child->asNode();
    if (!collider || !inner) continue;
    if (!collider->shape())
      collidersOf(*inner, out);
    else if (isSolid(*inner))
      out.push_back(collider);
  }
}

/// The colliders that show a mesh of `at` that has no file: those at `at`, else those of the transform above, else
/// those of the transforms below that one that show nothing themselves.
std::vector<ICollider*> standIns(const Transform& at) {
  std::vector<ICollider*> out;
  collidersOf(at, out);
  const Transform* const above = at.transform();
  if (!out.empty() || !above) return out;
  collidersOf(*above, out);
  if (!out.empty()) return out;
  for (const auto& child : above->children())
    if (const auto beside = child->as<Transform>(); beside && !beside->childOf<IVisual>()) collidersOf(*beside, out);
  return out;
}

const std::string& firstOf(const std::vector<std::string>& names) {
  static const std::string kNone;
  return names.empty() ? kNone : names.front();
}

}  // namespace

std::string PieceList::dress(Piece& piece, const std::string& material, const Mesh* mesh) const {
  if (mesh)
    for (const MeshMaterial& m : mesh->materials)
      if (m.name == material) return piece.own = m.look, m.texture;
  const Node* const folder = owner_.kernel().root().find<Node>(IMaterial::kFolder);
  const Leaf* found = folder ? folder->child(material) : nullptr;
  if (folder && !found) found = folder->child("default");
  if (found) piece.material = found->as<IMaterial>();
  return piece.material ? piece.material->texture() : "";
}

void PieceList::add(Piece piece, const std::string& material, const Mesh* mesh) {
  piece.kind.texture = store_.image(dress(piece, material, mesh));
  pieces_.push_back(piece);
}

void PieceList::listMesh(const Piece& like, const Mesh& mesh) {
  const auto& names = like.visual->materials();
  const bool single = like.visual->kind() == IVisual::Kind::singleMaterial;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    Piece piece = like;
    piece.kind.shape = Shape::mesh, piece.kind.mesh = &mesh.parts[i];
    const std::size_t n = single ? 0 : i;
    add(piece, n < names.size() ? names[n] : mesh.parts[i].material, &mesh);
  }
}

void PieceList::listCollider(Piece piece, ICollider& collider) {
  const engine::ShapeDescription s = *collider.shape();
  const auto node = collider.leaf().as<SceneNode>();
  piece.transform = node ? node->transform() : nullptr;
  const Pose pose = collider.poseInTransform();
  piece.local = frameOf(pose.rotation, pose.position);
  piece.size = kUnitBox;
  switch (s.shape) {
    case engine::Shape::box:
      piece.kind.shape = Shape::box;
      for (int i = 0; i < 3; ++i) piece.size[std::size_t(i)] = static_cast<float>(s.lengths[i] / 2);
      break;
    case engine::Shape::sphere:
      piece.kind.shape = Shape::sphere, piece.size = kUnitSphere;
      piece.local.block<3, 3>(0, 0) *= s.radius;
      break;
    case engine::Shape::cylinder:
      piece.kind.shape = Shape::cylinder, piece.size = longSize(s.radius, s.length / 2);
      break;
    case engine::Shape::capsule:
      piece.kind.shape = Shape::capsule, piece.size = longSize(s.radius, s.length / 2 + s.radius);
      break;
    case engine::Shape::plane:
      piece.kind.shape = Shape::plane, piece.transform = nullptr, piece.local = planeFrame(s.plane);
      break;
    default:
      return;
  }
  add(piece, firstOf(piece.visual->materials()));
}

void PieceList::listColliders(Piece like) {
  like.kind.transparent = false;
  for (ICollider* c : standIns(*like.transform))
    if (used_.insert(c).second) listCollider(like, *c);
}

std::uint16_t PieceList::nextNumber(const Leaf& leaf) {
  if (paths_.size() <= 0xFFFF) paths_.push_back(leaf.path());
  return static_cast<std::uint16_t>(paths_.size() - 1);
}

void PieceList::list(IVisual& visual) {
  const auto node = visual.leaf().as<SceneNode>();
  if (!node || !node->transform()) return;
  if (visual.kind() == IVisual::Kind::light) return lights_.push_back(&visual);
  Piece piece;
  piece.number = nextNumber(visual.leaf());
  piece.visual = &visual, piece.transform = node->transform();
  piece.local.diagonal().head<3>() = visual.scale().cast<double>();
  piece.kind.transparent = visual.transparent();
  if (shapeOf(visual.load(), piece)) return add(piece, firstOf(visual.materials()));
  const Mesh* const mesh = store_.mesh(visual.load());
  mesh ? listMesh(piece, *mesh) : listColliders(piece);
}

void PieceList::listLine(IPaintedLine& line) {
  constexpr double kThickness = 0.002;  // m, above the ground
  const auto node = line.leaf().as<SceneNode>();
  if (!node) return;
  const auto [begin, end] = line.ends();
  const Vec3 along = (end - begin).cast<double>();
  const double length = along.norm();
  if (length == 0) return;
  Piece piece;
  piece.number = nextNumber(line.leaf());
  piece.transform = node->transform();
  piece.local = frameOf(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), along).toRotationMatrix(),
                        (begin + end).cast<double>() / 2);
  piece.size = {static_cast<float>((length + line.width()) / 2), line.width() / 2, kThickness, 0};
  piece.own.ambient = {1, 1, 1, 1};
  pieces_.push_back(piece);
}

void PieceList::update() {
  auto* const server = owner_.kernel().root().find<ISceneServer>();
  const std::uint64_t modified = server ? server->modifiedCount() : 0;
  if (!tree_.changed(owner_) && modified == modified_) return;
  modified_ = modified;
  pieces_.clear(), lights_.clear(), used_.clear();
  paths_.assign(1, "");
  Node* const scene = server ? server->activeScene() : nullptr;
  if (!scene) return;
  std::vector<IVisual*> visuals;
  scene->collect(visuals);
  for (IVisual* v : visuals) list(*v);
  std::vector<IPaintedLine*> lines;
  scene->collect(lines);
  for (IPaintedLine* l : lines) listLine(*l);
  std::stable_sort(pieces_.begin(), pieces_.end(),
                   [](const Piece& a, const Piece& b) { return orderOf(a.kind) < orderOf(b.kind); });
}

}  // namespace spark::camera
