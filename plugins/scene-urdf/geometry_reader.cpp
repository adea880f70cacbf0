#include "geometry_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/hull.h"
#include "meshes/kept_hulls.h"

namespace spark::urdf {

using engine::Shape;
using engine::ShapeDescription;

namespace {
constexpr int kCollisionGroup = 3;  // not shown where a link has visuals
}

GeometryReader::GeometryReader(const Element& root, const ReadMesh& readMesh, Unsupported& unsupported)
    : readMesh_(readMesh), unsupported_(unsupported) {
  const auto define = [&](const Element& material) {
    const std::string_view name = textOf(material, "name");
    if (name.empty() || !childOf(material, "color")) return;
    if (const auto color = ownColor(material)) materials_.emplace(name, *color);
  };
  for (const Element& e : childrenOf(root))
    if (e.tag() == "material") define(e);
  // A material that a link defines has its name in all others, too.
  for (const Element& link : childrenOf(root))
    for (const Element& e : childrenOf(link))
      if (const auto material = e.tag() == "visual" ? childOf(e, "material") : std::nullopt) define(*material);
}

void GeometryReader::read(const Element& link, mjcf::Body& body) {
  for (const Element& e : childrenOf(link)) {
    const bool collides = e.tag() == "collision";
    if (!collides && e.tag() != "visual") continue;
    if (auto g = geom(e, collides)) body.geoms.push_back(std::move(*g));
  }
}

void GeometryReader::leaveOut(const Element& part, const Element& at, const std::string& why) {
  unsupported_.add(at, fmt::format("a <{}> is left out: {}", part.tag(), why));
}

std::optional<mjcf::Geom> GeometryReader::geom(const Element& e, bool collides) {
  const auto geometry = childOf(e, "geometry");
  if (!geometry) {
    leaveOut(e, e, fmt::format("expected an element <geometry> in <{}>", e.tag()));
    return std::nullopt;
  }
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
  auto shape = shapeOf(e, *geometry);
  if (!shape) return std::nullopt;
  g.shape = std::move(*shape);
  return g;
}

std::optional<ShapeDescription> GeometryReader::shapeOf(const Element& part, const Element& geometry) {
  static constexpr std::string_view kKnown[] = {"box", "sphere", "cylinder", "capsule", "mesh"};
  const std::vector<Element> found = childrenOf(geometry);
  const auto isKnown = [](const Element& e) {
    return std::find(std::begin(kKnown), std::end(kKnown), e.tag()) != std::end(kKnown);
  };
  const auto known = std::find_if(found.begin(), found.end(), isKnown);
  if (known == found.end()) {
    leaveOut(part, geometry, "expected <box>, <cylinder>, <sphere> or <mesh> in <geometry>");
    return std::nullopt;
  }
  if (std::count_if(found.begin(), found.end(), isKnown) > 1)
    unsupported_.add(geometry, "a <geometry> with several shapes has the first alone");
  const Element& e = *known;
  if (e.tag() == "mesh") return meshOf(part, e);
  Numbers a(e, unsupported_);
  ShapeDescription s;
  const auto positive = [&](const char* attribute) {
    const double v = a.number(attribute, 0);
    if (!(v > 0))
      leaveOut(part, e,
               fmt::format("expected a length above 0 for '{}' of <{}>, found '{}'", attribute, e.tag(),
                           textOf(e, attribute)));
    return v;
  };
  if (e.tag() == "box") {
    s.lengths.setZero();
    a.take("size", s.lengths);
    if (s.lengths.minCoeff() > 0) return s;
    leaveOut(part, e, fmt::format("expected three lengths above 0 for 'size' of <box>, found '{}'", textOf(e, "size")));
    return std::nullopt;
  }
  s.shape = e.tag() == "sphere" ? Shape::sphere : e.tag() == "cylinder" ? Shape::cylinder : Shape::capsule;
  s.radius = positive("radius");
  if (!(s.radius > 0)) return std::nullopt;
  s.length = s.shape == Shape::sphere ? 0 : positive("length");
  if (s.shape != Shape::sphere && !(s.length > 0)) return std::nullopt;
  return s;
}

/// The convex hull of a mesh, in metres.
std::optional<ShapeDescription> GeometryReader::meshOf(const Element& part, const Element& e) {
  const std::string file(textOf(e, "filename"));
  Vec3 scale = Vec3::Ones();
  // Some readers take one number for all directions.
  if (const auto one = numbersOf(textOf(e, "scale")); one && one->size() == 1) {
    scale = Vec3::Constant(one->front());
    unsupported_.add(e, "a 'scale' of one number counts for all three directions");
  } else {
    Numbers(e, unsupported_).take("scale", scale);
  }
  const std::string key = fmt::format("{} {} {} {}", file, scale.x(), scale.y(), scale.z());
  auto known = meshes_.find(key);
  if (known == meshes_.end()) known = meshes_.emplace(key, hullOf(e, file, scale)).first;
  if (!known->second.shape) leaveOut(part, e, known->second.why);
  return known->second.shape;
}

GeometryReader::ReadHull GeometryReader::hullOf(const Element& e, const std::string& file, const Vec3& scale) {
  if (file.empty()) return {std::nullopt, "expected an attribute 'filename' of <mesh>"};
  engine::Mesh mesh;
  try {
    FoundMesh found = readMesh_(file);
    if (!found.insteadOf.empty())
      unsupported_.add(e, fmt::format("the mesh '{}' is not there: '{}' is read in its place", file, found.insteadOf));
    for (const std::string& what : found.leftOut)
      unsupported_.add(e, fmt::format("the mesh '{}' has {}, which do not collide", file, what));
    mesh = std::move(found.mesh);
  } catch (const Error& error) {
    return {std::nullopt, fmt::format("cannot read the mesh '{}': {}", file, error.what())};
  }
  numbers_ += mesh.vertices.size() + mesh.triangles.size();
  if (numbers_ > mjcf::kMaxMeshNumbers)
    return {std::nullopt, fmt::format("the meshes of all links have more than {} numbers", mjcf::kMaxMeshNumbers)};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] *= scale[static_cast<int>(i % 3)];
  // A mirrored triangle is seen from its other side.
  if (scale.prod() < 0)
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  const auto surface = std::make_shared<const engine::Mesh>(std::move(mesh));
  const bool hasTriangles = !surface->triangles.empty();
  ShapeDescription s{.shape = Shape::convex};
  try {
    s.mesh = meshes::keptHullOf(surface);
    if (hasTriangles) surfaces_[s.mesh.get()] = surface;
  } catch (const Error& error) {
    const bool isFlat = hasTriangles && meshes::hasArea(*surface);
    if (!isFlat) return {std::nullopt, fmt::format("the mesh '{}' has no convex hull: {}", file, error.what())};
    s.shape = Shape::mesh;
    s.mesh = surface;
  }
  return {std::move(s), ""};
}

std::optional<GeometryReader::Color> GeometryReader::ownColor(const Element& material) {
  const auto color = childOf(material, "color");
  if (!color) return std::nullopt;
  Color rgba{};
  if (!color->node.attribute("rgba")) unsupported_.add(*color, "a <color> without 'rgba' is ignored");
  if (!Numbers(*color, unsupported_).take("rgba", rgba)) return std::nullopt;
  for (double& v : rgba) v = std::clamp(v, 0.0, 1.0);
  return rgba;
}

std::optional<GeometryReader::Color> GeometryReader::colorOf(const Element& visual) {
  const auto material = childOf(visual, "material");
  if (!material) return std::nullopt;
  if (childOf(*material, "color")) return ownColor(*material);
  const std::string_view name = textOf(*material, "name");
  if (const auto known = materials_.find(name); known != materials_.end()) return known->second;
  if (!childOf(*material, "texture"))
    unsupported_.add(*material, fmt::format("there is no material '{}' with a colour: it is grey", name));
  return std::nullopt;
}

}  // namespace spark::urdf
