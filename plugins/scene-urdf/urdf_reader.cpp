#include "urdf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "agent_parts.h"
#include "gazebo_reader.h"
#include "geometry_reader.h"
#include "robot/mended_mass.h"
#include "robot/mended_numbers.h"
#include "vocabulary.h"

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
  int addLink(const Element& from, const std::string& name);
  void readJoints();
  void readJoint(const Element& e);
  int linkOf(const Element& joint, const char* tag);
  int rootLink();
  int linksBelow(int root) const;
  void place(int link, int parentBody);
  void placeAll(int link);
  void inertial(const Element& link, mjcf::Body& body);
  void contact(const Element& link, mjcf::Body& body);
  void joints(const JointElement& j, mjcf::Body& body);
  mjcf::Joint axisOf(const JointElement& j, mjcf::JointKind kind, const Vec3& axis);
  void limits(const Element& e, mjcf::Joint& joint);
  void dynamics(const Element& e, mjcf::Joint& joint);
  void mimic(const Element& e, const std::string& joint);
  void dropFollowers();
  void freeBase();

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
  model_.name = textOf(root_, "name");
  if (model_.name.empty()) unsupported_.add(root_, "the robot has no name: it is called 'model'");
  model_.selfCollides = false;
  model_.bodies.emplace_back().from = root_;
  nameUnknown(root_, unsupported_);
  readLinks();
  readJoints();
  placeAll(rootLink());
  model_.surfaces = geometry_.surfaces();
  // Links that only connect joints often have none.
  mjcf::weighLightBodies(model_, "a <link>", mjcf::kNextToNoMass, unsupported_);
  GazeboReader(root_, model_, unsupported_).apply();
  mjcf::mendNumbers(model_, unsupported_);
  AgentParts(root_, model_, unsupported_).add();
  return std::move(model_);
}

void Reader::readLinks() {
  bool xacro = false;
  for (const Element& e : childrenOf(root_)) {
    xacro |= e.tag().starts_with("xacro:");
    if (e.tag() == "link") addLink(e, nameOf(e));
  }
  if (links_.empty())
    throw root_.error(fmt::format("expected a <link>, found none{}",
                                  xacro ? ": this is xacro; expand it first (xacro robot.xacro > robot.urdf)" : ""));
}

int Reader::addLink(const Element& from, const std::string& name) {
  const int number = static_cast<int>(links_.size());
  if (!linkByName_.emplace(name, number).second) throw from.error(fmt::format("there are two links '{}'", name));
  links_.push_back({from, name});
  if (links_.size() > mjcf::kMaxBodies) throw from.error(fmt::format("expected at most {} links", mjcf::kMaxBodies));
  return number;
}

int Reader::linkOf(const Element& joint, const char* tag) {
  const auto e = childOf(joint, tag);
  if (!e) throw joint.error(fmt::format("expected an element <{}> in {}", tag, joint.named()));
  const std::string name(textOf(*e, "link"));
  const auto found = linkByName_.find(name);
  if (found != linkByName_.end()) return found->second;
  if (name != "world" || std::string_view(tag) != "parent") throw e->error(fmt::format("there is no link '{}'", name));
  unsupported_.add(*e, "there is no link 'world': the world itself is meant");
  return addLink(*e, name);
}

void Reader::readJoints() {
  for (const Element& e : childrenOf(root_))
    if (e.tag() == "joint") readJoint(e);
}

void Reader::readJoint(const Element& e) {
  static constexpr std::string_view kTypes[] = {"revolute", "continuous", "prismatic", "fixed",
                                                "floating", "planar",     "spherical"};
  JointElement j{e, nameOf(e), std::string(textOf(e, "type"))};
  if (std::find(std::begin(kTypes), std::end(kTypes), j.type) == std::end(kTypes))
    throw e.error(fmt::format(
        "expected revolute, continuous, prismatic, fixed, floating or planar for 'type', found '{}'", j.type));
  j.parent = linkOf(e, "parent");
  j.child = linkOf(e, "child");
  const int number = static_cast<int>(joints_.size());
  if (jointByName_.contains(j.name)) throw e.error(fmt::format("there are two joints '{}'", j.name));
  Link& child = links_[static_cast<std::size_t>(j.child)];
  if (child.above >= 0)
    return unsupported_.add(
        e, fmt::format("the joint '{}' is left out: its child, the link '{}', is that of the joint '{}' already",
                       j.name, child.name, joints_[static_cast<std::size_t>(child.above)].name));
  jointByName_.emplace(j.name, number);
  child.above = number;
  links_[static_cast<std::size_t>(j.parent)].joints.push_back(number);
  joints_.push_back(std::move(j));
}

/// Itself and all below it.
int Reader::linksBelow(int root) const {
  int count = 0;
  for (std::vector<int> open{root}; !open.empty(); ++count) {
    const Link& link = links_[static_cast<std::size_t>(open.back())];
    open.pop_back();
    for (const int j : link.joints) open.push_back(joints_[static_cast<std::size_t>(j)].child);
  }
  return count;
}

/// That of the largest tree. Other trees are left out.
int Reader::rootLink() {
  std::vector<int> roots;
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].above < 0) roots.push_back(static_cast<int>(i));
  if (roots.empty()) throw root_.error("each link is the child of a joint: the joints go round in a circle");
  int inTrees = 0, largest = 0, found = -1;
  for (const int root : roots) {
    const int count = linksBelow(root);
    inTrees += count;
    if (count > largest) largest = count, found = root;
  }
  if (inTrees < static_cast<int>(links_.size()))
    throw root_.error("expected links that all hang on one root, found joints that go round in a circle");
  const std::string& name = links_[static_cast<std::size_t>(found)].name;
  for (const int root : roots)
    if (root != found) {
      const Link& link = links_[static_cast<std::size_t>(root)];
      unsupported_.add(link.from, fmt::format("the link '{}'{} is left out: it does not hang on the root link '{}'",
                                              link.name, link.joints.empty() ? "" : " with all below it", name));
    }
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
  dropFollowers();
  freeBase();
}

/// A joint whose leader is in a tree that was left out follows nothing.
void Reader::dropFollowers() {
  std::set<std::string_view> made;
  for (const mjcf::Body& b : model_.bodies)
    for (const mjcf::Joint& j : b.joints) made.insert(j.name);
  std::erase_if(model_.equalities, [&](const mjcf::Equality& q) { return !made.contains(q.second); });
}

/// The base is free if it can fall.
void Reader::freeBase() {
  const std::size_t base = 1;
  double mass = 0;
  std::vector<bool> isFixed(model_.bodies.size());
  for (std::size_t i = base; i < model_.bodies.size(); ++i) {
    const mjcf::Body& b = model_.bodies[i];
    isFixed[i] = i == base || (b.joints.empty() && isFixed[static_cast<std::size_t>(b.parent)]);
    if (isFixed[i]) mass += b.mass.mass;
  }
  mjcf::Body& b = model_.bodies[base];
  const bool canFall = b.name != "world" && mass > 0 && !GazeboReader::isStatic(root_);
  if (base_ == Base::fixed || (base_ == Base::byFile && !canFall)) return;
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
  contact(link.from, body);
  if (link.above < 0) return;
  const JointElement& j = joints_[static_cast<std::size_t>(link.above)];
  body.pose = originOf(j.from, unsupported_);
  joints(j, body);
}

/// As Bullet has it.
void Reader::contact(const Element& link, mjcf::Body& body) {
  const auto e = childOf(link, "contact");
  const auto friction = e ? childOf(*e, "lateral_friction") : std::nullopt;
  if (!friction) return;
  const double mu = Numbers(*friction, unsupported_).number("value", 1);
  if (mu < 0) return unsupported_.add(*friction, "a friction below 0 is ignored");
  for (mjcf::Geom& g : body.geoms) g.contact.friction[0] = mu;
}

void Reader::inertial(const Element& link, mjcf::Body& body) {
  const auto e = childOf(link, "inertial");
  if (!e) return;
  const Pose at = originOf(*e, unsupported_);
  engine::Mass mass{0, at.position, Mat3::Zero()};
  if (const auto m = childOf(*e, "mass")) {
    mass.mass = Numbers(*m, unsupported_).number("value", 0);
    if (mass.mass < 0) {
      unsupported_.add(*m, "a mass below 0 counts as none");
      mass.mass = 0;
    }
  }
  if (const auto i = childOf(*e, "inertia")) {
    Numbers a(*i, unsupported_);
    const double xy = a.number("ixy", 0), xz = a.number("ixz", 0), yz = a.number("iyz", 0);
    mass.inertia << a.number("ixx", 0), xy, xz, xy, a.number("iyy", 0), yz, xz, yz, a.number("izz", 0);
  }
  if (mass.mass > 0 && mass.mass <= mjcf::kMasses.most) mjcf::mendInertia(mass, *e, "an <inertial>", unsupported_);
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
    body.joints.push_back(axisOf(j, JointKind::free, Vec3::UnitZ()));
    // A body that moves freely hangs on the world itself.
    for (; body.parent > 0; body.parent = model_.bodies[static_cast<std::size_t>(body.parent)].parent)
      body.pose = compose(model_.bodies[static_cast<std::size_t>(body.parent)].pose, body.pose);
    body.parent = 0;
    return;
  }
  if (j.type == "spherical") {
    body.joints.push_back(axisOf(j, JointKind::ball, Vec3::UnitZ()));
    if (const auto e = childOf(j.from, "dynamics")) dynamics(*e, body.joints.back());
    return;
  }
  Vec3 axis = Vec3::UnitX();
  if (const auto e = childOf(j.from, "axis")) {
    Numbers(*e, unsupported_).take("xyz", axis);
    if (!(axis.norm() > 1e-10)) {
      unsupported_.add(*e, "an axis of length 0 counts as '1 0 0'");
      axis = Vec3::UnitX();
    }
  }
  // Of a length whose square is no number, too.
  axis = std::isfinite(axis.norm()) ? axis.normalized() : axis.stableNormalized();
  if (j.type == "planar") {
    for (const char* const tag : {"limit", "mimic", "dynamics"})
      if (const auto e = childOf(j.from, tag))
        unsupported_.add(*e, fmt::format("the <{}> of a planar joint is not supported", tag));
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
  if (const auto e = childOf(j.from, "dynamics")) dynamics(*e, joint);
  if (const auto e = childOf(j.from, "mimic")) mimic(*e, j.name);
  body.joints.push_back(std::move(joint));
}

/// Readers of URDF take limits of which the lower is not below the upper one as none.
void Reader::limits(const Element& joint, mjcf::Joint& out) {
  const auto e = childOf(joint, "limit");
  if (!e) {
    if (out.limited)
      unsupported_.add(joint, fmt::format("a {} joint without <limit> has no limits", textOf(joint, "type")));
    out.limited = false;
    return;
  }
  Numbers a(*e, unsupported_);
  out.range = {a.number("lower", 0), a.number("upper", 0)};
  if (out.limited && !(out.range[0] < out.range[1])) {
    unsupported_.add(*e, "a <limit> whose 'lower' is not below its 'upper' counts as no limit");
    out.limited = false;
  }
  const double effort = a.number("effort", 0);
  if (effort > 0)
    out.maxForce = effort;
  else if (e->node.attribute("effort"))
    unsupported_.add(*e, "an 'effort' that is not above 0 counts as no limit");
}

void Reader::dynamics(const Element& e, mjcf::Joint& joint) {
  Numbers a(e, unsupported_);
  const auto atLeastZero = [&](const char* attribute) {
    const double v = a.number(attribute, 0);
    if (v < 0) unsupported_.add(e, fmt::format("a '{}' below 0 counts as 0", attribute));
    return std::max(v, 0.0);
  };
  joint.damping = atLeastZero("damping");
  joint.dryFriction = atLeastZero("friction");
}

void Reader::mimic(const Element& e, const std::string& joint) {
  const std::string leader(textOf(e, "joint"));
  const auto leave = [&](const std::string& why) {
    unsupported_.add(e, fmt::format("the <mimic> of the joint '{}' is left out: {}", joint, why));
  };
  const auto found = jointByName_.find(leader);
  if (found == jointByName_.end()) return leave(fmt::format("there is no joint '{}'", leader));
  const std::string& type = joints_[static_cast<std::size_t>(found->second)].type;
  if (leader == joint || (type != "revolute" && type != "continuous" && type != "prismatic"))
    return leave(fmt::format("expected another joint of one axis, found '{}'", leader));
  Numbers a(e, unsupported_);
  mjcf::Equality q;
  q.from = e;
  q.type = "joint";
  q.name = joint + "_mimic";
  q.first = joint;
  q.second = leader;
  q.polynomial = {a.number("offset", 0), a.number("multiplier", 1), 0, 0, 0};
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
