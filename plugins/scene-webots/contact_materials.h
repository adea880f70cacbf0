#pragma once
/// \file
/// Friction of what Webots' solids are made of.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fields.h"

namespace spark::webots {

/// How rough one material is.
struct Roughness {
  double own = 1;          ///< two surfaces that touch have the mean of theirs, or in MuJoCo
  double beside = 1;       ///< this one, if the other is of the material "default",
  bool isOrdinary = true;  ///< which this one is as well, or has the roughness of
};

/// The friction of pairs of materials, as the ContactProperties of a world give it; 1 for all others. The engines know
/// surfaces, not pairs: each material gets the roughness with which as many pairs as possible have their friction,
/// those with "default" first.
class ContactMaterials {
 public:
  /// Reads a node ContactProperties.
  void read(const Node& node, mjcf::Unsupported& unsupported);
  /// After all nodes are read. Names the pairs with another friction than theirs.
  void solve(mjcf::Unsupported& unsupported);
  Roughness of(const std::string& material) const;

 private:
  struct Pair {
    const Node* from;
    std::string first, second;
    double friction;
    bool has(const std::string& material) const { return first == material || second == material; }
    const std::string& other(const std::string& material) const { return first == material ? second : first; }
  };
  void spread();
  std::optional<double> known(const std::string& material) const;

  std::vector<Pair> pairs_;
  std::map<std::string, double, std::less<>> own_;
};

}  // namespace spark::webots
