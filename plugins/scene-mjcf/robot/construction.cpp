#include "construction.h"

#include <fmt/format.h>

#include "spark/access.h"
#include "spark/kernel.h"

namespace spark::mjcf {

Leaf* extensionOf(Leaf& element, const char* className, const char* name) {
  Node& node = *element.asNode();
  if (Leaf* const there = node.child(name)) return there;
  return provides(element.kernel(), className) ? &node.create(className, name) : nullptr;
}

void setWritten(Leaf& extension, const std::string& text) { callMethod(extension, "setWrittenAs", List{text}); }

Node& Construction::transform(Node& parent, const std::string& name, const Pose& local) {
  Node& node = *parent.create("Transform", name).asNode();
  // As a body would do it: nothing below takes the pose, which is in single precision.
  static_cast<Transform*>(node.requireAs(Transform::kInterface))->setLocalFromBody(toMatrix(local));
  return node;
}

Node& Construction::nodeOf(const PlacedBody& b) {
  Node* const node = bodies.carrierOf(b).node;
  return node ? *node : top;
}

Pose Construction::inNode(const PlacedBody& b, const Pose& local) {
  if (b.carrier == 0) return compose(inverse(bodies.root()), compose(b.world, local));
  // The origin of a body is its centre of mass.
  const Pose link{-bodies.carrierOf(b).mass.center, Mat3::Identity()};
  return compose(link, compose(b.inCarrier, local));
}

std::string Construction::path(const PlacedBody& body) {
  return body.carrier == 0 ? "" : "../" + bodies.carrierOf(body).node->name() + "/body";
}

Construction::FoundSite Construction::site(const std::string& name, const Element& user) {
  for (PlacedBody& b : bodies)
    for (const Site& s : b.body->sites)
      if (s.name == name && !s.name.empty()) return {&b, &s};
  throw user.error(fmt::format("there is no site '{}'", name));
}

bool Construction::attempt(const Element& from, Node& parent, const std::function<void()>& work) {
  const std::size_t before = parent.children().size();
  if (unsupported.attempt(from, work)) return true;
  while (parent.children().size() > before) parent.remove(*parent.children().back());
  return false;
}

bool Construction::has(const char* className) {
  const Kernel& kernel = top.kernel();
  const char* const base = std::string_view(className).ends_with("Effector") ? "Effector" : "Perceptor";
  if (kernel.findClass(base) && kernel.findClass(className)) return true;
  withoutParts = true;
  return false;
}

}  // namespace spark::mjcf
