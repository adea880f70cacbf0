#include "geom_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/appearance.h"
#include "meshes/hull.h"
#include "spark/access.h"

namespace spark::mjcf {

using engine::Shape;
using engine::ShapeDescription;

namespace {

List matrix(const Mat3& r) {
  List out;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) out.emplace_back(r(row, column));
    out.emplace_back(0.0);
  }
  for (const double v : {0.0, 0.0, 0.0, 1.0}) out.emplace_back(v);
  return out;
}

bool hasMesh(const ShapeDescription& s) { return s.shape == Shape::mesh || s.shape == Shape::convex; }

List trianglesOf(const engine::Mesh& mesh) {
  List out;
  for (const std::uint32_t t : mesh.triangles) out.emplace_back(static_cast<std::int64_t>(t));
  return out;
}

/// Sets a collider's shape; `pose`: in its body, or in the world.
void setShape(Leaf& collider, const ShapeDescription& s, const Pose& pose) {
  switch (s.shape) {
    case Shape::box:
      callMethod(collider, "setBoxLengths", toList(s.lengths));
      break;
    case Shape::sphere:
      callMethod(collider, "setRadius", List{s.radius});
      break;
    case Shape::capsule:
    case Shape::cylinder:
      callMethod(collider, "setParams", List{s.radius, s.length});
      break;
    case Shape::plane: {
      const Vec3 normal = pose.rotation.col(2);
      callMethod(collider, "setParams", List{normal.x(), normal.y(), normal.z(), normal.dot(pose.position)});
      return;
    }
    case Shape::heightField: {
      const engine::HeightField& f = *s.heightField;
      setProperty(collider, "size", List{f.width, f.depth, 1.0});
      setProperty(collider, "columns", f.columns);
      setProperty(collider, "heights", List(f.heights.begin(), f.heights.end()));
      break;
    }
    default:
      setProperty(collider, "vertices", List(s.mesh->vertices.begin(), s.mesh->vertices.end()));
      // A hull is known by its corners.
      if (s.shape == Shape::mesh) setProperty(collider, "triangles", trianglesOf(*s.mesh));
      break;
  }
  callMethod(collider, "setRotation", matrix(pose.rotation));
  callMethod(collider, "setLocalPosition", toList(pose.position));
}

/// Sets what MuJoCo makes the hull of a collider of, so that its hull is the same as in MuJoCo alone.
void setSurface(Node& collider, const engine::Mesh& surface) {
  Leaf* const mesh = extensionOf(collider, "MujocoMesh", "mujocoMesh");
  if (!mesh) return;
  setWritten(*mesh, "");
  setProperty(*mesh, "vertices", List(surface.vertices.begin(), surface.vertices.end()));
  setProperty(*mesh, "triangles", trianglesOf(surface));
}

/// True if a surface has no numbers but those that act with every engine.
bool isPlain(ContactNumbers m) {
  const ContactNumbers usual;
  m.friction[0] = usual.friction[0];
  // Torsional and rolling friction act from four dimensions on; one dimension is a contact without friction.
  if (m.condim <= 3) m.friction = usual.friction, m.condim = usual.condim;
  m.priority = 0;
  return m == usual;
}

void setContact(Node& collider, const Geom& g) {
  const ContactNumbers& m = g.contact;
  const bool isEllipsoid = g.ellipsoid[0] > 0;
  // Also usual numbers: they count where a collider has none.
  if (Leaf* const numbers = extensionOf(collider, "MujocoSurface")) {
    const bool isLost = isEllipsoid || !isPlain(m);
    setWritten(*numbers, isLost ? "what a contact has beside sliding friction: " + g.from.placed() : "");
    setProperty(*numbers, "friction", toList(m.friction));
    setProperty(*numbers, "condim", m.condim);
    setProperty(*numbers, "priority", m.priority);
    setProperty(*numbers, "solref", toList(m.solref));
    setProperty(*numbers, "solimp", toList(m.solimp));
    setProperty(*numbers, "margin", m.margin);
    setProperty(*numbers, "gap", m.gap);
    setProperty(*numbers, "solmix", m.solmix);
    setProperty(*numbers, "ellipsoid", toList(g.ellipsoid));
    setProperty(*numbers, "thickness", m.thickness);
    setProperty(*numbers, "ellipsoidDrag", m.ellipsoidDrag);
    setProperty(*numbers, "dragCoefficients", toList(m.dragCoefficients));
  }
  setProperty(collider, "contactTypes", g.contactTypes);
  setProperty(collider, "contactAffinities", g.contactAffinities);
  // For the other engines.
  if (m.priority != 0) setProperty(collider, "priority", m.priority);
  Leaf& surface = collider.create("ContactJointHandler", "surface");
  setProperty(surface, "contactBounceMode", false);
  setProperty(surface, "contactMu", m.condim == 1 ? 0.0 : m.friction[0]);
  setProperty(surface, "contactPyramid", true);
}

}  // namespace

void GeomBuilder::build() {
  for (PlacedBody& b : c_.bodies) makeGeoms(b), makeSites(b);
  for (const Exclusion& x : c_.model.exclusions) c_.unsupported.attempt(x.from, [&] { exclude(x); });
  for (const Pair& p : c_.model.pairs) c_.attempt(p.from, c_.top, [&] { pair(p); });
}

void GeomBuilder::makeGeoms(PlacedBody& p) {
  // Where a body is drawn by meshes alone, which viewers do not have, its collision shapes are shown.
  const std::vector<Geom>& geoms = p.body->geoms;
  const bool drawn =
      std::any_of(geoms.begin(), geoms.end(), [](const Geom& g) { return g.visible() && !hasMesh(g.shape); });
  for (const Geom& g : geoms) {
    const bool collides = c_.flags.contact && g.isShape && (g.collides() || inPair(g.name));
    if (!collides && g.contact.ellipsoidDrag)
      c_.unsupported.add(g.from, "drag at the ellipsoid of a <geom> that does not collide is not supported");
    if (collides && !c_.attempt(g.from, c_.nodeOf(p), [&] { makeCollider(g, p); })) continue;
    if (g.visible() || !drawn) c_.attempt(g.from, c_.nodeOf(p), [&] { makeVisible(g, p); });
  }
}

const engine::Mesh* GeomBuilder::sourceOf(const ShapeDescription& hull) const {
  const auto found = c_.model.surfaces.find(hull.mesh.get());
  return found == c_.model.surfaces.end() ? nullptr : found->second.get();
}

ShapeDescription GeomBuilder::collisionShape(const Geom& g, bool moves) {
  const engine::Mesh* const surface = g.shape.shape == Shape::convex ? sourceOf(g.shape) : nullptr;
  if (!surface || c_.model.meshesAreHulls || meshes::isConvex(*surface, *g.shape.mesh)) return g.shape;
  if (moves) {
    c_.unsupported.add(g.from,
                       fmt::format("a <{}> that moves and is not convex collides as its convex hull", g.from.tag()));
    return g.shape;
  }
  ShapeDescription out{.shape = Shape::mesh};
  out.mesh = c_.model.surfaces.at(g.shape.mesh.get());
  return out;
}

void GeomBuilder::makeCollider(const Geom& g, PlacedBody& p) {
  const bool moves = p.carrier != 0;
  if (g.shape.shape == Shape::mesh && moves)
    return c_.unsupported.add(
        g.from, fmt::format("a <{}> is left out: a flat mesh has no convex hull, and collides only where it does not "
                            "move",
                            g.from.tag()));
  if (g.shape.shape == Shape::heightField && moves)
    return c_.unsupported.add(
        g.from, fmt::format("a <{}> is left out: a height field collides only where it does not move", g.from.tag()));
  const ShapeDescription shape = collisionShape(g, moves);
  const char* const kinds[] = {"BoxCollider",      "SphereCollider", "CapsuleCollider",
                               "CylinderCollider", "PlaneCollider",  "",
                               "TriMeshCollider",  "ConvexCollider", "HeightFieldCollider"};
  const char* const kind = kinds[static_cast<int>(shape.shape)];
  Node& parent = c_.nodeOf(p);
  Node& collider = *parent.create(kind, c_.names.collider(parent, g.name)).asNode();
  setShape(collider, shape, moves ? c_.inNode(p, g.pose) : compose(p.world, g.pose));
  setContact(collider, g);
  const engine::Mesh* const surface = c_.model.meshesAreHulls ? sourceOf(shape) : nullptr;
  if (surface && *surface != *shape.mesh) setSurface(collider, *surface);
  setProperty(collider, "part", p.part);
  p.colliders.push_back(&collider);
  if (!g.name.empty() && !c_.colliders.emplace(g.name, &collider).second)
    c_.unsupported.add(g.from, fmt::format("{} has the name of another one: pairs name the first", g.from.named()));
}

void GeomBuilder::makeVisible(const Geom& g, const PlacedBody& p) {
  const ShapeDescription& s = g.shape;
  const char* const kinds[] = {"Box", "Sphere", "Capsule", "Cylinder"};
  const auto kind = static_cast<std::size_t>(s.shape);
  if (kind >= std::size(kinds)) return;
  Node& parent = c_.nodeOf(p);
  const std::string name = c_.names.in(parent, g.name.empty() ? "" : g.name + "-shape", "shape");
  Leaf& shape = c_.transform(parent, name, c_.inNode(p, g.pose)).create(kinds[kind]);
  if (s.shape == Shape::box)
    callMethod(shape, "setExtents", toList(s.lengths));
  else if (s.shape == Shape::sphere)
    callMethod(shape, "setRadius", List{s.radius});
  else
    callMethod(shape, "setParams", List{s.radius, s.length});
  callMethod(shape, "setMaterial", List{g.color ? materialOf(*g.color) : "matGrey"});
}

/// A material of that colour: "rgbb22222", which the page in browsers knows too. It is defined where materials are.
std::string GeomBuilder::materialOf(const std::array<double, 4>& color) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  std::string name = fmt::format("rgb{:02x}{:02x}{:02x}", byte(color[0]), byte(color[1]), byte(color[2]));
  if (Leaf* const materials = c_.top.kernel().root().find(IMaterial::kFolder))
    callMethod(*materials, "define", List{name, toList(color)});
  return name;
}

void GeomBuilder::makeSites(const PlacedBody& p) {
  for (const Site& s : p.body->sites) {
    Node& parent = c_.nodeOf(p);
    Node& made = c_.transform(parent, c_.names.in(parent, s.name, "site"), c_.inNode(p, s.pose));
    if (!s.name.empty()) c_.sites.emplace(s.name, &made);
  }
}

void GeomBuilder::exclude(const Exclusion& x) {
  const PlacedBody &a = c_.bodies.find(x.body1, x.from), &b = c_.bodies.find(x.body2, x.from);
  for (Node* first : a.colliders)
    for (const Node* second : b.colliders)
      callMethod(*first, "addNotCollideWithColliderName", List{second->name(), true});
}

void GeomBuilder::pair(const Pair& p) {
  if (!c_.flags.contact) return;
  const auto first = c_.colliders.find(p.geom1), second = c_.colliders.find(p.geom2), none = c_.colliders.end();
  for (const std::string& name : {p.geom1, p.geom2})
    if (c_.model.unsupportedGeoms.contains(name))
      return c_.unsupported.add(p.from, fmt::format("a <pair> of the unsupported geom '{}' is not supported", name));
  if (first == none || second == none)
    throw p.from.error(fmt::format("there is no geom '{}'", first == none ? p.geom1 : p.geom2));
  surfaceOf(p, *first->second, *second->second);
  callMethod(*first->second, "addCollideWithColliderName", List{second->second->name(), true});
}

void GeomBuilder::surfaceOf(const Pair& p, const Node& first, const Node& second) {
  if (!provides(c_.top.kernel(), "MujocoPair")) {
    if (p.condim || p.friction || p.solref || p.solimp || p.margin || p.gap)
      c_.unsupported.add(p.from, "the surface of a <pair> needs the plugin physics-mujoco, which is not there");
    return;
  }
  Leaf& node = c_.top.create("MujocoPair", c_.names.in(c_.top, "", "pair"));
  const bool isLost = p.condim || p.friction || p.solref || p.solimp || p.margin || p.gap;
  setWritten(node, isLost ? "the surface of " + p.from.placed() : "");
  // What a pair does not give has MuJoCo's values for pairs, whatever its geoms have.
  if (p.condim) setProperty(node, "condim", *p.condim);
  if (p.friction) setProperty(node, "friction", toList(*p.friction));
  if (p.solref) setProperty(node, "solref", toList(*p.solref));
  if (p.solimp) setProperty(node, "solimp", toList(*p.solimp));
  if (p.margin) setProperty(node, "margin", *p.margin);
  if (p.gap) setProperty(node, "gap", *p.gap);
  const auto path = [&](const Node& collider) {
    return collider.parent() == &c_.top ? "../" + collider.name()
                                        : "../" + collider.parent()->name() + "/" + collider.name();
  };
  setProperty(node, "first", path(first));
  setProperty(node, "second", path(second));
}

bool GeomBuilder::inPair(const std::string& geom) const {
  const std::vector<Pair>& pairs = c_.model.pairs;
  return !geom.empty() &&
         std::any_of(pairs.begin(), pairs.end(), [&](const Pair& p) { return p.geom1 == geom || p.geom2 == geom; });
}

}  // namespace spark::mjcf
