#include "trees.h"

#include <utility>

namespace spark::bullet {

Trees::Trees(const engine::Model& model) {
  engine::JointTrees all(model);
  leftOver = std::move(all.leftOver);
  Index first = 0;  // of the tree
  for (Index i = 0; i < all.links.size(); ++i) {
    Link link = all.links[i];
    if (link.parent == kNone) {
      first = i;
      trees.emplace_back();
    } else {
      link.parent -= first;
    }
    trees.back().links.push_back(link);
  }
}

}  // namespace spark::bullet
