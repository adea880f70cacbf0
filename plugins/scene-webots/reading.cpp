#include "reading.h"

#include <fmt/format.h>

#include "base_nodes.h"

namespace spark::webots {

namespace {
constexpr double kFarthest = 1e9;  ///< m: as Transform::kMaxMagnitude
}

std::string UniqueNames::add(const std::string& name) {
  if (taken_.insert(name).second) return name;
  // From the last number on: many solids have one name.
  int& number = last_.try_emplace(name, 1).first->second;
  std::string out;
  do {
    out = fmt::format("{}~{}", name, ++number);
  } while (!taken_.insert(out).second);
  return out;
}

Error Reading::missing(const Node& node) const {
  if (isBaseNode(node.type)) return node.element().error(fmt::format("a node {} cannot be here", node.type));
  return node.element().error(
      fmt::format("'{}' is no node of Webots, and its PROTO is not there: {}. What to do: put its file in one of these "
                  "places, nothing is fetched from the web",
                  node.type, document.whyMissing(node.type)));
}

Frame frameIn(const Frame& around, Fields& f) {
  Frame out{around.body, around.at({f.vector("translation", Vec3::Zero()), f.rotation("rotation")}), around.scale};
  const Vec3 scale = f.vector("scale", Vec3::Ones());
  if (!(scale.minCoeff() > 0)) throw f.error("scale", "expected three numbers above 0 for 'scale'");
  if (!around.isUniform() && f.has("rotation") && !f.rotation("rotation").isIdentity(1e-9))
    throw f.error("rotation", "a rotation in a frame that is scaled differently in its directions is not supported");
  out.scale = around.scale.cwiseProduct(scale);
  if (!(out.pose.position.cwiseAbs().maxCoeff() <= kFarthest) || !(out.scale.maxCoeff() <= kFarthest))
    throw f.element().error(fmt::format("expected lengths of at most {:g} m", kFarthest));
  return out;
}

}  // namespace spark::webots
