#include "gazebo_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace spark::urdf {

namespace {

/// Colours of Gazebo's own materials, as their names say.
const std::map<std::string_view, std::array<double, 4>> kColors{
    {"Gazebo/Black", {0, 0, 0, 1}},          {"Gazebo/DarkGrey", {0.2, 0.2, 0.2, 1}},
    {"Gazebo/DarkGray", {0.2, 0.2, 0.2, 1}}, {"Gazebo/Grey", {0.5, 0.5, 0.5, 1}},
    {"Gazebo/Gray", {0.5, 0.5, 0.5, 1}},     {"Gazebo/LightGrey", {0.8, 0.8, 0.8, 1}},
    {"Gazebo/White", {1, 1, 1, 1}},          {"Gazebo/Red", {1, 0, 0, 1}},
    {"Gazebo/Green", {0, 1, 0, 1}},          {"Gazebo/Blue", {0, 0, 1, 1}},
    {"Gazebo/Yellow", {1, 1, 0, 1}},         {"Gazebo/Orange", {1, 0.5, 0, 1}},
    {"Gazebo/Purple", {1, 0, 1, 1}},         {"Gazebo/Turquoise", {0, 1, 1, 1}},
};

bool isTrue(std::string_view text) { return text == "true" || text == "True" || text == "TRUE" || text == "1"; }
bool isFalse(std::string_view text) { return text == "false" || text == "False" || text == "FALSE" || text == "0"; }

/// The body that moves a body's parts: itself, or the one that it is fixed to.
int carrierOf(const mjcf::Model& model, int body) {
  while (body > 0 && model.bodies[static_cast<std::size_t>(body)].joints.empty())
    body = model.bodies[static_cast<std::size_t>(body)].parent;
  return body;
}

}  // namespace

bool GazeboReader::isStatic(const Element& root) {
  for (const Element& g : childrenOf(root))
    if (const auto e = g.tag() == "gazebo" ? childOf(g, "static") : std::nullopt) return isTrue(contentOf(*e));
  return false;
}

void GazeboReader::apply() {
  for (const Element& g : childrenOf(root_)) {
    if (g.tag() != "gazebo") continue;
    const std::string_view name = textOf(g, "reference");
    if (name.empty()) {
      onRobot(g);
      continue;
    }
    bool found = false;
    for (std::size_t i = 1; i < model_.bodies.size(); ++i) {
      mjcf::Body& b = model_.bodies[i];
      if (b.name == name) onLink(g, b), found = true;
      for (mjcf::Joint& j : b.joints)
        if (j.name == name && j.kind != mjcf::JointKind::free) onJoint(g, j), found = true;
    }
    for (const Element& e : childrenOf(root_)) found |= e.tag() == "joint" && textOf(e, "name") == name;  // a fixed one
    if (!found) unsupported_.add(g, fmt::format("<gazebo> is ignored: there is no link or joint '{}'", name));
  }
  separate();
}

void GazeboReader::onRobot(const Element& gazebo) {
  for (const Element& e : childrenOf(gazebo)) {
    if (e.tag() != "selfCollide" && e.tag() != "self_collide") continue;
    if (flag(e))
      for (const mjcf::Body& b : model_.bodies) colliding_.insert(b.name);
  }
}

void GazeboReader::onLink(const Element& gazebo, mjcf::Body& body) {
  for (const Element& e : childrenOf(gazebo)) {
    const std::string_view tag = e.tag();
    if (tag == "mu1" || tag == "mu2")
      friction(e, body);
    else if (tag == "selfCollide" || tag == "self_collide")
      flag(e) ? colliding_.insert(body.name).first : colliding_.end();
    else if (tag == "gravity")
      body.gravityCompensation = flag(e) ? 0 : 1;
    else if (tag == "turnGravityOff")
      body.gravityCompensation = flag(e) ? 1 : 0;
    else if (tag == "material")
      color(e, body);
  }
}

void GazeboReader::onJoint(const Element& gazebo, mjcf::Joint& joint) {
  for (const Element& e : childrenOf(gazebo)) {
    if (e.tag() == "springStiffness")
      joint.stiffness = std::max(number(e).value_or(0), 0.0);
    else if (e.tag() == "springReference")
      joint.springPosition = number(e).value_or(0);
  }
}

/// Surfaces here have one coefficient: that of the first direction.
void GazeboReader::friction(const Element& e, mjcf::Body& body) {
  const auto mu = number(e);
  if (!mu) return;
  if (*mu < 0) return unsupported_.add(e, fmt::format("a <{}> below 0 is ignored", e.tag()));
  const auto first = childOf(Element{e.node.parent(), e.file}, "mu1");
  if (e.tag() == "mu2" && first) {
    const auto other = numbersOf(contentOf(*first));
    if (other && other->front() != *mu)
      unsupported_.add(e, "a <mu2> other than <mu1> is ignored: <mu1> counts in all directions");
    return;
  }
  for (mjcf::Geom& g : body.geoms) g.contact.friction[0] = *mu;
}

void GazeboReader::color(const Element& e, mjcf::Body& body) {
  const auto known = kColors.find(contentOf(e));
  if (known == kColors.end())
    return unsupported_.add(e, fmt::format("the material '{}' is not known: it changes no colour", contentOf(e)));
  for (mjcf::Geom& g : body.geoms)
    if (g.visible()) g.color = known->second;
}

bool GazeboReader::flag(const Element& e) {
  const std::string_view text = contentOf(e);
  if (!isTrue(text) && !isFalse(text))
    unsupported_.add(e, fmt::format("<{}> is ignored: expected true or false, found '{}'", e.tag(), text));
  return isTrue(text) || (e.tag() == "gravity" && !isFalse(text));
}

std::optional<double> GazeboReader::number(const Element& e) {
  const auto found = numbersOf(contentOf(e));
  if (found && found->size() == 1) return found->front();
  unsupported_.add(e, fmt::format("<{}> is ignored: expected a number, found '{}'", e.tag(), contentOf(e)));
  return std::nullopt;
}

/// Two links collide if one of them collides with others of the robot.
void GazeboReader::separate() {
  if (colliding_.empty()) return;
  model_.selfCollides = true;
  const int count = static_cast<int>(model_.bodies.size());
  for (int i = 1; i < count; ++i)
    for (int k = i + 1; k < count; ++k) {
      const mjcf::Body &a = model_.bodies[static_cast<std::size_t>(i)], &b = model_.bodies[static_cast<std::size_t>(k)];
      if (a.geoms.empty() || b.geoms.empty() || carrierOf(model_, i) == carrierOf(model_, k)) continue;
      if (!colliding_.contains(a.name) && !colliding_.contains(b.name))
        model_.exclusions.push_back({a.from, a.name, b.name});
    }
}

}  // namespace spark::urdf
