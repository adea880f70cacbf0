#include "view.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace spark::camera {

namespace {
std::array<float, 3> rgb(const Color& c) { return {c.r, c.g, c.b}; }
}  // namespace

View::View(const CameraShot& shot)
    : shot_(shot), toCamera_(rigidInverse(shot.pose).cast<double>()), slope_(slopeOf(shot)) {}

View::Matrix4 View::frameOf(const Piece& p) const {
  return p.transform ? Matrix4(toCamera_ * p.transform->world().cast<double>() * p.local)
                     : Matrix4(toCamera_ * p.local);
}

bool View::isOutside(const Piece& p, const Matrix4& frame) const {
  if (p.kind.shape == Shape::plane || p.kind.shape == Shape::mesh) return false;
  const Vec3 half(p.size[0], p.size[1], p.size[2]);
  const double r = (frame.block<3, 3>(0, 0) * half.asDiagonal()).norm();
  const double x = frame(0, 3), y = frame(1, 3), z = frame(2, 3);
  return y < shot_.zNear - r || y > shot_.zFar + r || std::abs(x) - slope_[0] * y > r * std::hypot(1, slope_[0]) ||
         std::abs(z) - slope_[1] * y > r * std::hypot(1, slope_[1]);
}

void View::addLamps(const PieceList& scene, Drawing& out) const {
  for (IVisual* light : scene.lights()) {
    const auto [diffuse, ambient, specular] = light->lightColors();
    out.ambient[0] += ambient.r, out.ambient[1] += ambient.g, out.ambient[2] += ambient.b;
    if (out.lamps.size() == kLamps) continue;
    const Vec3 world = positionOf(light->leaf().as<SceneNode>()->transform()->world()).cast<double>();
    const Vec3f place = (toCamera_ * world.homogeneous()).head<3>().cast<float>();
    out.lamps.push_back({{place.x(), place.y(), place.z()}, rgb(diffuse), rgb(specular)});
  }
  // A scene without lights is seen in the light of a lamp at the camera.
  if (scene.lights().empty()) out.lamps.push_back({{0, 0, 0}, {1, 1, 1}, {0, 0, 0}});
}

void View::add(const Piece& p, Matrix4 frame, Drawing& out) {
  const double volume = frame.block<3, 3>(0, 0).determinant();
  if (!(std::abs(volume) > 1e-30)) return;
  // A mirrored solid is the same solid, but the triangles around it would face inwards.
  if (volume < 0 && p.kind.shape != Shape::mesh) frame.col(0) *= -1;
  const Matrix4 inverse = frame.inverse();
  const IMaterial::Look look = p.material ? p.material->look() : p.own;
  Instance i;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      i.toCamera[std::size_t(row)][std::size_t(column)] = static_cast<float>(frame(row, column));
      i.toLocal[std::size_t(row)][std::size_t(column)] = static_cast<float>(inverse(row, column));
    }
  i.size = p.size, i.ambient = look.ambient, i.diffuse = look.diffuse, i.specular = look.specular;
  i.emission = look.emission, i.shininess = static_cast<float>(look.shininess), i.number = p.number;

  if (out.batches.empty() || orderOf(out.batches.back()) != orderOf(p.kind)) {
    out.batches.push_back(p.kind);
    out.batches.back().first = out.instances.size();
  }
  ++out.batches.back().count;
  out.instances.push_back(i);
}

void View::compose(const PieceList& scene, Drawing& out) {
  out.clear();
  addLamps(scene, out);
  behind_.clear();
  for (const Piece& p : scene.pieces()) {
    if (p.visual && !p.visual->visible()) continue;
    const Matrix4 frame = frameOf(p);
    if (isOutside(p, frame)) continue;
    if (p.kind.transparent)
      behind_.emplace_back(frame.block<3, 1>(0, 3).norm(), &p);
    else
      add(p, frame, out);
  }
  // Transparent pieces from back to front.
  std::stable_sort(behind_.begin(), behind_.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [distance, piece] : behind_) add(*piece, frameOf(*piece), out);
}

}  // namespace spark::camera
