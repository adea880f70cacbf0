#include "facts.h"

#include <algorithm>

#include "spark/kernel.h"

namespace spark::test {

namespace {

/// The shortest text that converts back to the same number.
std::string exact(double v) { return Value(v).text(); }
template <class Vector>
std::string exactAll(const Vector& v) {
  std::string out;
  for (int i = 0; i < v.size(); ++i) out += (i ? " " : "") + exact(v.data()[i]);
  return out;
}

struct Line {
  std::string words;
  void add(const std::string& key, const std::string& value) { words += " " + key + "=" + value; }
};

void addBody(const IRigidBody& body, Line& line) {
  const engine::BodyState s = body.state();
  line.add("position", exactAll(s.position));
  line.add("rotation", exactAll(s.rotation));
  // The inertia has no property. It is part of the saved state, and so is all other state of the engine.
  StateWriter state(false);
  saveTree(const_cast<IRigidBody&>(body).leaf(), state);
  line.add("state", fmt::format("{:x}", state.hash()));
}

void addJoint(IJoint& joint, Node& root, Line& line) {
  const int axes =
      joint.jointType() == engine::JointType::hinge || joint.jointType() == engine::JointType::slider ? 1 : 3;
  for (int i = 0; i < 2; ++i)
    line.add("body" + std::to_string(i),
             joint.body(i) ? joint.body(i)->leaf().path().substr(root.path().size()) : "world");
  if (axes == 1)
    for (const char* method : {"getAnchor", "getAxis"})
      if (joint.leaf().classObject()->method(method)) line.add(method, callMethod(joint.leaf(), method, {}).text());
  for (int axis = 0; axis < axes; ++axis)
    for (int p = 0; p <= static_cast<int>(engine::JointParameter::suspensionCfm); ++p)
      line.add(fmt::format("p{}.{}", axis, p), exact(joint.parameter(static_cast<engine::JointParameter>(p), axis)));
}

void addVisual(const IVisual& visual, Line& line) {
  line.add("load", visual.load());
  line.add("scale", exactAll(visual.scale()));
  line.add("materials", fmt::format("{}", fmt::join(visual.materials(), ",")));
  for (const Color& c : visual.lightColors())
    line.add("light", exact(c.r) + " " + exact(c.g) + " " + exact(c.b) + " " + exact(c.a));
}

/// The parameters of the surface that are in effect; disabled ones are ignored.
void addSurface(const engine::Surface& s, Line& line) {
  if (s.bounceOn) line.add("bounce", exact(s.bounce) + " " + exact(s.bounceVelocity));
  if (s.softErpOn) line.add("softErp", exact(s.softErp));
  if (s.softCfmOn) line.add("softCfm", exact(s.softCfm));
  if (s.slipOn) line.add("slip", exact(s.slip1) + " " + exact(s.slip2));
  line.add("mu", exact(s.mu));
}

void describeNode(Node& root, Leaf& leaf, std::vector<std::string>& out) {
  Line line{leaf.path().substr(root.path().size()) + " " + leaf.classObject()->name()};
  auto handler = leaf.as<CollisionHandler>();
  if (handler && handler->surface()) addSurface(*handler->surface(), line);
  for (const Property* p : leaf.classObject()->properties())
    if (!(handler && handler->surface()) && p->name != "path" && p->name != "name")
      line.add(p->name, p->get(leaf).text());
  if (auto body = leaf.as<IRigidBody>()) addBody(*body, line);
  if (auto joint = leaf.as<IJoint>()) addJoint(*joint, root, line);
  if (auto visual = leaf.as<IVisual>()) addVisual(*visual, line);
  if (auto collider = leaf.as<ICollider>()) {
    Vec3 low, high;
    collider->bounds(low, high);
    line.add("low", exactAll(low));
    line.add("high", exactAll(high));
    line.add("body", collider->body() ? collider->body()->leaf().path().substr(root.path().size()) : "world");
  }
  out.push_back(std::move(line.words));
}

template <class F>
void visit(Node& root, F f) {
  for (const auto& child : root.children()) {
    f(*child);
    if (Node* inner = child->asNode()) visit(*inner, f);
  }
}

}  // namespace

std::vector<std::string> nodeFacts(Node& root) {
  std::vector<std::string> out;
  visit(root, [&](Leaf& leaf) { describeNode(root, leaf, out); });
  return out;
}

std::vector<std::string> creationOrder(Node& root) {
  std::vector<const Leaf*> made;
  visit(root, [&](Leaf& leaf) {
    if (leaf.as<IRigidBody>() || leaf.as<IJoint>() || leaf.as<ICollider>()) made.push_back(&leaf);
  });
  std::sort(made.begin(), made.end(), [](const Leaf* a, const Leaf* b) { return a->id() < b->id(); });
  std::vector<std::string> out;
  for (const Leaf* leaf : made) out.push_back(leaf->path().substr(root.path().size()));
  return out;
}

std::vector<std::string> motion(Node& root) {
  std::vector<std::string> out;
  visit(root, [&](Leaf& leaf) {
    auto body = leaf.as<IRigidBody>();
    if (!body) return;
    const engine::BodyState s = body->state();
    out.push_back(leaf.path().substr(root.path().size()) + " " + exactAll(s.position) + " " + exactAll(s.rotation) +
                  " " + exactAll(s.linearVelocity) + " " + exactAll(s.angularVelocity));
  });
  return out;
}

}  // namespace spark::test
