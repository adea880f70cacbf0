#include "reader.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "api/mass.h"
#include "option_reader.h"
#include "robot/mended_mass.h"
#include "robot/mended_numbers.h"
#include "spring_damper.h"
#include "vocabulary.h"

namespace spark::mjcf {

namespace {

/// The sections that are read, in this order.
constexpr std::string_view kSections[] = {"compiler", "default",  "option", "asset",    "worldbody",
                                          "contact",  "equality", "tendon", "actuator", "sensor"};
/// Elements that say how MuJoCo's own programs show a model, or hold what is no part of it.
const std::set<std::string_view> kNotSimulated{"visual", "statistic", "custom", "size", "keyframe", "camera", "light"};

/// How firm a joint's stop and its friction are.
Firmness firmness(Attributes& a) {
  Firmness n;
  a.fill("solreflimit", n.stopSolref);
  a.fill("solimplimit", n.stopSolimp);
  a.fill("solreffriction", n.frictionSolref);
  a.fill("solimpfriction", n.frictionSolimp);
  n.stopMargin = a.number("margin", 0);  // radians in any case
  return n;
}

}  // namespace

Model readModel(Document& document, const ReadMesh& readMesh, Unsupported& unsupported,
                const ReadHeights& readHeights) {
  return Reader(document, readMesh, readHeights, unsupported).read();
}

Model Reader::read() {
  const Element root = document_.root();
  model_.name = root.node.attribute("model").as_string("model");
  model_.meshesAreHulls = true;
  model_.bodies.emplace_back();
  model_.bodies.front().from = root;
  globalPoses_.emplace_back();
  const std::vector<Element> sections = document_.children(root);
  for (const Element& e : sections)
    if (e.tag() == "contact") notePairs(e);
  for (const std::string_view tag : kSections) {
    for (const Element& e : sections)
      if (e.tag() == tag) section(e);
    if (tag == "worldbody") finishMasses();
  }
  for (const Element& e : sections)
    if (std::find(std::begin(kSections), std::end(kSections), e.tag()) == std::end(kSections) &&
        !kNotSimulated.contains(e.tag()))
      unsupported_.element(e);
  model_.surfaces = meshes_.surfaces();
  chooseCollisions();
  mendNumbers(model_, unsupported_);
  nameUnknown(document_, unsupported_);
  return std::move(model_);
}

void Reader::chooseCollisions() {
  if (model_.collision == "dynamic") model_.pairs.clear();
  if (model_.collision != "predefined") return;
  for (Body& b : model_.bodies)
    for (Geom& g : b.geoms) g.contactTypes = g.contactAffinities = 0;
}

void Reader::section(const Element& e) {
  const std::string_view tag = e.tag();
  if (tag == "compiler") {
    Attributes a = attributes(e);
    compiler_.read(a);
  } else if (tag == "default") {
    defaults_.add(document_, e);
  } else if (tag == "option") {
    option(e);
  } else if (tag == "worldbody") {
    content(e, {});
  } else {
    for (const Element& child : document_.children(e))
      if (tag == "asset")
        asset(child);
      else if (tag == "contact")
        unsupported_.attempt(child, [&] { contact(child); });
      else if (tag == "equality" || tag == "tendon")
        constraint(child, tag == "tendon");
      else if (tag == "actuator")
        unsupported_.attempt(child, [&] { actuator(child); });
      else
        unsupported_.attempt(child, [&] { sensor(child); });
  }
}

void Reader::count(const Element& e) {
  if (++elements_ > kMaxElements)
    throw LimitError(fmt::format("{}: expected at most {} elements", e.where(), kMaxElements));
}

Attributes Reader::attributes(const Element& e, const std::string& childClass) {
  count(e);
  const char* const own = e.node.attribute("class").value();
  return Attributes(e, defaults_, *own ? own : childClass, unsupported_);
}

// ---- options and assets ----

void Reader::option(const Element& e) {
  Attributes a = attributes(e);
  a.forgive();
  readOption(a, model_, unsupported_);
  for (const Element& child : document_.children(e)) {
    if (child.tag() != "flag") {
      unsupported_.element(child);
      continue;
    }
    Attributes flags = attributes(child);
    readFlags(flags, model_, unsupported_);
  }
}

void Reader::asset(const Element& e) {
  if (e.tag() == "mesh" || e.tag() == "hfield") {
    unsupported_.attempt(e, [&] {
      Attributes a = attributes(e);
      const std::string folder = document_.folder() + compiler_.meshFolder();
      if (e.tag() == "mesh")
        meshes_.add(a, folder, compiler_);
      else
        heightFields_.add(a, folder, compiler_);
    });
  } else if (e.tag() != "material" && e.tag() != "texture") {
    unsupported_.element(e);
  }
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
      unsupported_.attempt(e, [&] { site(e, scope); });
    else if (tag == "inertial")
      unsupported_.attempt(e, [&] { inertial(e, scope); });
    else if (!kNotSimulated.contains(tag))
      unsupported_.element(e);
  }
}

void Reader::body(const Element& e, const Scope& scope) {
  if (model_.bodies.size() > kMaxBodies) throw e.error(fmt::format("expected at most {} bodies", kMaxBodies));
  Attributes a = attributes(e, scope.childClass);
  a.forgive();
  Body b;
  b.from = e;
  b.name = a.text("name");
  b.parent = scope.body;
  Scope inner{static_cast<int>(model_.bodies.size()), "", {}, scope.depth + 1};
  if (compiler_.global()) {
    // Everything inside is in the world frame too. A body without a position has its frame at its centre of mass.
    b.isFrameOpen = !a.has("pos");
    const Pose given = compiler_.pose(a, {}), own = b.isFrameOpen ? Pose{} : given;
    b.pose = compose(inverse(globalPoses_[static_cast<std::size_t>(scope.body)]), own);
    globalPoses_.push_back(own);
    inner.frame = inverse(own);
  } else {
    b.pose = compiler_.pose(a, scope.frame);
  }
  b.gravityCompensation = a.number("gravcomp", 0);
  if (a.has("mocap") && a.flag("mocap", false))
    unsupported_.add(e, "a body that a program moves (mocap) is not supported: it stays at its place");
  inner.childClass = a.text("childclass", scope.childClass.c_str());
  a.ignore({"user"});
  a.finish();
  model_.bodies.push_back(std::move(b));
  content(e, inner);
}

void Reader::frame(const Element& e, Scope scope) {
  Attributes a = attributes(e, scope.childClass);
  a.forgive();
  scope.frame = compiler_.pose(a, scope.frame);
  scope.childClass = a.text("childclass", scope.childClass.c_str());
  ++scope.depth;
  a.ignore({"name"});
  a.finish();
  content(e, scope);
}

void Reader::inertial(const Element& e, const Scope& scope) {
  Body& b = model_.bodies[static_cast<std::size_t>(scope.body)];
  Attributes a = attributes(e);
  if (!a.has("mass")) throw e.error("expected an attribute 'mass'");
  engine::Mass m{a.number("mass", 0), Vec3::Zero(), Mat3::Zero()};
  Mat3 turn = Mat3::Identity();
  a.take("pos", m.center);
  if (const auto r = compiler_.orientation(a)) turn = *r;
  Vec3 diagonal = Vec3::Zero();
  std::array<double, 6> full{};
  if (a.take("fullinertia", full)) {
    m.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
  } else {
    a.take("diaginertia", diagonal);
    m.inertia = turn * diagonal.asDiagonal() * turn.transpose();
  }
  m.center = scope.frame.position + scope.frame.rotation * m.center;
  m.inertia = scope.frame.rotation * m.inertia * scope.frame.rotation.transpose();
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(m.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (m.mass < 0 || moments[0] < -1e-9 * moments[2])
    throw e.error(fmt::format("expected a mass and moments of inertia of 0 or more, found {:g} and {:g}, {:g}, {:g}",
                              m.mass, moments[0], moments[1], moments[2]));
  b.mass = m;
  b.inertiaAxes = scope.frame.rotation * turn;
  b.hasInertial = true;
  a.finish();
}

void Reader::joint(const Element& e, const Scope& scope) {
  Body& b = model_.bodies[static_cast<std::size_t>(scope.body)];
  if (scope.body == 0) throw e.error("the world has no joints");
  b.joints.push_back(e.tag() == "freejoint" ? freeJoint(e) : typedJoint(e, scope));
}

/// It has no defaults.
Joint Reader::freeJoint(const Element& e) {
  Joint j;
  j.from = e;
  j.kind = JointKind::free;
  count(e);
  Attributes a(e, unsupported_);
  j.name = a.text("name");
  a.ignore({"group", "align"});
  a.finish();
  return j;
}

Joint Reader::typedJoint(const Element& e, const Scope& scope) {
  Joint j;
  j.from = e;
  Attributes a = attributes(e, scope.childClass);
  a.forgive();
  j.name = a.text("name");
  const std::string kind = a.word("type", {"free", "ball", "slide", "hinge"}, "hinge");
  j.kind = kind == "free"    ? JointKind::free
           : kind == "ball"  ? JointKind::ball
           : kind == "slide" ? JointKind::slide
                             : JointKind::hinge;
  const bool angular = j.kind == JointKind::hinge || j.kind == JointKind::ball;
  const auto inUnits = [&](double v) { return angular ? compiler_.angle(v) : v; };
  a.take("pos", j.position);
  a.take("axis", j.axis);
  j.position = scope.frame.position + scope.frame.rotation * j.position;
  if (!(j.axis.stableNorm() > 1e-10)) {
    a.note("an 'axis' of 0 in <joint> is taken as '0 0 1'");
    j.axis = Vec3::UnitZ();
  }
  // Of a length whose square is no number, too.
  const double length = j.axis.norm();
  j.axis = scope.frame.rotation * (std::isfinite(length) ? j.axis.normalized() : j.axis.stableNormalized());
  j.reference = inUnits(a.number("ref", 0));
  Limit limit, force;
  limit.read(a, "limited", "range");
  force.read(a, "actuatorfrclimited", "actuatorfrcrange");
  // One that cannot be read is none.
  if (!limit.range && a.has("range")) limit.word = "false";
  if (!force.range && a.has("actuatorfrcrange")) force.word = "false";
  const bool ball = j.kind == JointKind::ball;
  if (j.kind == JointKind::free) {
    a.ignore({"pos", "axis", "range", "limited", "ref", "springref"});
    j.reference = 0;
  } else if (ball && limit.range && limit.word != "false" && (*limit.range)[1] > 0) {
    // Only its largest rotation counts.
    j.limited = true;
    j.range = {0, inUnits((*limit.range)[1])};
  } else if (ball) {
    j.limited = false;
    if (limit.word == "true") a.note("a ball <joint> that is limited to 0 has no limit");
  } else if (const auto range = compiler_.limit(a, "range", limit)) {
    j.limited = true;
    j.range = {inUnits((*range)[0]) - j.reference, inUnits((*range)[1]) - j.reference};
  }
  j.armature = a.within("armature", 0, 0);
  j.damping = a.within("damping", 0, 0);
  j.dryFriction = a.within("frictionloss", 0, 0);
  j.stiffness = a.within("stiffness", 0, 0);
  j.springPosition = inUnits(a.number("springref", 0)) - j.reference;
  if (j.kind == JointKind::hinge || j.kind == JointKind::slide) readSpringDamper(a, j);
  if (const auto range = compiler_.limit(a, "actuatorfrcrange", force)) {
    j.maxForce = std::max(std::abs((*range)[0]), std::abs((*range)[1]));
    if ((*range)[0] != -(*range)[1])
      unsupported_.add(e, "an actuatorfrcrange that is not symmetric is taken as symmetric");
  }
  j.firmness = firmness(a);
  a.ignore({"group", "user"});
  a.finish();
  return j;
}

void Reader::readSpringDamper(Attributes& a, Joint& j) {
  std::array<double, 2> both{};
  a.fill("springdamper", both);
  if (both[0] == 0 && both[1] == 0) return;
  if (!(both[0] > 0 && both[1] > 0))
    return a.note(fmt::format("'springdamper' of <joint> is ignored: expected two numbers above 0, found {:g} {:g}",
                              both[0], both[1]));
  j.springDamper = both;
}

void Reader::geom(const Element& e, const Scope& scope) {
  Body& b = model_.bodies[static_cast<std::size_t>(scope.body)];
  std::optional<Geom> g;
  unsupported_.attempt(e, [&] {
    Attributes a = attributes(e, scope.childClass);
    g = geoms_.read(a, b, scope.frame);
  });
  if (!g || !g->isShape) model_.unsupportedGeoms.insert(e.node.attribute("name").value());
  if (g) mendMass(*g, unsupported_);
  if (g) b.geoms.push_back(std::move(*g));
}

void Reader::site(const Element& e, const Scope& scope) {
  Attributes a = attributes(e, scope.childClass);
  Site s;
  s.name = a.text("name");
  const auto span = compiler_.fromTo(a, scope.frame);
  s.pose = span ? span->pose : compiler_.pose(a, scope.frame);
  a.ignore({"type", "size", "group", "material", "rgba", "user"});
  a.finish();
  model_.bodies[static_cast<std::size_t>(scope.body)].sites.push_back(s);
}

/// The masses of bodies whose files give none are those of their geoms.
void Reader::finishMasses() {
  for (Body& b : model_.bodies) {
    if (b.parent < 0) continue;
    const std::string& fromGeoms = compiler_.inertiaFromGeom();
    if (fromGeoms == "true" || (fromGeoms == "auto" && !b.hasInertial)) {
      b.mass = {0, Vec3::Zero(), Mat3::Zero()};
      b.inertiaAxes.setIdentity();
      // Where MuJoCo 2.2.2 has the centre of a body that weighs nothing.
      if (!b.isWeighed && !compiler_.global()) b.mass.center = b.pose.position;
      for (const Geom& g : b.geoms) {
        // One without mass says where the centre of nothing is, which MuJoCo's equalities depend on.
        if (b.mass.mass == 0 && compiler_.weighs(g.group)) b.mass.center = g.pose.position;
        if (!g.mass || g.mass->mass <= 0) continue;
        if (b.mass.mass == 0)
          b.inertiaAxes = g.pose.rotation;
        else
          b.inertiaAxes.setIdentity();
        b.mass = physics::together(b.mass, *g.mass);
      }
    }
    compiler_.adjust(b.mass);
    if (b.hasInertial && fromGeoms != "true")
      balanceInertia(b.mass, b.from, "the <inertial> of a <body>", unsupported_);
  }
  weighLightBodies(model_, "a <body>", 0, unsupported_);
  scaleMasses();
  placeOpenFrames();
  setSpringDampers(model_, unsupported_);
}

/// Moves frames that the file does not give to centres of mass.
void Reader::placeOpenFrames() {
  std::vector<Vec3> shifts(model_.bodies.size(), Vec3::Zero());
  for (std::size_t i = 1; i < model_.bodies.size(); ++i) {
    Body& b = model_.bodies[i];
    b.pose.position -= shifts[static_cast<std::size_t>(b.parent)];
    if (!b.isFrameOpen) continue;
    const Vec3 shift = shifts[i] = b.mass.center;
    b.pose.position += b.pose.rotation * shift;
    b.mass.center.setZero();
    for (Joint& j : b.joints) j.position -= shift;
    for (Geom& g : b.geoms) g.pose.position -= shift;
    for (Site& site : b.sites) site.pose.position -= shift;
  }
}

void Reader::scaleMasses() {
  double total = 0;
  for (const Body& b : model_.bodies) total += b.mass.mass;
  if (!(compiler_.totalMass() > 0) || !(total > 0)) return;
  for (Body& b : model_.bodies) {
    b.mass.mass *= compiler_.totalMass() / total;
    b.mass.inertia *= compiler_.totalMass() / total;
  }
}

// ---- contact, actuators, sensors ----

void Reader::notePairs(const Element& e) {
  for (const Element& child : document_.children(e))
    if (child.tag() == "pair")
      for (const char* const name : {"geom1", "geom2"}) geoms_.addToPairs(child.node.attribute(name).value());
}

void Reader::contact(const Element& e) {
  if (e.tag() != "exclude" && e.tag() != "pair") return unsupported_.element(e);
  Attributes a = attributes(e);
  if (e.tag() == "exclude") {
    model_.exclusions.push_back({e, a.text("body1"), a.text("body2")});
  } else {
    Pair p{e, a.text("geom1"), a.text("geom2")};
    if (a.has("condim")) p.condim = dimensionsOf(a);
    const auto fill = [&](const char* name, auto& numbers, auto usual) {
      if (a.has(name)) a.fill(name, numbers.emplace(usual));
    };
    fill("friction", p.friction, std::array{1.0, 1.0, 0.005, 0.0001, 0.0001});
    fill("solref", p.solref, std::array{0.02, 1.0});
    fill("solimp", p.solimp, std::array{0.9, 0.95, 0.001, 0.5, 2.0});
    if (a.has("margin")) p.margin = a.number("margin", 0);
    if (a.has("gap")) p.gap = a.number("gap", 0);
    model_.pairs.push_back(std::move(p));
  }
  a.ignore({"name"});
  a.finish();
}

void Reader::constraint(const Element& e, bool tendon) {
  count(e);
  if (!tendon) {
    unsupported_.attempt(e, [&] { constraints_.equality(e, model_); });
    return;
  }
  const std::vector<Element> parts = document_.children(e);
  for (const Element& part : parts) count(part);
  if (!unsupported_.attempt(e, [&] { constraints_.tendon(e, parts, model_); }))
    model_.skippedTendons.insert(e.node.attribute("name").value());
}

void Reader::actuator(const Element& e) {
  count(e);
  if (const auto x = actuators_.read(e)) model_.actuators.push_back(*x);
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
  s.reference = a.text("refname");
  s.noise = a.number("noise", 0);
  s.cutoff = a.number("cutoff", 0);
  a.ignore({"user", "reftype", "body", "actuator", "tendon", "dim", "datatype", "needstage"});
  a.finish();
  model_.sensors.push_back(s);
}

}  // namespace spark::mjcf
