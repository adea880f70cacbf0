#include "geometry_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/hull.h"

namespace spark::urdf {

using engine::Shape;
using engine::ShapeDescription;

namespace {
constexpr int kCollisionGroup = 3;  // not shown where a link has visuals
}

GeometryReader::GeometryReader(const Element& root, const ReadMesh& readMesh, Unsupported& unsupported)
    : readMesh_(readMesh), unsupported_(unsupported) {
  for (const Element& e : childrenOf(root))
    if (e.tag() == "material")
      if (const auto color = colorOf(e)) materials_[nameOf(e)] = *color;
}

void GeometryReader::read(const Element& link, mjcf::Body& body) {
  for (const Element& e : childrenOf(link)) {
    const bool collides = e.tag() == "collision";
    if (!collides && e.tag() != "visual") continue;
    if (auto g = geom(e, collides)) body.geoms.push_back(std::move(*g));
  }
}

std::optional<mjcf::Geom> GeometryReader::geom(const Element& e, bool collides) {
  const auto geometry = childOf(e, "geometry");
  if (!geometry) throw e.error(fmt::format("expected an element <geometry> in <{}>", e.tag()));
  mjcf::Geom g;
  g.from = e;
  g.pose = originOf(e, unsupported_);
  g.group = collides ? kCollisionGroup : 0;
  if (!collides) {
    g.contactTypes = g.contactAffinities = 0;
    g.color = colorOf(e);
    // What viewers would not draw need not be read.
    if (childOf(*geometry, "mesh")) {
      g.shape.shape = Shape::mesh;
      return g;
    }
  }
  auto shape = shapeOf(*geometry);
  if (!shape) return std::nullopt;
  g.shape = std::move(*shape);
  return g;
}

std::optional<ShapeDescription> GeometryReader::shapeOf(const Element& geometry) {
  const std::vector<Element> found = childrenOf(geometry);
  if (found.empty()) throw geometry.error("expected <box>, <cylinder>, <sphere> or <mesh> in <geometry>");
  const Element& e = found.front();
  if (e.tag() == "mesh") return meshOf(e);
  Attributes a(e, unsupported_);
  ShapeDescription s;
  if (e.tag() == "box") {
    a.take("size", s.lengths);
    if (!(s.lengths.minCoeff() > 0)) throw e.error("expected three lengths above 0 for 'size'");
  } else if (e.tag() == "sphere" || e.tag() == "cylinder" || e.tag() == "capsule") {
    s.shape = e.tag() == "sphere" ? Shape::sphere : e.tag() == "cylinder" ? Shape::cylinder : Shape::capsule;
    s.radius = a.number("radius", 0);
    s.length = s.shape == Shape::sphere ? 0 : a.number("length", 0);
    if (!(s.radius > 0)) throw e.error("expected a length above 0 for 'radius'");
    if (s.shape != Shape::sphere && !(s.length > 0)) throw e.error("expected a length above 0 for 'length'");
  } else {
    unsupported_.element(e);
    return std::nullopt;
  }
  a.finish();
  return s;
}

/// The convex hull of a mesh, in metres.
ShapeDescription GeometryReader::meshOf(const Element& e) {
  Attributes a(e, unsupported_);
  const std::string file = a.text("filename");
  if (file.empty()) throw e.error("expected an attribute 'filename'");
  Vec3 scale = Vec3::Ones();
  a.take("scale", scale);
  a.finish();
  const std::string key = fmt::format("{} {} {} {}", file, scale.x(), scale.y(), scale.z());
  if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
  engine::Mesh mesh;
  try {
    mesh = readMesh_(file);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: cannot read the mesh '{}'", e.where(), file), error);
  }
  numbers_ += mesh.vertices.size() + mesh.triangles.size();
  if (numbers_ > mjcf::kMaxMeshNumbers)
    throw e.error(fmt::format("the meshes of all links have more than {} numbers", mjcf::kMaxMeshNumbers));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] *= scale[static_cast<int>(i % 3)];
    if (!std::isfinite(mesh.vertices[i])) throw e.error("expected vertices of finite numbers");
  }
  ShapeDescription s{.shape = Shape::convex};
  try {
    s.mesh = std::make_shared<const engine::Mesh>(meshes::hullOf(std::move(mesh.vertices)));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: the mesh '{}' has no convex hull", e.where(), file), error);
  }
  return meshes_.emplace(key, std::move(s)).first->second;
}

/// Of a `visual`, or of a `material` itself.
std::optional<std::array<double, 4>> GeometryReader::colorOf(const Element& e) {
  const auto material = e.tag() == "material" ? std::optional(e) : childOf(e, "material");
  if (!material) return std::nullopt;
  if (const auto color = childOf(*material, "color")) {
    Attributes a(*color, unsupported_);
    std::array<double, 4> rgba{};
    if (!a.take("rgba", rgba)) throw color->error("expected four numbers for 'rgba'");
    for (double& v : rgba) v = std::clamp(v, 0.0, 1.0);
    return rgba;
  }
  const auto known = materials_.find(material->node.attribute("name").value());
  return known == materials_.end() ? std::nullopt : std::optional(known->second);
}

}  // namespace spark::urdf
