#pragma once
/// \file
/// Collision shapes.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/shape.h"

namespace spark::engine {

/// Kinds of collision shapes.
enum class Shape { box, sphere, capsule, cylinder, plane, ray, mesh, convex, heightField };

/// Triangles, in the frame of the shapes that have them. Many shapes share one: it never changes.
struct Mesh {
  std::vector<double> vertices;  ///< x y z of each vertex [m]
  /// Three vertex indices of each triangle, counter-clockwise seen from outside. The hull of a convex shape has
  /// triangles, too.
  std::vector<std::uint32_t> triangles;
  bool operator==(const Mesh&) const = default;
  Vec3 vertex(std::size_t i) const { return {vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]}; }
};

/// A grid of heights over the x and the y axis; its centre is above the origin of the shapes that have it. Each cell is
/// two triangles, with an edge from its corner of least x and y to that of most x and y. It never changes.
struct HeightField {
  int columns = 0, rows = 0;    ///< numbers of points along x and y, at least 2
  double width = 0, depth = 0;  ///< size along x and y [m], above 0
  /// Heights of the points [m], x first: that of (column, row) is heights[row * columns + column]. In single precision,
  /// as engines have them.
  std::vector<float> heights;
  float low = 0, high = 0;  ///< the least and the greatest of them [m]
  bool operator==(const HeightField&) const = default;
  double cellWidth() const { return width / (columns - 1); }
  double cellDepth() const { return depth / (rows - 1); }
  float height(int column, int row) const {
    return heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
  Vec3 point(int column, int row) const {
    return {column * cellWidth() - width / 2, row * cellDepth() - depth / 2, height(column, row)};
  }
};

/// A collision shape in its own frame. Capsules and cylinders lie along z.
struct ShapeDescription {
  Shape shape = Shape::box;
  Vec3 lengths{1, 1, 1};           ///< box: full edge lengths [m]
  double radius = 1;               ///< sphere, capsule, cylinder [m]
  double length = 1;               ///< capsule (without the caps), cylinder, ray [m]
  double plane[4] = {0, 0, 1, 0};  ///< a b c d of ax + by + cz = d, world frame; the normal need not have length 1
  Vec3 rayOrigin = Vec3::Zero(), rayDirection{0, 0, 1};
  std::shared_ptr<const Mesh> mesh;                ///< mesh: its triangles; convex: its hull
  std::shared_ptr<const HeightField> heightField;  ///< height field, which has no body
};

/// True if two shapes are the same; meshes and height fields are when they are the same objects.
inline bool isSame(const ShapeDescription& a, const ShapeDescription& b) {
  return a.shape == b.shape && a.lengths == b.lengths && a.radius == b.radius && a.length == b.length &&
         std::equal(a.plane, a.plane + 4, b.plane) && a.rayOrigin == b.rayOrigin && a.rayDirection == b.rayDirection &&
         a.mesh == b.mesh && a.heightField == b.heightField;
}

/// What is made of meshes or height fields, such as trees for search: one for each, shared by all shapes that have it.
/// `Made` is what one is made to; it holds the shared pointer that it was made of, so that no other object gets the
/// same address. One thread at a time.
template <class From, class Made>
class MadeOf {
 public:
  /// The object made of `from` if it is still in use; otherwise the result of `make(from)`.
  template <class F>
  std::shared_ptr<Made> get(const std::shared_ptr<const From>& from, F&& make) {
    if (const auto known = all_.find(from.get()); known != all_.end())
      if (auto made = known->second.lock()) return made;
    // Those that ended are removed from time to time.
    if (all_.size() >= 2 * alive_ + 8) {
      std::erase_if(all_, [](const auto& entry) { return entry.second.expired(); });
      alive_ = all_.size();
    }
    std::shared_ptr<Made> made = make(from);
    all_[from.get()] = made;
    return made;
  }
  /// How many there are.
  std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(all_.begin(), all_.end(), [](const auto& entry) { return !entry.second.expired(); }));
  }

 private:
  std::unordered_map<const From*, std::weak_ptr<Made>> all_;  // never iterated for what decides a step
  std::size_t alive_ = 0;
};

}  // namespace spark::engine
