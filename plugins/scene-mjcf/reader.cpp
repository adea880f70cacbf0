#include "reader.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "../physics/mass.h"

namespace spark::mjcf {

using engine::Shape;
using engine::ShapeDescription;

namespace {

/// Elements that say how MuJoCo's own programs show a model, or hold what is no part of it.
const std::set<std::string_view> kNotSimulated{"visual", "statistic", "custom", "size", "keyframe", "camera", "light"};

Mat3 turnTo(const Vec3& z) { return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), z).toRotationMatrix(); }

template <class Array>
Vec3 toVec(const Array& a) {
  return {a[0], a[1], a[2]};
}

/// Mass, centre and inertia of a closed mesh of uniform density 1 (Eberly, "Polyhedral Mass Properties", 2002, as sums
/// over tetrahedra from the origin).
engine::Mass meshMass(const ShapeDescription& s) {
  const auto vertex = [&](std::uint32_t i) {
    return Vec3(s.vertices[3 * i], s.vertices[3 * i + 1], s.vertices[3 * i + 2]);
  };
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // integral of x x^T
  for (std::size_t t = 0; t + 2 < s.triangles.size(); t += 3) {
    Mat3 corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = vertex(s.triangles[t + static_cast<std::size_t>(i)]);
    const double det = corners.determinant();
    const Vec3 sum = corners.rowwise().sum();
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (corners * corners.transpose() + sum * sum.transpose());
  }
  if (volume < 0) volume = -volume, first = -first, second = -second;
  if (!(volume > 0)) return {0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 center = first / volume;
  second -= volume * center * center.transpose();
  return {volume, center, Mat3(second.trace() * Mat3::Identity() - second)};
}

/// The same mass as seen from outside its frame; its inertia stays about its centre.
engine::Mass moved(const engine::Mass& m, const Pose& at) {
  return {m.mass, at.position + at.rotation * m.center, at.rotation * m.inertia * at.rotation.transpose()};
}

}  // namespace

Model readModel(Document& document, const ReadMesh& readMesh, LeftOver& leftOver) {
  return Reader(document, readMesh, leftOver).read();
}

Model Reader::read() {
  const Element root = document_.root();
  model_.name = root.node.attribute("model").as_string("model");
  model_.bodies.emplace_back();
  model_.bodies.front().from = root;
  const std::vector<Element> sections = document_.children(root);
  const auto each = [&](std::string_view tag, auto handle) {
    for (const Element& e : sections)
      if (e.tag() == tag) handle(e);
  };
  each("compiler", [&](const Element& e) { compiler(e); });
  each("default", [&](const Element& e) { defaults_.add(document_, e); });
  each("option", [&](const Element& e) { option(e); });
  each("asset", [&](const Element& e) { asset(e); });
  each("worldbody", [&](const Element& e) { content(e, {}); });
  finishMasses();
  each("contact", [&](const Element& e) { contact(e); });
  each("actuator", [&](const Element& e) {
    for (const Element& child : document_.children(e)) actuator(child);
  });
  each("sensor", [&](const Element& e) {
    for (const Element& child : document_.children(e)) sensor(child);
  });
  for (const Element& e : sections)
    if (const auto tag = e.tag(); !std::set<std::string_view>{"compiler", "default", "option", "asset", "worldbody",
                                                              "contact", "actuator", "sensor"}
                                       .contains(tag) &&
                                  !kNotSimulated.contains(tag))
      leftOver_.element(e);
  return std::move(model_);
}

Attributes Reader::attributes(const Element& e, const std::string& childClass) {
  if (++elements_ > kMaxElements) throw e.error(fmt::format("expected at most {} elements", kMaxElements));
  const char* const own = e.node.attribute("class").value();
  return Attributes(e, defaults_, *own ? own : childClass, leftOver_);
}

// ---- compiler, options, assets ----

void Reader::compiler(const Element& e) {
  Attributes a = attributes(e);
  Compiler& c = compiler_;
  c.degrees = a.word("angle", {"degree", "radian"}, c.degrees ? "degree" : "radian") == "degree";
  c.autolimits = a.flag("autolimits", c.autolimits);
  c.eulerSequence = a.text("eulerseq", c.eulerSequence.c_str());
  if (c.eulerSequence.size() != 3 || c.eulerSequence.find_first_not_of("xyzXYZ") != std::string::npos)
    throw e.error(fmt::format("expected three of x y z X Y Z for 'eulerseq', found '{}'", c.eulerSequence));
  std::string folder = a.text("meshdir", a.text("assetdir", c.meshFolder.c_str()).c_str());
  if (!folder.empty() && folder.back() != '/') folder += '/';
  while (folder.starts_with("./")) folder.erase(0, 2);
  c.meshFolder = folder;
  c.inertiaFromGeom = a.word("inertiafromgeom", {"auto", "true", "false"}, c.inertiaFromGeom.c_str());
  a.take("inertiagrouprange", c.inertiaGroups);
  c.boundMass = a.number("boundmass", c.boundMass);
  c.boundInertia = a.number("boundinertia", c.boundInertia);
  if (a.text("coordinate", "local") != "local") throw e.error("expected the coordinate frame 'local'");
  // Bodies without joints become part of their parents in any case.
  a.ignore({"texturedir", "discardvisual", "fusestatic", "convexhull", "usethread", "balanceinertia",
            "exactmeshinertia", "alignfree"});
  a.finish();
}

void Reader::option(const Element& e) {
  Attributes a = attributes(e);
  const auto set = [&](const char* property, Value v) { model_.options.push_back({e, property, std::move(v)}); };
  const auto number = [&](const char* name, const char* property, double least) {
    if (!a.has(name)) return;
    const double v = a.number(name, 0);
    if (v < least) throw e.error(fmt::format("expected at least {} for '{}' of <option>, found {}", least, name, v));
    set(property, v);
  };
  const auto vector = [&](const char* name, const char* property) {
    if (Vec3 v = Vec3::Zero(); a.take(name, v)) set(property, List{v.x(), v.y(), v.z()});
  };
  vector("gravity", "gravity");
  vector("wind", "mujocoWind");
  number("timestep", "timestep", 1e-6);
  number("tolerance", "mujocoTolerance", 0);
  number("impratio", "mujocoImpratio", 1e-6);
  number("density", "mujocoDensity", 0);
  number("viscosity", "mujocoViscosity", 0);
  if (a.has("iterations")) set("mujocoIterations", std::max(1, a.integer("iterations", 100)));
  if (a.has("cone")) set("mujocoCone", a.word("cone", {"pyramidal", "elliptic"}, ""));
  if (a.has("solver")) set("mujocoSolver", a.word("solver", {"PGS", "CG", "Newton"}, ""));
  if (a.has("integrator")) {
    const std::string wanted = a.word("integrator", {"Euler", "RK4", "implicit", "implicitfast"}, "");
    const std::string taken = wanted == "RK4" ? "Euler" : wanted == "implicitfast" ? "implicit" : wanted;
    if (wanted != taken)
      leftOver_.add(e, fmt::format("the integrator {} is left out; {} takes its place", wanted, taken));
    set("mujocoIntegrator", taken);
  }
  a.ignore({"jacobian"});
  a.finish();
  for (const Element& child : document_.children(e)) leftOver_.element(child);
}

void Reader::asset(const Element& e) {
  for (const Element& child : document_.children(e)) {
    if (child.tag() == "mesh")
      mesh(child);
    else if (child.tag() != "material" && child.tag() != "texture")
      leftOver_.element(child);
  }
}

void Reader::mesh(const Element& e) {
  Attributes a = attributes(e);
  MeshAsset m;
  m.from = e;
  m.file = a.text("file");
  a.take("scale", m.scale);
  std::string name = a.text("name");
  if (name.empty()) {
    const std::size_t slash = m.file.rfind('/'), start = slash == std::string::npos ? 0 : slash + 1;
    name = m.file.substr(start, m.file.rfind('.') - start);
  }
  a.ignore({"smoothnormal", "texcoord", "normal", "maxhullvert", "content_type"});
  a.finish();
  meshes_[name] = std::move(m);
}

// ---- poses ----

std::optional<Mat3> Reader::orientation(Attributes& a) {
  std::array<double, 4> four{};
  if (a.take("quat", four)) {
    const Eigen::Quaterniond q(four[0], four[1], four[2], four[3]);
    if (!(q.norm() > 1e-10)) throw a.element().error("expected a quaternion that is not 0");
    return q.normalized().toRotationMatrix();
  }
  if (a.take("axisangle", four)) {
    const Vec3 axis = toVec(four);
    if (!(axis.norm() > 1e-10)) throw a.element().error("expected an axis that is not 0 in 'axisangle'");
    return Eigen::AngleAxisd(angle(four[3]), axis.normalized()).toRotationMatrix();
  }
  std::array<double, 6> six{};
  if (a.take("xyaxes", six)) {
    const Vec3 x = Vec3(six[0], six[1], six[2]).normalized(), along = Vec3(six[3], six[4], six[5]);
    const Vec3 y = (along - x * x.dot(along)).normalized();
    Mat3 r;
    r << x, y, x.cross(y);
    if (!r.allFinite()) throw a.element().error("expected two different directions in 'xyaxes'");
    return r;
  }
  if (Vec3 z; a.take("zaxis", z)) {
    if (!(z.norm() > 1e-10)) throw a.element().error("expected a direction that is not 0 in 'zaxis'");
    return turnTo(z);
  }
  if (Vec3 angles; a.take("euler", angles)) {
    Mat3 r = Mat3::Identity();
    for (int i = 0; i < 3; ++i) {
      const char letter = compiler_.eulerSequence[static_cast<std::size_t>(i)];
      const bool fixedFrame = letter < 'a';
      const Mat3 turn = Eigen::AngleAxisd(angle(angles[i]), Vec3(Vec3::Unit((letter | 32) - 'x'))).toRotationMatrix();
      r = fixedFrame ? Mat3(turn * r) : Mat3(r * turn);
    }
    return r;
  }
  return std::nullopt;
}

Pose Reader::pose(Attributes& a, const Scope& scope) {
  Pose p;
  a.take("pos", p.position);
  if (!(p.position.cwiseAbs().maxCoeff() <= 1e6)) throw a.element().error("expected a place at most 1e6 m away");
  if (const auto r = orientation(a)) p.rotation = *r;
  return compose(scope.frame, p);
}

bool Reader::fromTo(Attributes& a, const Scope& scope, Pose& pose, double& length) {
  std::array<double, 6> ends{};
  if (!a.take("fromto", ends)) return false;
  const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
  length = (to - from).norm();
  if (!(length > 1e-10)) throw a.element().error("expected two different points in 'fromto'");
  // z points from the second to the first point, as in MuJoCo.
  pose = compose(scope.frame, {(from + to) / 2, turnTo(from - to)});
  return true;
}

bool Reader::limited(Attributes& a, const char* flag, const char* what,
                     const std::optional<std::vector<double>>& range) {
  const std::string word = a.word(flag, {"true", "false", "auto"}, "auto");
  const bool on = word == "auto" ? range && compiler_.autolimits : word == "true";
  if (on && (!range || !((*range)[0] < (*range)[1])))
    throw a.element().error(fmt::format("expected a lower and a higher number for '{}' of <{}>, which is limited", what,
                                        a.element().tag()));
  return on;
}

// ---- bodies ----

void Reader::content(const Element& parent, const Scope& scope) {
  if (scope.depth > Document::kMaxDepth)
    throw parent.error(fmt::format("expected at most {} elements in each other", Document::kMaxDepth));
  for (const Element& e : document_.children(parent)) {
    const std::string_view tag = e.tag();
    if (tag == "body")
      body(e, scope);
    else if (tag == "frame")
      frame(e, scope);
    else if (tag == "joint" || tag == "freejoint")
      joint(e, scope);
    else if (tag == "geom")
      geom(e, scope);
    else if (tag == "site")
      site(e, scope);
    else if (tag == "inertial")
      inertial(e, model_.bodies[static_cast<std::size_t>(scope.body)]);
    else if (!kNotSimulated.contains(tag))
      leftOver_.element(e);
  }
}

void Reader::body(const Element& e, const Scope& scope) {
  if (model_.bodies.size() > kMaxBodies) throw e.error(fmt::format("expected at most {} bodies", kMaxBodies));
  Attributes a = attributes(e, scope.childClass);
  Body b;
  b.from = e;
  b.name = a.text("name");
  b.parent = scope.body;
  b.pose = pose(a, scope);
  const std::string childClass = a.text("childclass", scope.childClass.c_str());
  a.ignore({"user"});
  a.finish();
  const int index = static_cast<int>(model_.bodies.size());
  model_.bodies.push_back(std::move(b));
  content(e, {index, childClass, {}, scope.depth + 1});
}

void Reader::frame(const Element& e, Scope scope) {
  Attributes a = attributes(e, scope.childClass);
  scope.frame = pose(a, scope);
  scope.childClass = a.text("childclass", scope.childClass.c_str());
  ++scope.depth;
  a.ignore({"name"});
  a.finish();
  content(e, scope);
}

void Reader::inertial(const Element& e, Body& b) {
  Attributes a = attributes(e);
  if (!a.has("mass")) throw e.error("expected an attribute 'mass'");
  b.mass.mass = a.number("mass", 0);
  Mat3 turn = Mat3::Identity();
  a.take("pos", b.mass.center);
  if (const auto r = orientation(a)) turn = *r;
  Vec3 diagonal = Vec3::Zero();
  std::array<double, 6> full{};
  if (a.take("fullinertia", full)) {
    b.mass.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
  } else {
    a.take("diaginertia", diagonal);
    b.mass.inertia = turn * diagonal.asDiagonal() * turn.transpose();
  }
  b.hasInertial = true;
  a.finish();
}

void Reader::joint(const Element& e, const Scope& scope) {
  Body& b = model_.bodies[static_cast<std::size_t>(scope.body)];
  if (scope.body == 0) throw e.error("the world has no joints");
  Joint j;
  j.from = e;
  if (e.tag() == "freejoint") {
    // Has no defaults.
    Attributes a(e, leftOver_);
    j.name = a.text("name");
    j.kind = JointKind::free;
    a.ignore({"group", "align"});
    a.finish();
    b.joints.push_back(j);
    return;
  }
  Attributes a = attributes(e, scope.childClass);
  j.name = a.text("name");
  const std::string kind = a.word("type", {"free", "ball", "slide", "hinge"}, "hinge");
  j.kind = kind == "free"    ? JointKind::free
           : kind == "ball"  ? JointKind::ball
           : kind == "slide" ? JointKind::slide
                             : JointKind::hinge;
  const bool angular = j.kind == JointKind::hinge || j.kind == JointKind::ball;
  const auto inUnits = [&](double v) { return angular ? angle(v) : v; };
  a.take("pos", j.position);
  a.take("axis", j.axis);
  j.position = scope.frame.position + scope.frame.rotation * j.position;
  if (!(j.axis.norm() > 1e-10)) throw e.error("expected an axis that is not 0");
  j.axis = scope.frame.rotation * j.axis.normalized();
  const auto range = a.numbers("range", 2, 2);
  if (j.kind == JointKind::ball || j.kind == JointKind::free) {
    for (const char* name : {"range", "armature", "damping", "frictionloss", "stiffness"})
      if (a.has(name)) leftOver_.add(e, fmt::format("the attribute '{}' of a {} joint is left out", name, kind));
  } else {
    j.limited = limited(a, "limited", "range", range);
    if (range) j.range = {inUnits((*range)[0]), inUnits((*range)[1])};
  }
  j.armature = a.number("armature", 0);
  j.damping = a.number("damping", 0);
  j.dryFriction = a.number("frictionloss", 0);
  j.stiffness = a.number("stiffness", 0);
  j.springAngle = inUnits(a.number("springref", 0));
  if (a.number("ref", 0) != 0)
    leftOver_.add(e, "the attribute 'ref' of <joint> is left out: angles count from the initial pose");
  const auto force = a.numbers("actuatorfrcrange", 2, 2);
  if (limited(a, "actuatorfrclimited", "actuatorfrcrange", force))
    j.maxForce = std::max(std::abs((*force)[0]), std::abs((*force)[1]));
  engine::MujocoAxis& n = j.numbers;
  n.stopSolref = n.frictionSolref = {0.02, 1};
  n.stopSolimp = n.frictionSolimp = {0.9, 0.95, 0.001, 0.5, 2};
  a.fill("solreflimit", n.stopSolref);
  a.fill("solimplimit", n.stopSolimp);
  a.fill("solreffriction", n.frictionSolref);
  a.fill("solimpfriction", n.frictionSolimp);
  n.stopMargin = a.number("margin", 0);  // radians in any case
  a.ignore({"group", "user", "limited"});
  a.finish();
  b.joints.push_back(j);
}

// ---- geoms ----

ShapeDescription Reader::meshShape(Attributes& a) {
  const std::string name = a.text("mesh");
  const auto found = meshes_.find(name);
  if (found == meshes_.end()) throw a.element().error(fmt::format("there is no <mesh> '{}'", name));
  MeshAsset& m = found->second;
  const auto counted = [&] {
    meshNumbers_ += m.loaded->vertices.size() + m.loaded->triangles.size();
    if (meshNumbers_ > kMaxMeshNumbers)
      throw a.element().error(fmt::format("the meshes of all geoms have more than {} numbers", kMaxMeshNumbers));
    return *m.loaded;
  };
  if (m.loaded) return counted();
  if (m.file.empty()) throw m.from.error("expected an attribute 'file'");
  try {
    const std::filesystem::path path(document_.folder() + compiler_.meshFolder + m.file);
    m.loaded = readMesh_(path.lexically_normal().string());
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot read the mesh '{}'", m.from.where(), m.file), e);
  }
  for (std::size_t i = 0; i < m.loaded->vertices.size(); ++i) m.loaded->vertices[i] *= m.scale[static_cast<int>(i % 3)];
  return counted();
}

ShapeDescription Reader::shape(Attributes& a, const Scope& scope, Pose& at) {
  ShapeDescription s;
  const std::string kind = a.text("type", a.has("mesh") ? "mesh" : "sphere");
  Vec3 size = Vec3::Zero();
  a.fill("size", size);
  double length = 0;
  const bool ends = fromTo(a, scope, at, length);
  if (!ends) at = pose(a, scope);
  const bool thick = kind == "box" || kind == "ellipsoid";
  if (ends && thick) size = {size[0], size[0], length / 2};
  if (ends && !thick) size[1] = length / 2;
  // Each kind needs so many of its lengths.
  const int needed = kind == "sphere" ? 1 : kind == "capsule" || kind == "cylinder" ? 2 : thick ? 3 : 0;
  if (!(size.head(needed).array() > 0).all())
    throw a.element().error(fmt::format("the 'size' of a {} needs {} above 0", kind,
                                        needed == 1 ? "a length" : fmt::format("{} lengths", needed)));
  if (thick) {
    s.shape = Shape::box;
    s.lengths = 2 * size;
  } else if (kind == "sphere") {
    s.shape = Shape::sphere;
    s.radius = size[0];
  } else if (kind == "capsule" || kind == "cylinder") {
    s.shape = kind == "capsule" ? Shape::capsule : Shape::cylinder;
    s.radius = size[0];
    s.length = 2 * size[1];
  } else if (kind == "plane") {
    s.shape = Shape::plane;
  } else {
    s = meshShape(a);
    s.shape = Shape::mesh;
  }
  return s;
}

void Reader::geom(const Element& e, const Scope& scope) {
  Attributes a = attributes(e, scope.childClass);
  Body& b = model_.bodies[static_cast<std::size_t>(scope.body)];
  Geom g;
  g.from = e;
  g.name = a.text("name");
  g.contactTypes = a.integer("contype", 1);
  g.contactAffinities = a.integer("conaffinity", 1);
  g.group = a.integer("group", 0);
  engine::Geom::Mujoco& m = g.contact;
  a.fill("friction", m.friction);
  m.condim = a.integer("condim", 3);
  if (m.condim != 1 && m.condim != 3 && m.condim != 4 && m.condim != 6)
    throw e.error(fmt::format("expected 1, 3, 4 or 6 for 'condim', found {}", m.condim));
  m.priority = a.integer("priority", 0);
  a.fill("solref", m.solref);
  a.fill("solimp", m.solimp);
  m.margin = a.number("margin", 0);
  m.gap = a.number("gap", 0);
  const std::string type =
      a.word("type", {"plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"},
             a.has("mesh") ? "mesh" : "sphere");
  const bool counts = !b.hasInertial || compiler_.inertiaFromGeom == "true";
  const double density = a.number("density", 1000);
  a.ignore({"material", "rgba", "user", "hfield", "fitscale", "mass"});
  if (type == "hfield" || type == "sdf") return leftOver_.add(e, fmt::format("a <geom> of type {} is left out", type));
  if (type != "mesh" && a.has("mesh")) return leftOver_.add(e, "a <geom> that is fitted to a mesh is left out");
  // What is only seen, with a mesh that nobody needs to read.
  const bool weightless = !counts || (a.has("mass") ? a.number("mass", 0) == 0 : density == 0);
  if (type == "mesh" && !g.collides() && (weightless || scope.body == 0)) {
    a.ignore({"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "size", "fromto"});
    return a.finish();
  }
  g.shape = shape(a, scope, g.pose);
  if (type == "ellipsoid") {
    // Its mass counts.
    leftOver_.add(e, "the shape of an ellipsoid is left out");
    g.contactTypes = g.contactAffinities = 0;
    g.group = 5;
    massOf(a, g, Vec3(g.shape.lengths / 2));
  } else {
    massOf(a, g, std::nullopt);
  }
  a.finish();
  b.geoms.push_back(std::move(g));
}

void Reader::massOf(Attributes& a, Geom& g, const std::optional<Vec3>& ellipsoid) {
  if (g.shape.shape == Shape::plane || g.group < compiler_.inertiaGroups[0] || g.group > compiler_.inertiaGroups[1])
    return;
  const double density = a.number("density", 1000);
  const std::optional<double> given = a.has("mass") ? std::optional(a.number("mass", 0)) : std::nullopt;
  const ShapeDescription& s = g.shape;
  const auto weighed = [&](double volume) { return given ? *given : density * volume; };
  engine::Mass m;
  if (ellipsoid) {
    const Vec3 squares = ellipsoid->cwiseProduct(*ellipsoid);
    const double mass = weighed(4.0 / 3.0 * kPi * ellipsoid->prod());
    const Vec3 moments = mass / 5 * (Vec3::Constant(squares.sum()) - squares);
    g.mass = moved({mass, Vec3::Zero(), Mat3(moments.asDiagonal())}, g.pose);
    return;
  }
  switch (s.shape) {
    case Shape::box:
      m = physics::boxMass(weighed(physics::boxVolume(s.lengths)), s.lengths);
      break;
    case Shape::sphere:
      m = physics::sphereMass(weighed(physics::sphereVolume(s.radius)), s.radius);
      break;
    case Shape::capsule:
      m = physics::capsuleMass(weighed(physics::capsuleVolume(s.radius, s.length)), s.radius, s.length);
      break;
    case Shape::cylinder:
      m = physics::cylinderMass(weighed(physics::cylinderVolume(s.radius, s.length)), s.radius, s.length);
      break;
    default: {
      m = meshMass(s);
      if (!(m.mass > 0)) throw a.element().error("the mesh has no volume");
      const double factor = weighed(m.mass) / m.mass;
      m.mass *= factor;
      m.inertia *= factor;
      break;
    }
  }
  if (m.mass > 0) g.mass = moved(m, g.pose);
}

/// The masses of bodies whose files give none are those of their geoms.
void Reader::finishMasses() {
  for (Body& b : model_.bodies) {
    if (b.from.tag() != "body") continue;
    const bool fromGeoms =
        compiler_.inertiaFromGeom == "true" || (compiler_.inertiaFromGeom == "auto" && !b.hasInertial);
    if (fromGeoms) {
      engine::Mass sum{0, Vec3::Zero(), Mat3::Zero()};
      for (const Geom& g : b.geoms)
        if (g.mass) sum = physics::together(sum, *g.mass);
      b.mass = sum;
    }
    if (b.mass.mass <= 0 && compiler_.boundMass <= 0) continue;
    b.mass.mass = std::max(b.mass.mass, compiler_.boundMass);
    if (compiler_.boundInertia > 0) {
      const Eigen::SelfAdjointEigenSolver<Mat3> axes(b.mass.inertia);
      const Vec3 moments = axes.eigenvalues().cwiseMax(compiler_.boundInertia);
      b.mass.inertia = axes.eigenvectors() * moments.asDiagonal() * axes.eigenvectors().transpose();
    }
  }
}

void Reader::site(const Element& e, const Scope& scope) {
  Attributes a = attributes(e, scope.childClass);
  Site s;
  s.from = e;
  s.name = a.text("name");
  double length = 0;
  if (!fromTo(a, scope, s.pose, length)) s.pose = pose(a, scope);
  a.ignore({"type", "size", "group", "material", "rgba", "user"});
  a.finish();
  model_.bodies[static_cast<std::size_t>(scope.body)].sites.push_back(s);
}

// ---- contact, actuators, sensors ----

void Reader::contact(const Element& e) {
  for (const Element& child : document_.children(e)) {
    if (child.tag() != "exclude" && child.tag() != "pair") {
      leftOver_.element(child);
      continue;
    }
    Attributes a = attributes(child);
    if (child.tag() == "exclude")
      model_.exclusions.push_back({child, a.text("body1"), a.text("body2")});
    else
      model_.pairs.push_back({child, a.text("geom1"), a.text("geom2")});
    a.ignore({"name"});
    a.finish();
  }
}

namespace {
constexpr std::string_view kActuators[] = {"general", "motor",    "position", "velocity", "intvelocity",
                                           "damper",  "cylinder", "muscle",   "adhesion"};
}  // namespace

/// Applies what one element says to an actuator. All tags have one default in MuJoCo, whatever the tag. `meaning`: why
/// it cannot be taken, "" if it can.
void Reader::apply(const Element& e, Actuator& x, std::string& meaning) {
  Attributes a(e, leftOver_);
  const std::string_view tag = e.tag();
  std::array<double, 6> gear{x.gear, 0, 0, 0, 0, 0};
  a.fill("gear", gear);
  x.gear = gear[0];
  if (tag == "motor") {
    x.gain = 1, x.bias = {0, 0, 0}, meaning.clear();
  } else if (tag == "position") {
    x.gain = a.number("kp", x.gain);
    x.bias = {0, -x.gain, -a.number("kv", 0)}, meaning.clear();
  } else if (tag == "velocity") {
    x.gain = a.number("kv", x.gain);
    x.bias = {0, 0, -x.gain}, meaning.clear();
  } else if (tag == "general") {
    std::array<double, 10> gain{x.gain}, bias{x.bias[0], x.bias[1], x.bias[2]};
    a.fill("gainprm", gain);
    a.fill("biasprm", bias);
    x.gain = gain[0];
    const bool affine = x.bias != std::array<double, 3>{};
    const std::string kind = a.word("biastype", {"none", "affine", "muscle", "user"}, affine ? "affine" : "none");
    x.bias = kind == "affine" ? std::array<double, 3>{bias[0], bias[1], bias[2]} : std::array<double, 3>{};
    if (a.word("gaintype", {"fixed", "affine", "muscle", "user"}, "fixed") != "fixed" ||
        a.text("dyntype", "none") != "none" || kind == "muscle" || kind == "user")
      meaning = "a <general> whose gain is not fixed, or that has dynamics, is left out";
    a.ignore({"dynprm"});
  } else {
    meaning = fmt::format("the element <{}> is left out", tag);
  }
  const auto control = a.numbers("ctrlrange", 2, 2), force = a.numbers("forcerange", 2, 2);
  if (limited(a, "ctrllimited", "ctrlrange", control)) x.controlRange = {(*control)[0], (*control)[1]};
  if (limited(a, "forcelimited", "forcerange", force)) {
    x.forceRange = std::max(std::abs((*force)[0]), std::abs((*force)[1]));
    if ((*force)[0] != -(*force)[1]) leftOver_.add(e, "a force range that is not symmetric is taken as symmetric");
  }
  a.ignore({"name", "class", "joint", "group", "user", "tendon", "site", "body", "jointinparent", "cranksite",
            "slidersite"});
  if (meaning.empty()) a.finish();
}

void Reader::actuator(const Element& e) {
  Actuator x;
  x.from = e;
  x.name = e.node.attribute("name").value();
  x.joint = e.node.attribute("joint").value();
  if (++elements_ > kMaxElements) throw e.error(fmt::format("expected at most {} elements", kMaxElements));
  std::vector<Element> chain{e};
  defaults_.forEach(e, kActuators, e.node.attribute("class").value(), [&](const Element& d) { chain.push_back(d); });
  std::string meaning;
  for (std::size_t i = chain.size(); i-- > 0;) apply(chain[i], x, meaning);
  if (!meaning.empty()) return leftOver_.add(e, meaning);
  if (x.joint.empty()) return leftOver_.add(e, fmt::format("a <{}> that acts on no joint is left out", e.tag()));
  x.maxForce = x.gear == 0 ? 0 : std::abs(x.gear) * x.forceRange;
  model_.actuators.push_back(x);
}

void Reader::sensor(const Element& e) {
  Attributes a = attributes(e);
  Sensor s;
  s.from = e;
  s.kind = e.tag();
  s.name = a.text("name");
  for (const char* object : {"joint", "site", "objname"})
    if (s.object.empty()) s.object = a.text(object);
  s.objectType = a.text("objtype");
  a.ignore({"noise", "user"});
  a.finish();
  model_.sensors.push_back(s);
}

}  // namespace spark::mjcf
