#include "elements.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace spark::urdf {

std::vector<Element> childrenOf(const Element& e) {
  std::vector<Element> out;
  for (const pugi::xml_node node : e.node.children())
    if (node.type() == pugi::node_element) out.push_back({node, e.file});
  return out;
}

std::optional<Element> childOf(const Element& e, const char* tag) {
  const pugi::xml_node node = e.node.child(tag);
  return node ? std::optional(Element{node, e.file}) : std::nullopt;
}

std::string nameOf(const Element& e) {
  std::string name = e.node.attribute("name").value();
  if (name.empty()) throw e.error(fmt::format("expected an attribute 'name' of <{}>", e.tag()));
  return name;
}

Pose originOf(const Element& e, Unsupported& unsupported) {
  Pose out;
  const auto origin = childOf(e, "origin");
  if (!origin) return out;
  Attributes a(*origin, unsupported);
  a.take("xyz", out.position);
  Vec3 rpy = Vec3::Zero();
  a.take("rpy", rpy);
  a.finish();
  out.rotation = (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
                  Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
                     .toRotationMatrix();  // about fixed axes
  return out;
}

}  // namespace spark::urdf
