#include "geometry_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base_nodes.h"
#include "meshes/hull.h"
#include "meshes/kept_hulls.h"
#include "robot/mended_numbers.h"

namespace spark::webots {

using engine::Shape;
using engine::ShapeDescription;

namespace {

constexpr std::uint32_t kMostInRow = 4096;  ///< points of an ElevationGrid
constexpr int kCollisionGroup = 3;          // not shown where a body has shapes that are seen

/// Geometries that are not read.
bool isOtherGeometry(std::string_view type) {
  static constexpr std::string_view kTypes[] = {"Cone", "Extrusion", "IndexedLineSet", "PointSet"};
  return std::find(std::begin(kTypes), std::end(kTypes), type) != std::end(kTypes);
}

Error needsUniform(const Node& node) {
  return node.element().error(fmt::format("expected one scale in all directions for a {}, found several", node.type));
}

}  // namespace

void GeometryReader::shape(const Node& node, const Frame& frame, mjcf::Body& body) {
  Fields f(node, r_.unsupported);
  f.ignore({"castShadows", "isPickable", "name"});
  mjcf::Geom g;
  g.from = node.element();
  g.contactTypes = g.contactAffinities = 0;
  if (const Node* const appearance = f.child("appearance")) g.color = colorOf(*appearance);
  const Node* const geometry = f.child("geometry");
  f.finish();
  if (!geometry) return;
  const Frame standing = webots::standing(*geometry, frame);
  g.pose = standing.pose;
  r_.leaveOut(*geometry, "a shape", [&] {
    auto shape = this->geometry(*geometry, standing, false);
    if (!shape) return;
    g.shape = std::move(*shape);
    body.geoms.push_back(std::move(g));
  });
}

void GeometryReader::bounds(const Node& node, const Frame& frame, std::optional<double> density, mjcf::Body& body) {
  r_.visit(node);
  if (node.type != "Shape" && !isGroup(node.type)) return addBounds(node, frame, density, body);
  Fields f(node, r_.unsupported);
  if (node.type == "Shape") {
    f.ignore({"appearance", "castShadows", "isPickable", "name"});
    if (const Node* const geometry = f.child("geometry")) addBounds(*geometry, frame, density, body);
  } else {
    const Frame inside = frameIn(frame, f);
    for (const NodePtr& child : f.children("children")) bounds(*child, inside, density, body);
  }
  f.finish();
}

void GeometryReader::addBounds(const Node& node, const Frame& around, std::optional<double> density, mjcf::Body& body) {
  const Frame frame = standing(node, around);
  r_.leaveOut(node, "a bounding object", [&] {
    auto shape = geometry(node, frame, true);
    if (!shape) return;
    mjcf::Geom g;
    g.from = node.element();
    g.pose = frame.pose;
    g.group = kCollisionGroup;
    // As in Webots, planes and grids have no mass.
    if (density && shape->shape != Shape::plane && node.type != "ElevationGrid")
      g.mass = mjcf::moved(massOf(*shape, {.density = *density, .mass = {}}, node), frame.pose);
    mjcf::mendMass(g, r_.unsupported);
    g.shape = std::move(*shape);
    body.geoms.push_back(std::move(g));
  });
}

/// A mesh weighs what it encloses, whatever it collides as.
engine::Mass GeometryReader::massOf(const ShapeDescription& shape, const mjcf::Weight& weight, const Node& node) {
  const auto surface = surfaces_.find(shape.mesh.get());
  if (shape.shape != Shape::convex || surface == surfaces_.end()) return mjcf::shapeMass(shape, weight, node.element());
  const engine::Mesh& mesh = *surface->second;
  if (meshes::isClosed(mesh) && mjcf::hasVolume(mesh, mjcf::MeshInertia::exact))
    return mjcf::meshMass(mesh, weight, node.element());
  r_.ignore(node,
            fmt::format("the surface of this {} is not closed, or its faces do not agree where outside is: its mass "
                        "and inertia are those of its convex hull",
                        node.type));
  return mjcf::shapeMass(shape, weight, node.element());
}

/// nullopt for what is not supported, which is named.
std::optional<ShapeDescription> GeometryReader::geometry(const Node& node, const Frame& frame, bool collides) {
  r_.visit(node);
  Fields f(node, r_.unsupported);
  f.ignore({"subdivision", "ico", "bottom", "top", "side", "ccw", "name", "materialIndex", "solid", "convex",
            "creaseAngle", "normal", "normalIndex", "normalPerVertex", "texCoord", "texCoordIndex", "color",
            "colorIndex", "colorPerVertex"});
  ShapeDescription s;
  const Vec3 lengths = frame.scale.cwiseAbs();  // these shapes are their own mirror images
  if (node.type == "Box") {
    s.lengths = f.vector("size", Vec3(2, 2, 2)).cwiseProduct(lengths);
    if (!(s.lengths.minCoeff() > 0)) throw f.error("size", "expected three lengths above 0 for 'size' of Box");
  } else if (node.type == "Sphere" || node.type == "Cylinder" || node.type == "Capsule") {
    s.shape = node.type == "Sphere" ? Shape::sphere : node.type == "Cylinder" ? Shape::cylinder : Shape::capsule;
    const bool round = s.shape == Shape::cylinder ? lengths.x() == lengths.y() : frame.isUniform();
    if (!round) throw needsUniform(node);
    s.radius = f.number("radius", 1) * lengths.x();
    s.length = s.shape == Shape::sphere ? 0 : f.number("height", 2) * lengths.z();
    if (!(s.radius > 0))
      throw f.error("radius", fmt::format("expected a length above 0 for 'radius' of {}", node.type));
    if (s.shape != Shape::sphere && !(s.length > 0))
      throw f.error("height", fmt::format("expected a length above 0 for 'height' of {}", node.type));
  } else if (node.type == "Plane") {
    if (!collides) return std::nullopt;  // viewers draw no planes
    f.ignore({"size"});
    s.shape = Shape::plane;
  } else if (node.type == "Mesh" || node.type == "IndexedFaceSet" || node.type == "ElevationGrid") {
    s.shape = Shape::mesh;
    f.ignore({"url", "coord", "coordIndex", "height", "xDimension", "yDimension", "zDimension", "xSpacing", "ySpacing",
              "zSpacing", "thickness"});
    f.finish();
    // What viewers would not draw need not be read.
    if (!collides) return s;
    s = hull(node, frame.scale);
    count(node, *s.mesh);
    return s;
  } else if (isOtherGeometry(node.type)) {
    r_.ignore(node, fmt::format("the geometry {} is not supported", node.type));
    return std::nullopt;
  } else {
    r_.missing(node);
    return std::nullopt;
  }
  f.finish();
  return s;
}

/// Each use of a mesh has a copy.
void GeometryReader::count(const Node& node, const engine::Mesh& mesh) {
  numbers_ += mesh.vertices.size() + mesh.triangles.size();
  if (numbers_ > mjcf::kMaxMeshNumbers)
    throw LimitError(fmt::format("{}: the meshes of all nodes have more than {} numbers", node.element().where(),
                                 mjcf::kMaxMeshNumbers));
}

/// The convex hull of a mesh, scaled; a flat one itself.
ShapeDescription GeometryReader::hull(const Node& node, const Vec3& scale) {
  const auto [known, isNew] = shapes_.try_emplace({&node, {scale.x(), scale.y(), scale.z()}});
  ShapeDescription& s = known->second;
  if (!isNew && s.mesh) return s;
  engine::Mesh mesh = meshOf(node);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] *= scale[static_cast<int>(i % 3)];
    if (!std::isfinite(mesh.vertices[i])) throw node.element().error("expected vertices of finite numbers");
  }
  // A mirrored triangle is seen from its other side.
  if (scale.prod() < 0)
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  const auto surface = std::make_shared<const engine::Mesh>(std::move(mesh));
  const bool hasTriangles = !surface->triangles.empty();
  s.shape = Shape::convex;
  try {
    s.mesh = meshes::keptHullOf(surface);
    if (hasTriangles) surfaces_[s.mesh.get()] = surface;
  } catch (const Error& error) {
    if (!hasTriangles || !meshes::hasArea(*surface))
      throw Error(fmt::format("{}: the {} has no convex hull", node.element().where(), node.type), error);
    s.shape = Shape::mesh;
    s.mesh = surface;
  }
  return s;
}

const engine::Mesh& GeometryReader::meshOf(const Node& node) {
  if (const auto known = meshes_.find(&node); known != meshes_.end()) return known->second;
  Fields f(node, r_.unsupported);
  engine::Mesh mesh = node.type == "Mesh" ? meshFile(f) : node.type == "ElevationGrid" ? grid(f) : faces(f);
  if (!f.flag("ccw", true))
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  count(node, mesh);
  return meshes_.emplace(&node, std::move(mesh)).first->second;
}

engine::Mesh GeometryReader::meshFile(Fields& f) {
  const std::vector<std::string>* const urls = f.texts("url");
  if (!urls) throw f.error("url", "expected the name of a file for 'url' of Mesh");
  try {
    return readMesh_(f.node().file->name, urls->front());
  } catch (const Error& error) {
    throw Error(fmt::format("{}: cannot read the mesh '{}'", f.element().where(), urls->front()), error);
  }
}

/// Heights over x and y, or in old files over x and z: there y is up, and z points away from y of here (see
/// standing()).
engine::Mesh GeometryReader::grid(Fields& f) {
  const char* const rows = f.node().yUp ? "zDimension" : "yDimension";
  const auto count = [&](const char* field) {
    const double v = f.number(field, 0);
    if (!(v >= 2 && v <= double(kMostInRow) && v == std::floor(v)))
      throw f.error(field,
                    fmt::format("expected a whole number from 2 to {} for '{}', found {}", kMostInRow, field, v));
    return static_cast<std::uint32_t>(v);
  };
  const std::uint32_t nx = count("xDimension"), ny = count(rows);
  const double dx = f.number("xSpacing", 1), dy = f.number(f.node().yUp ? "zSpacing" : "ySpacing", 1);
  if (!(dx > 0 && dy > 0)) throw f.element().error("expected distances above 0 between the points of an ElevationGrid");
  const std::vector<double>* const heights = f.numbers("height");
  if (heights && heights->size() > std::size_t{nx} * ny)
    f.wrong("height", fmt::format("expected {} numbers for 'height', found {}; the others are ignored",
                                  std::size_t{nx} * ny, heights->size()));
  engine::Mesh mesh;
  for (std::uint32_t y = 0; y < ny; ++y)
    for (std::uint32_t x = 0; x < nx; ++x) {
      const std::size_t i = std::size_t{y} * nx + x;
      // Heights that are not given are 0.
      const double height = heights && i < heights->size() ? (*heights)[i] : 0;
      mesh.vertices.insert(mesh.vertices.end(), {x * dx, f.node().yUp ? -(y * dy) : y * dy, height});
    }
  for (std::uint32_t y = 0; y + 1 < ny; ++y)
    for (std::uint32_t x = 0; x + 1 < nx; ++x) {
      std::uint32_t right = y * nx + x + 1, above = right - 1 + nx;
      if (f.node().yUp) std::swap(right, above);
      mesh.triangles.insert(mesh.triangles.end(), {y * nx + x, right, above, right, y * nx + x + 1 + nx, above});
    }
  return mesh;
}

/// Polygons become fans of triangles. A polygon that names a point that is not there is left out.
engine::Mesh GeometryReader::faces(Fields& f) {
  const Node* const coordinate = f.child("coord");
  if (!coordinate) throw f.error("coord", "expected a node Coordinate for 'coord' of IndexedFaceSet");
  Fields points(*coordinate, r_.unsupported);
  const std::vector<double>* const numbers = points.numbers("point");
  if (!numbers || numbers->size() % 3 != 0)
    throw points.error("point",
                       fmt::format("expected points of 3 numbers each for 'point' of Coordinate, found {} numbers",
                                   numbers ? numbers->size() : 0));
  points.ignore({"name"});
  points.finish();
  engine::Mesh mesh{*numbers, {}};
  const double count = static_cast<double>(numbers->size()) / 3;  // whole, see above
  std::vector<std::uint32_t> polygon;
  bool whole = true;
  const auto finish = [&] {
    if (!whole) r_.ignore(f.node(), "a polygon of 'coordIndex' names a point that is not there: it is left out");
    for (std::size_t i = 2; whole && i < polygon.size(); ++i)
      for (const std::size_t corner : {std::size_t{0}, i - 1, i}) mesh.triangles.push_back(polygon[corner]);
    polygon.clear();
    whole = true;
  };
  if (const std::vector<double>* const indices = f.numbers("coordIndex"))
    for (const double index : *indices) {
      if (index < 0)
        finish();
      else if (index < count && index == std::floor(index))
        polygon.push_back(static_cast<std::uint32_t>(index));
      else
        whole = false;
    }
  finish();
  return mesh;
}

std::optional<std::array<double, 4>> GeometryReader::colorOf(const Node& appearance) {
  Fields f(appearance, r_.unsupported);
  const Node* material = &appearance;
  const char* name = "baseColor";
  if (appearance.type == "Appearance") {
    material = f.child("material");
    name = "diffuseColor";
    if (!material) return std::nullopt;
  } else if (appearance.type != "PBRAppearance") {
    if (isBaseNode(appearance.type)) {
      r_.missing(appearance);
      return std::nullopt;
    }
    r_.ignore(appearance,
              fmt::format("the appearance {} is a PROTO that is not there; what has it is grey", appearance.type));
    return std::nullopt;
  }
  Fields of(*material, r_.unsupported);
  const Vec3 rgb = of.vector(name, name == std::string_view("baseColor") ? Vec3::Ones() : Vec3(0.8, 0.8, 0.8));
  f.ignore({"texture", "textureTransform", "name", "baseColorMap", "roughness", "roughnessMap", "metalness",
            "metalnessMap", "IBLStrength", "normalMap", "normalMapFactor", "occlusionMap", "occlusionMapStrength",
            "emissiveColor", "emissiveColorMap", "emissiveIntensity", "baseColor", "transparency"});
  of.ignore({"ambientIntensity", "emissiveColor", "shininess", "specularColor"});
  const double opacity = 1 - std::clamp(of.number("transparency", 0), 0.0, 1.0);
  f.finish();
  if (material != &appearance) of.finish();
  return std::array{std::clamp(rgb.x(), 0.0, 1.0), std::clamp(rgb.y(), 0.0, 1.0), std::clamp(rgb.z(), 0.0, 1.0),
                    opacity};
}

}  // namespace spark::webots
