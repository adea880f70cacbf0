#include "reading.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base_nodes.h"
#include "robot/mended_numbers.h"

namespace spark::webots {

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

void Reading::missing(const Node& node) {
  if (isBaseNode(node.type)) return ignore(node, fmt::format("a node {} cannot be here; it is left out", node.type));
  ignore(node, fmt::format("a node '{}' is empty: {}", node.type, document.whyMissing(node.type)));
}

Frame frameIn(const Frame& around, Fields& f) {
  Frame out{around.body, around.at({f.vector("translation", Vec3::Zero()), f.rotation("rotation")}), around.scale};
  f.ignore({"translationStep", "rotationStep"});  // of the editor
  Vec3 scale = f.vector("scale", Vec3::Ones());
  for (double& s : scale)
    if (s == 0 || !std::isfinite(s)) {
      f.wrong("scale", "expected three numbers that are not 0 for 'scale'; 1 is taken");
      s = 1;
    }
  if (!around.isUniform() && f.has("rotation") && !f.rotation("rotation").isIdentity(1e-9))
    f.wrong("rotation",
            "a rotation in a frame that is scaled differently in its directions is not supported: what is in "
            "it is not sheared");
  out.scale = around.scale.cwiseProduct(scale);
  if (!(out.pose.position.cwiseAbs().maxCoeff() <= mjcf::kPlaces.most)) {
    f.wrong("translation", fmt::format("expected a place at most {:g} m away; 0 0 0 is taken", mjcf::kPlaces.most));
    out.pose.position = around.pose.position;
  }
  if (!(out.scale.cwiseAbs().maxCoeff() <= mjcf::kPlaces.most)) {
    f.wrong("scale", fmt::format("expected a scale of at most {:g}; 1 is taken", mjcf::kPlaces.most));
    out.scale = around.scale;
  }
  return out;
}

Frame standing(const Node& geometry, const Frame& frame) {
  if (!geometry.yUp || !standsUp(geometry.type)) return frame;
  // z to y.
  Frame out{frame.body, frame.at({Vec3::Zero(), Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()).toRotationMatrix()}),
            frame.scale};
  std::swap(out.scale.y(), out.scale.z());
  return out;
}

}  // namespace spark::webots
