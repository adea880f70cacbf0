#pragma once
/// \file
/// Friction of what Webots' solids are made of.

#include <map>
#include <string>
#include <vector>

#include "fields.h"

namespace spark::webots {

/// The friction of pairs of materials, as the ContactProperties of a world give it; 1 for all others. Colliders have
/// surfaces, not pairs: beside the material "default" the surface of the other material rules, and two others have the
/// mean of theirs (MuJoCo the larger one).
class ContactMaterials {
 public:
  /// Reads a node ContactProperties.
  void read(const Node& node, mjcf::Unsupported& unsupported);
  /// After all nodes are read. Names the pairs with another friction than theirs.
  void solve(mjcf::Unsupported& unsupported);
  /// That of a material's own surface.
  double friction(const std::string& material) const;
  /// True if the surface counts alone beside one of the material "default".
  bool rules(const std::string& material) const;

 private:
  struct Pair {
    const Node* from;
    std::string first, second;
    double friction;
    bool has(const std::string& material) const { return first == material || second == material; }
    const std::string& other(const std::string& material) const { return first == material ? second : first; }
  };
  double between(const Pair& pair) const;

  std::vector<Pair> pairs_;
  std::map<std::string, double, std::less<>> own_;  ///< by material
};

}  // namespace spark::webots
