#include "mesh_colliders.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "api/files.h"
#include "height_field.h"
#include "meshes/height_image.h"
#include "meshes/hull.h"
#include "meshes/mesh_file.h"
#include "shapes.h"

namespace spark {

using engine::Shape;
using engine::ShapeDescription;

namespace physics {

namespace {

/// Reads a mesh file. Its numbers are checked where a shape enters the model, but for those of hulls.
engine::Mesh readScaled(IFileServer& files, const MeshSource& source, const Leaf& node, bool hull) {
  std::vector<std::string> leftOut;
  engine::Mesh mesh = meshes::readMesh(source.file, files.read(source.file), &leftOut);
  if (!leftOut.empty())
    node.kernel().log().warning("{}: the mesh '{}' has {}, which do not collide", node.path(), source.file,
                                fmt::join(leftOut, ", "));
  if (mesh.vertices.size() + mesh.triangles.size() > kMostMeshNumbers)
    throw Error(fmt::format("expected a mesh of at most {} numbers, found {}: simplify it", kMostMeshNumbers,
                            mesh.vertices.size() + mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] *= source.scale[static_cast<int>(i % 3)];
  if (hull) return meshes::hullOf(std::move(mesh.vertices));
  if (mesh.triangles.empty()) throw Error("expected triangles, found none: a ConvexCollider takes points alone");
  // A mirrored triangle is seen from its other side.
  if (source.scale.prod() < 0)
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  return mesh;
}

}  // namespace

void loadMesh(MeshSource& source, const Leaf& node, MeshPool& pool, bool hull) {
  auto& files = node.kernel().root().require<IFileServer>();
  // The bits of the scale, not its digits, decide whether two are the same.
  const std::string name = fmt::format("{}\n{:016x}\n{:a} {:a} {:a}\n{}", source.file, files.stamp(source.file),
                                       source.scale.x(), source.scale.y(), source.scale.z(), hull ? "hull" : "mesh");
  source.mesh = pool.get(name, [&] { return readScaled(files, source, node, hull); });
}

engine::Mesh hullOf(const engine::Mesh& points) { return meshes::hullOf(points.vertices); }

std::pair<std::string, Vec3> siblingMesh(const Leaf& collider) {
  const IVisual* found = nullptr;
  bool before = true;
  for (const auto& sibling : collider.parent()->children()) {
    if (sibling.get() == &collider) before = false;
    const auto visual = sibling->as<IVisual>();
    // Standard meshes, such as StdUnitBox, are no files.
    if (!visual || visual->kind() == IVisual::Kind::light || visual->load().find('.') == std::string::npos) continue;
    if (before || !found) found = visual;
  }
  if (!found)
    throw Error(fmt::format("{}: expected a StaticMesh with a mesh file beside it, found none", collider.path()));
  return {found->load(), found->scale().cast<double>()};
}

}  // namespace physics

// ---- meshes ----

void TriMeshCollider::describe(Description<TriMeshCollider>& d) {
  d.doc(
      "A triangle mesh, of a file or of numbers; it collides once it has triangles. Best used static: on bodies "
      "several "
      "ConvexColliders touch more exactly.");
  describeMesh(d);
  d.property("vertices", &TriMeshCollider::vertices, &TriMeshCollider::setVertices)
      .unit("m")
      .doc("x y z of each vertex; none of a mesh file. Setting it removes all triangles.");
  d.property("triangles", &TriMeshCollider::triangles, &TriMeshCollider::setTriangles)
      .min(0)
      .doc("Three vertex indices of each triangle, from 0, counter-clockwise seen from outside.");
}

std::vector<std::int64_t> TriMeshCollider::triangles() const {
  if (!source().numbers) return {};
  return {source().numbers->triangles.begin(), source().numbers->triangles.end()};
}

void TriMeshCollider::setMesh(std::vector<double> vertices, std::vector<std::int64_t> triangles) {
  for (std::int64_t t : triangles)
    if (t < 0 || 3 * t + 2 >= static_cast<std::int64_t>(vertices.size()))
      throw Error(fmt::format("{}: a triangle names vertex {}, there are {}. Set the vertices first", where(), t,
                              vertices.size() / 3));
  physics::MeshSource next;
  next.scale = scale();
  next.mesh = next.numbers = shared({std::move(vertices), {triangles.begin(), triangles.end()}});
  take(std::move(next));
}

void ConvexCollider::describe(Description<ConvexCollider>& d) {
  d.doc("The convex hull of a mesh file, or of points; it collides once it has one of them.");
  describeMesh(d);
  d.property("vertices", &ConvexCollider::vertices, &ConvexCollider::setPoints)
      .unit("m")
      .doc("x y z of each point, whose hull collides; none of a mesh file.");
}

void ConvexCollider::setPoints(std::vector<double> points) {
  physics::MeshSource next;
  next.scale = scale();
  if (points.size() % 3)
    throw Error(fmt::format("{}: expected three numbers a vertex, found {}", where(), points.size()));
  if (points.size() > physics::kMostMeshNumbers)
    throw Error(
        fmt::format("{}: expected at most {} numbers, found {}", where(), physics::kMostMeshNumbers, points.size()));
  if (!points.empty()) {
    next.numbers = shared({std::move(points), {}});
    try {
      next.mesh = hullOf(next.numbers);
    } catch (const Error& e) {
      throw Error(fmt::format("{}: there is no convex hull", where()), e);
    }
  }
  take(std::move(next));
}

// ---- height fields ----

void HeightFieldCollider::describe(Description<HeightFieldCollider>& d) {
  using H = HeightFieldCollider;
  d.doc(
      "A static grid of heights over x and y around its centre, of a greyscale image or of numbers; it collides once "
      "it "
      "has them. What is below the surface is not inside.");
  d.property("image", &H::image, &H::setImage)
      .doc(
          "PNG file, by its resource name: black is 0 m, white the third number of size; the first row has the "
          "greatest "
          "y. Setting it removes other heights.");
  d.property("size", &H::size, &H::setSize)
      .unit("m")
      .min(0)
      .doc("Size along x and y, and the height of white; numbers are heights as they are.");
  d.property("columns", &H::columns, &H::setColumns)
      .range(0, physics::kMostHeightEdge)
      .doc("Number of points along x of the heights that are numbers. Setting it removes them.");
  d.property("heights", &H::heights, &H::setHeights)
      .unit("m")
      .doc("Heights of the points, row by row from the least y, each row from the least x; none of an image.");
  d.method("getHeight", &H::heightAt)
      .parameters({"x [m]", "y [m]"})
      .doc("Height of the surface above a point of the grid, both in the collider's frame [m].");
}

std::optional<ShapeDescription> HeightFieldCollider::shape() const {
  if (!source_.field) return std::nullopt;
  ShapeDescription s;
  s.shape = Shape::heightField;
  s.heightField = source_.field;
  return s;
}

void HeightFieldCollider::take(Source next) {
  engine::HeightField f;
  if (!next.image.empty()) {
    try {
      f = meshes::readHeights(kernel().root().require<IFileServer>().read(next.image));
    } catch (const Error& e) {
      throw Error(fmt::format("{}: cannot take the heights of '{}'", where(), next.image), e);
    }
    for (float& h : f.heights) h *= static_cast<float>(next.size.z());
  } else if (!next.heights.empty()) {
    if (next.columns < 2 || next.heights.size() % static_cast<std::size_t>(next.columns) != 0)
      throw Error(fmt::format("{}: expected rows of {} heights, found {} heights. Set the columns first", where(),
                              next.columns, next.heights.size()));
    f.columns = next.columns;
    f.rows = static_cast<int>(next.heights.size() / static_cast<std::size_t>(next.columns));
    f.heights.assign(next.heights.begin(), next.heights.end());
  }
  next.field = nullptr;
  if (!f.heights.empty() && body())
    throw Error(fmt::format("{}: a height field has no body: expected a TriMeshCollider or ConvexColliders on a body",
                            where()));
  if (!f.heights.empty()) {
    f.width = next.size.x(), f.depth = next.size.y();
    const auto [low, high] = std::minmax_element(f.heights.begin(), f.heights.end());
    f.low = *low, f.high = *high;
    next.field = std::make_shared<const engine::HeightField>(std::move(f));
  }
  change(source_, std::move(next));
}

void HeightFieldCollider::setImage(std::string image) {
  Source next;
  next.size = source_.size;
  next.image = std::move(image);
  take(std::move(next));
}

void HeightFieldCollider::setHeights(std::vector<double> heights) {
  Source next;
  next.size = source_.size;
  next.columns = source_.columns;
  next.heights = std::move(heights);
  take(std::move(next));
}

void HeightFieldCollider::setColumns(int columns) {
  Source next;
  next.size = source_.size;
  next.columns = columns;
  take(std::move(next));
}

void HeightFieldCollider::setSize(const Vec3& size) {
  Source next = source_;
  next.size = size;
  take(std::move(next));
}

double HeightFieldCollider::heightAt(double x, double y) const {
  if (!source_.field || !(std::abs(x) <= source_.field->width / 2) || !(std::abs(y) <= source_.field->depth / 2))
    throw Error(fmt::format("{}: expected a point of its grid, found {} {}", where(), x, y));
  physics::ShapeRay down{{x, y, source_.field->high + 1.0}, -Vec3::UnitZ(), HUGE_VAL};
  physics::castHeightField(down, *source_.field);
  return down.from.z() - down.nearest;
}

}  // namespace spark
