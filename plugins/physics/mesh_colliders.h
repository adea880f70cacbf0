#pragma once
/// \file
/// The colliders with meshes and height fields.

#include "colliders.h"

namespace spark {

namespace physics {
/// What a collider's mesh is made of: a file, or numbers.
struct MeshSource {
  std::string file;          ///< resource name; "": numbers
  Vec3 scale{1, 1, 1};       ///< of the file
  MeshPool::Shared numbers;  ///< as they were set; nullptr: none
  MeshPool::Shared mesh;     ///< that collides; nullptr: none
};
/// Fills `mesh` of a source with a file; with its hull if `hull`. Throws Error, with the resource's name.
void loadMesh(MeshSource& source, const Leaf& node, MeshPool& pool, bool hull);
/// The convex hull of a mesh. Throws Error.
engine::Mesh hullOf(const engine::Mesh& points);
/// The mesh file and the scale of the visual node beside `collider` that shows one. Throws Error if there is none.
std::pair<std::string, Vec3> siblingMesh(const Leaf& collider);
}  // namespace physics

/// Base of the colliders with a mesh, of a file or of numbers. Colliders of a world with the same file and scale share
/// one mesh, and so do those with the same numbers.
template <class Self, class Base, engine::Shape S>
class MeshCollider : public Base {
 public:
  std::optional<engine::ShapeDescription> shape() const override {
    if (!source_.mesh || source_.mesh->triangles.empty()) return std::nullopt;
    engine::ShapeDescription s;
    s.shape = S;
    s.mesh = source_.mesh;
    return s;
  }

 protected:
  static constexpr bool kHull = S == engine::Shape::convex;
  static void describeMesh(Description<Self>& d) {
    d.property("mesh", &Self::file, &Self::setFile)
        .doc("Mesh file, by its resource name: .obj, .stl, .dae, .glb and others. Setting it removes other vertices.");
    d.property("scale", &Self::scale, &Self::setScale).unit("1").doc("Scale of the mesh file along x, y and z.");
    d.method("useSibling", &Self::useSibling)
        .doc("Takes mesh file and scale of the StaticMesh before it, or else behind it, among its siblings.");
  }
  const std::string& file() const { return source_.file; }
  void setFile(std::string file) {
    physics::MeshSource next;
    next.file = std::move(file);
    next.scale = source_.scale;
    take(std::move(next));
  }
  Vec3 scale() const { return source_.scale; }
  void setScale(const Vec3& scale) {
    if (!scale.allFinite() || (scale.array() == 0).any())
      throw Error(fmt::format("{}: expected a scale of three numbers other than 0", this->where()));
    physics::MeshSource next = source_;
    next.scale = scale;
    take(std::move(next));
  }
  void useSibling() {
    physics::MeshSource next;
    std::tie(next.file, next.scale) = physics::siblingMesh(*this);
    take(std::move(next));
  }
  /// Sets what it is made of; a file is loaded here. Throws Error; then nothing changes.
  void take(physics::MeshSource next) {
    if (!next.file.empty()) {
      if (!this->world()) throw Error(fmt::format("{}: expected a collider in a scene with a World", this->where()));
      try {
        physics::loadMesh(next, *this, this->world()->meshes(), kHull);
      } catch (const Error& e) {
        throw Error(fmt::format("{}: cannot take the mesh '{}'", this->where(), next.file), e);
      }
    }
    this->change(source_, std::move(next));
  }
  /// The numbers, kept once in its world.
  physics::MeshPool::Shared shared(engine::Mesh mesh) const {
    if (this->world()) return this->world()->meshes().share(std::move(mesh));
    return std::make_shared<const engine::Mesh>(std::move(mesh));
  }
  /// The hull of such numbers.
  physics::MeshPool::Shared hullOf(const physics::MeshPool::Shared& numbers) const {
    const auto make = [&] { return physics::hullOf(*numbers); };
    if (this->world()) return this->world()->meshes().hullOf(numbers, make);
    return std::make_shared<const engine::Mesh>(make());
  }
  std::vector<double> vertices() const { return source_.numbers ? source_.numbers->vertices : std::vector<double>(); }
  const physics::MeshSource& source() const { return source_; }

 private:
  physics::MeshSource source_;
};

/// A triangle mesh.
class TriMeshCollider : public MeshCollider<TriMeshCollider, ConcaveCollider, engine::Shape::mesh> {
  SPARK_CLASS(TriMeshCollider, ConcaveCollider)
 public:
  static void describe(Description<TriMeshCollider>& d);

 private:
  void setVertices(std::vector<double> v) { setMesh(std::move(v), {}); }
  std::vector<std::int64_t> triangles() const;
  void setTriangles(std::vector<std::int64_t> t) { setMesh(vertices(), std::move(t)); }
  void setMesh(std::vector<double> vertices, std::vector<std::int64_t> triangles);
};

/// The convex hull of a mesh file, or of points.
class ConvexCollider : public MeshCollider<ConvexCollider, Collider, engine::Shape::convex> {
  SPARK_CLASS(ConvexCollider, Collider)
 public:
  static void describe(Description<ConvexCollider>& d);

 private:
  void setPoints(std::vector<double> points);
};

/// A static grid of heights.
class HeightFieldCollider : public ConcaveCollider {
  SPARK_CLASS(HeightFieldCollider, ConcaveCollider)
 public:
  static void describe(Description<HeightFieldCollider>& d);
  std::optional<engine::ShapeDescription> shape() const override;

 private:
  struct Source {
    std::string image;            ///< resource name; "": numbers
    std::vector<double> heights;  ///< numbers, as they were set
    int columns = 0;              ///< of the numbers
    Vec3 size{1, 1, 1};           ///< along x and y; height of white [m]
    std::shared_ptr<const engine::HeightField> field;
  };
  void take(Source next);
  const std::string& image() const { return source_.image; }
  void setImage(std::string image);
  const std::vector<double>& heights() const { return source_.heights; }
  void setHeights(std::vector<double> heights);
  int columns() const { return source_.columns; }
  void setColumns(int columns);
  Vec3 size() const { return source_.size; }
  void setSize(const Vec3& size);
  double heightAt(double x, double y) const;
  Source source_;
};

}  // namespace spark
