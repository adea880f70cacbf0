#include "urdf_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "agent_parts.h"
#include "geometry_reader.h"
#include "robot/mended_mass.h"

namespace spark::urdf {

namespace {

/// One run over a file.
class Reader {
 public:
  Reader(const Element& root, Base base, const ReadMesh& readMesh, Unsupported& unsupported)
      : root_(root), base_(base), unsupported_(unsupported), geometry_(root, readMesh, unsupported) {}
  mjcf::Model read();

 private:
  struct Link {
    Element from;
    std::string name;
    std::vector<int> joints{};  ///< of which it is the parent
    int above = -1;             ///< the joint of which it is the child
    int body = -1;
  };
  struct JointElement {
    Element from;
    std::string name, type;
    int parent = -1, child = -1;
  };

  void readLinks();
  void readJoints();
  int linkOf(const Element& joint, const char* tag) const;
  int rootLink() const;
  void place(int link, int parentBody);
  void placeAll(int link);
  void inertial(const Element& link, mjcf::Body& body);
  void joints(const JointElement& j, mjcf::Body& body);
  mjcf::Joint axisOf(const JointElement& j, mjcf::JointKind kind, const Vec3& axis);
  void limits(const Element& e, mjcf::Joint& joint);
  void mimic(const Element& e, const std::string& joint);

  const Element root_;
  const Base base_;
  Unsupported& unsupported_;
  GeometryReader geometry_;
  mjcf::Model model_;
  std::vector<Link> links_;
  std::vector<JointElement> joints_;
  std::map<std::string, int, std::less<>> linkByName_, jointByName_;
};

mjcf::Model Reader::read() {
  model_.name = root_.node.attribute("name").value();
  model_.selfCollides = false;
  model_.bodies.emplace_back().from = root_;
  readLinks();
  readJoints();
  for (const Element& e : childrenOf(root_)) {
    static constexpr std::string_view kKnown[] = {"link", "joint", "material", "transmission", "gazebo"};
    if (std::find(std::begin(kKnown), std::end(kKnown), e.tag()) == std::end(kKnown)) unsupported_.element(e);
  }
  placeAll(rootLink());
  mjcf::weighLightBodies(model_, "a <link>", unsupported_);  // links that only connect joints often have none
  AgentParts(root_, model_, unsupported_).add();
  return std::move(model_);
}

void Reader::readLinks() {
  for (const Element& e : childrenOf(root_)) {
    if (e.tag() != "link") continue;
    const std::string name = nameOf(e);
    if (!linkByName_.emplace(name, static_cast<int>(links_.size())).second)
      throw e.error(fmt::format("there are two links '{}'", name));
    links_.push_back({e, name});
    if (links_.size() > mjcf::kMaxBodies) throw e.error(fmt::format("expected at most {} links", mjcf::kMaxBodies));
  }
  if (links_.empty()) throw root_.error("expected a <link>, found none");
}

int Reader::linkOf(const Element& joint, const char* tag) const {
  const auto e = childOf(joint, tag);
  if (!e) throw joint.error(fmt::format("expected an element <{}> in {}", tag, joint.named()));
  const std::string name = e->node.attribute("link").value();
  const auto found = linkByName_.find(name);
  if (found == linkByName_.end()) throw e->error(fmt::format("there is no link '{}'", name));
  return found->second;
}

void Reader::readJoints() {
  for (const Element& e : childrenOf(root_)) {
    if (e.tag() != "joint") continue;
    JointElement j{e, nameOf(e), e.node.attribute("type").value()};
    static constexpr std::string_view kTypes[] = {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};
    if (std::find(std::begin(kTypes), std::end(kTypes), j.type) == std::end(kTypes))
      throw e.error(fmt::format(
          "expected revolute, continuous, prismatic, fixed, floating or planar for 'type', found '{}'", j.type));
    j.parent = linkOf(e, "parent");
    j.child = linkOf(e, "child");
    const int number = static_cast<int>(joints_.size());
    if (!jointByName_.emplace(j.name, number).second) throw e.error(fmt::format("there are two joints '{}'", j.name));
    Link& child = links_[static_cast<std::size_t>(j.child)];
    if (child.above >= 0)
      throw e.error(fmt::format("the link '{}' is the child of two joints, '{}' and '{}'; expected a tree", child.name,
                                joints_[static_cast<std::size_t>(child.above)].name, j.name));
    child.above = number;
    links_[static_cast<std::size_t>(j.parent)].joints.push_back(number);
    joints_.push_back(std::move(j));
  }
}

int Reader::rootLink() const {
  int found = -1;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].above >= 0) continue;
    if (found >= 0)
      throw links_[i].from.error(fmt::format("expected one link that is no child of a joint, found two, '{}' and '{}'",
                                             links_[static_cast<std::size_t>(found)].name, links_[i].name));
    found = static_cast<int>(i);
  }
  if (found < 0) throw root_.error("each link is the child of a joint: the joints go round in a circle");
  return found;
}

/// All links, parents before their children.
void Reader::placeAll(int root) {
  place(root, 0);
  std::vector<int> open{root};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Link& link = links_[static_cast<std::size_t>(open[i])];
    for (const int j : link.joints) {
      const int child = joints_[static_cast<std::size_t>(j)].child;
      place(child, link.body);
      open.push_back(child);
    }
  }
  for (const Link& link : links_)
    if (link.body < 0) throw link.from.error(fmt::format("the link '{}' does not hang on the root link", link.name));
  // The base is free if it can fall.
  std::size_t base = 1;
  double mass = 0;
  std::vector<bool> isFixed(model_.bodies.size());
  for (std::size_t i = base; i < model_.bodies.size(); ++i) {
    const mjcf::Body& b = model_.bodies[i];
    isFixed[i] = i == base || (b.joints.empty() && isFixed[static_cast<std::size_t>(b.parent)]);
    if (isFixed[i]) mass += b.mass.mass;
  }
  mjcf::Body& b = model_.bodies[base];
  const bool free = base_ == Base::free || (base_ == Base::byFile && b.name != "world" && mass > 0);
  if (!free) return;
  mjcf::Joint j;
  j.from = b.from;
  j.kind = mjcf::JointKind::free;
  b.joints.push_back(std::move(j));
}

void Reader::place(int number, int parentBody) {
  Link& link = links_[static_cast<std::size_t>(number)];
  link.body = static_cast<int>(model_.bodies.size());
  mjcf::Body& body = model_.bodies.emplace_back();
  body.from = link.from;
  body.name = link.name;
  body.parent = parentBody;
  body.hasInertial = true;
  inertial(link.from, body);
  geometry_.read(link.from, body);
  for (const Element& e : childrenOf(link.from))
    if (e.tag() != "inertial" && e.tag() != "visual" && e.tag() != "collision") unsupported_.element(e);
  if (link.above < 0) return;
  const JointElement& j = joints_[static_cast<std::size_t>(link.above)];
  body.pose = originOf(j.from, unsupported_);
  joints(j, body);
}

void Reader::inertial(const Element& link, mjcf::Body& body) {
  const auto e = childOf(link, "inertial");
  if (!e) return;
  const Pose at = originOf(*e, unsupported_);
  engine::Mass mass{0, at.position, Mat3::Zero()};
  if (const auto m = childOf(*e, "mass")) {
    Attributes a(*m, unsupported_);
    mass.mass = a.number("value", 0);
    if (mass.mass < 0) throw m->error(fmt::format("expected a mass of 0 or more, found {}", mass.mass));
    a.finish();
  }
  if (const auto i = childOf(*e, "inertia")) {
    Attributes a(*i, unsupported_);
    const double xy = a.number("ixy", 0), xz = a.number("ixz", 0), yz = a.number("iyz", 0);
    mass.inertia << a.number("ixx", 0), xy, xz, xy, a.number("iyy", 0), yz, xz, yz, a.number("izz", 0);
    a.finish();
  }
  if (mass.mass > 0) mjcf::mendInertia(mass, *e, "an <inertial>", unsupported_);
  mass.inertia = at.rotation * mass.inertia * at.rotation.transpose();
  body.mass = mass;
}

mjcf::Joint Reader::axisOf(const JointElement& j, mjcf::JointKind kind, const Vec3& axis) {
  mjcf::Joint out;
  out.from = j.from;
  out.name = j.name;
  out.kind = kind;
  out.axis = axis;
  return out;
}

void Reader::joints(const JointElement& j, mjcf::Body& body) {
  using mjcf::JointKind;
  if (j.type == "fixed") return;
  if (j.type == "floating") {
    if (body.parent != 1 || !model_.bodies[1].joints.empty() || model_.bodies[1].mass.mass > 0)
      throw j.from.error("a floating joint is supported only below a root link without a mass, such as 'world'");
    body.joints.push_back(axisOf(j, JointKind::free, Vec3::UnitZ()));
    // A body that moves freely hangs on the world itself.
    body.pose = compose(model_.bodies[1].pose, body.pose);
    body.parent = 0;
    return;
  }
  Vec3 axis = Vec3::UnitX();
  if (const auto e = childOf(j.from, "axis")) {
    Attributes a(*e, unsupported_);
    a.take("xyz", axis);
    a.finish();
    if (!(axis.norm() > 1e-10)) throw e->error("expected an axis that is not 0");
  }
  axis.normalize();
  if (j.type == "planar") {
    // In the plane across the axis, and about it.
    const Vec3 x = axis.unitOrthogonal();
    int number = 0;
    for (const auto& [kind, along] : {std::pair(JointKind::slide, x), std::pair(JointKind::slide, Vec3(axis.cross(x))),
                                      std::pair(JointKind::hinge, axis)}) {
      mjcf::Joint joint = axisOf(j, kind, along);
      joint.name = fmt::format("{}_{}", j.name, ++number);
      body.joints.push_back(std::move(joint));
    }
    return;
  }
  mjcf::Joint joint = axisOf(j, j.type == "prismatic" ? JointKind::slide : JointKind::hinge, axis);
  joint.limited = j.type != "continuous";
  limits(j.from, joint);
  for (const Element& e : childrenOf(j.from)) {
    const auto tag = e.tag();
    if (tag == "mimic")
      mimic(e, j.name);
    else if (tag == "dynamics") {
      Attributes a(e, unsupported_);
      joint.damping = std::max(a.number("damping", 0), 0.0);
      joint.dryFriction = std::max(a.number("friction", 0), 0.0);
      a.finish();
    } else if (tag != "origin" && tag != "parent" && tag != "child" && tag != "axis" && tag != "limit" &&
               tag != "calibration" && tag != "safety_controller" && tag != "hardwareInterface") {
      unsupported_.element(e);
    }
  }
  body.joints.push_back(std::move(joint));
}

void Reader::limits(const Element& joint, mjcf::Joint& out) {
  const auto e = childOf(joint, "limit");
  if (!e) {
    if (out.limited)
      throw joint.error(fmt::format("expected an element <limit> in {}: its type has limits", joint.named()));
    return;
  }
  Attributes a(*e, unsupported_);
  out.range = {a.number("lower", 0), a.number("upper", 0)};
  if (out.limited && out.range[0] > out.range[1])
    throw e->error(fmt::format("expected 'lower' not above 'upper', found {} and {}", out.range[0], out.range[1]));
  if (const double effort = a.number("effort", 0); effort > 0) out.maxForce = effort;
  a.ignore({"velocity", "acceleration", "jerk"});
  a.finish();
}

void Reader::mimic(const Element& e, const std::string& joint) {
  Attributes a(e, unsupported_);
  const std::string leader = a.text("joint");
  const auto found = jointByName_.find(leader);
  if (found == jointByName_.end()) throw e.error(fmt::format("there is no joint '{}'", leader));
  const std::string& type = joints_[static_cast<std::size_t>(found->second)].type;
  if (leader == joint || (type != "revolute" && type != "continuous" && type != "prismatic"))
    throw e.error(fmt::format("expected another joint of one axis to mimic, found '{}'", leader));
  mjcf::Equality q;
  q.from = e;
  q.type = "joint";
  q.name = joint + "_mimic";
  q.first = joint;
  q.second = leader;
  q.polynomial = {a.number("offset", 0), a.number("multiplier", 1), 0, 0, 0};
  a.finish();
  model_.equalities.push_back(std::move(q));
}

}  // namespace

Document::Document(std::string name, std::string text) {
  file_.name = std::move(name);
  file_.text = std::move(text);
  mjcf::parse(file_);
  if (root().tag() != "robot")
    throw root().error(fmt::format("expected the element <robot>, found <{}>", root().tag()));
}

mjcf::Model readModel(const Document& document, Base base, const ReadMesh& readMesh, Unsupported& unsupported) {
  return Reader(document.root(), base, readMesh, unsupported).read();
}

}  // namespace spark::urdf
