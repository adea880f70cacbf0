#include "geom_reader.h"

#include <fmt/format.h>

#include "mesh_fit.h"

namespace spark::mjcf {

using engine::Shape;
using engine::ShapeDescription;

/// A group that is not shown.
constexpr int kHidden = 5;

/// Points on an ellipsoid with these half axes: 12 rings of 24 and both poles, and the triangles between them.
engine::Mesh ellipsoidMesh(const Vec3& half) {
  constexpr int kRings = 12, kAround = 24;
  engine::Mesh mesh;
  const auto add = [&](double height, double angle) {
    const double r = std::sin(height);
    for (const double v : {half.x() * r * std::cos(angle), half.y() * r * std::sin(angle), half.z() * std::cos(height)})
      mesh.vertices.push_back(v);
  };
  for (int i = 1; i <= kRings; ++i)
    for (int k = 0; k < kAround; ++k) add(kPi * i / (kRings + 1), 2 * kPi * k / kAround);
  add(0, 0);
  add(kPi, 0);
  const auto at = [](int ring, int k) { return static_cast<std::uint32_t>(ring * kAround + k % kAround); };
  constexpr std::uint32_t kTop = kRings * kAround, kBottom = kTop + 1;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
  };
  for (int k = 0; k < kAround; ++k) {
    triangle(kTop, at(0, k), at(0, k + 1));
    triangle(kBottom, at(kRings - 1, k + 1), at(kRings - 1, k));
    for (int i = 0; i + 1 < kRings; ++i) {
      triangle(at(i, k), at(i + 1, k), at(i, k + 1));
      triangle(at(i, k + 1), at(i + 1, k), at(i + 1, k + 1));
    }
  }
  return mesh;
}

int dimensionsOf(Attributes& a) {
  const int condim = a.integer("condim", 3);
  if (condim != 1 && condim != 3 && condim != 4 && condim != 6)
    throw a.element().error(fmt::format("expected 1, 3, 4 or 6 for 'condim', found {}", condim));
  return condim;
}

std::optional<Geom> GeomReader::read(Attributes& a, Body& body, const Pose& frame) {
  Geom g;
  g.from = a.element();
  g.name = a.text("name");
  contact(a, g);
  body.isWeighed |= compiler_.weighs(g.group);
  const std::string type =
      a.word("type", {"plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"}, "sphere");
  const double density = a.number("density", 1000);
  const auto weight = [&] {
    return Weight{density, a.has("mass") ? std::optional(a.number("mass", 0)) : std::nullopt};
  };
  a.ignore({"material", "rgba", "user", "hfield", "fitscale", "mass", "mesh"});

  if (const double mass = weight().of(1); mass < 0)
    throw g.from.error(fmt::format("expected a mass or density of 0 or more, found {}", mass));
  // What is not supported, and what is only seen: its mesh is not loaded.
  const auto without = [&](const std::string& what) {
    unsupported_.add(g.from, what);
    return std::nullopt;
  };
  if (type == "sdf") return without(fmt::format("a <geom> of type {} is not supported", type));
  if (type != "mesh" && a.has("mesh") && compiler_.fitsBounds())
    return without("a <geom> that is fitted to the bounds of a mesh (fitaabb) is not supported");
  const bool world = body.parent < 0, counts = !body.hasInertial || compiler_.inertiaFromGeom() == "true";
  const bool weightless = world || !counts || weight().of(1) == 0;
  if (type == "mesh" && !g.collides() && weightless && !inPairs_.contains(g.name)) {
    a.ignore({"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "size", "fromto"});
    a.finish();
    return std::nullopt;
  }

  place(a, type, frame, g);
  const bool ellipsoid = type == "ellipsoid";
  if (type != "plane" && type != "hfield" && !weightless && compiler_.weighs(g.group)) {
    const engine::Mass own = massOf(a, type, weight(), g);
    if (own.mass > 0) g.mass = moved(own, g.pose);
  }
  if (ellipsoid) {
    // Engines other than MuJoCo have it as the hull of points on it, and no viewer shows it.
    g.ellipsoid = g.shape.lengths / 2;
    g.shape.shape = Shape::convex;
    g.shape.mesh = std::make_shared<engine::Mesh>(ellipsoidMesh(g.ellipsoid));
    g.group = kHidden;
  }
  a.finish();
  return g;
}

engine::Mass GeomReader::massOf(Attributes& a, const std::string& type, const Weight& weight, const Geom& g) {
  if (type == "ellipsoid") return ellipsoidMass(g.shape.lengths / 2, weight);
  if (type != "mesh") return shapeMass(g.shape, weight, g.from);
  engine::Mass out = meshMass(a, weight, g.from);
  if (!(out.mass > 0)) unsupported_.add(g.from, "a <geom> adds no mass to its body: its mesh is flat");
  return out;
}

engine::Mass GeomReader::meshMass(Attributes& a, const Weight& weight, const Element& geom) {
  const Mesh& mesh = meshes_.get(a, unsupported_);
  const MeshInertia usual = compiler_.exactMeshInertia() ? MeshInertia::exact : MeshInertia::estimated;
  const MeshInertia inertia = mesh.inertia.value_or(usual);
  if (hasVolume(mesh.solid(), inertia)) return mjcf::meshMass(mesh.solid(), weight, geom, inertia);
  if (!mesh.hull) return {0, Vec3::Zero(), Mat3::Zero()};
  unsupported_.add(geom, "a <geom> weighs as the convex hull of its mesh, which has no volume");
  return mjcf::meshMass(*mesh.hull, weight, geom, MeshInertia::exact);
}

void GeomReader::contact(Attributes& a, Geom& g) const {
  g.contactTypes = a.integer("contype", 1);
  g.contactAffinities = a.integer("conaffinity", 1);
  g.group = a.integer("group", 0);
  ContactNumbers& m = g.contact;
  a.fill("friction", m.friction);
  if (std::any_of(m.friction.begin(), m.friction.end(), [](double f) { return f < 0; })) {
    a.note("'friction' of <geom> below 0 is taken as 0");
    for (double& f : m.friction) f = std::max(f, 0.0);
  }
  m.condim = dimensionsOf(a);
  m.priority = a.integer("priority", 0);
  a.fill("solref", m.solref);
  a.fill("solimp", m.solimp);
  m.margin = a.number("margin", 0);
  m.gap = a.number("gap", 0);
  m.solmix = a.within("solmix", 1, 0);
  m.ellipsoidDrag = a.word("fluidshape", {"none", "ellipsoid"}, "none") == "ellipsoid";
  a.fill("fluidcoef", m.dragCoefficients);
}

/// Reads pose and shape.
void GeomReader::place(Attributes& a, const std::string& type, const Pose& frame, Geom& g) {
  Vec3 size = Vec3::Zero();
  a.fill("size", size);
  const bool thick = type == "box" || type == "ellipsoid";
  if (const auto span = compiler_.fromTo(a, frame)) {
    g.pose = span->pose;
    if (thick)
      size = {size[0], size[0], span->length / 2};
    else
      size[1] = span->length / 2;
  } else {
    g.pose = compiler_.pose(a, frame);
  }
  if (type != "mesh" && a.has("mesh")) {
    const Weight byVolume{1, std::nullopt};
    const engine::Mass mass = meshMass(a, byVolume, g.from);
    if (!(mass.mass > 0)) throw g.from.error("the mesh has no volume");
    const EquivalentBox box = equivalentBox(mass);
    g.pose = compose(g.pose, box.pose);
    size = a.number("fitscale", 1) * fittedSize(type, box.halfEdges);
  }
  // Each kind needs some of its lengths.
  const int needed = type == "sphere" ? 1 : type == "capsule" || type == "cylinder" ? 2 : thick ? 3 : 0;
  if (!(size.head(needed).array() > 0).all())
    throw g.from.error(fmt::format("the 'size' of {} {} needs {} above 0", type == "ellipsoid" ? "an" : "a", type,
                                   needed == 1 ? "a length" : fmt::format("{} lengths", needed)));
  shape(a, type, size, g);
}

void GeomReader::shape(Attributes& a, const std::string& type, const Vec3& size, Geom& g) {
  ShapeDescription& s = g.shape;
  if (type == "box" || type == "ellipsoid") {
    s.shape = Shape::box;
    s.lengths = 2 * size;
  } else if (type == "sphere") {
    s.shape = Shape::sphere;
    s.radius = size[0];
  } else if (type == "capsule" || type == "cylinder") {
    s.shape = type == "capsule" ? Shape::capsule : Shape::cylinder;
    s.radius = size[0];
    s.length = 2 * size[1];
  } else if (type == "plane") {
    s.shape = Shape::plane;
  } else if (type == "hfield") {
    heightFields_.shape(a, g);
  } else {
    const Mesh& mesh = meshes_.get(a, unsupported_);
    s.shape = mesh.hull ? Shape::convex : Shape::mesh;
    s.mesh = mesh.hull ? mesh.hull : mesh.surface;
  }
}

}  // namespace spark::mjcf
