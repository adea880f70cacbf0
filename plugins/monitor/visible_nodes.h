#pragma once

#include <vector>

#include "api/monitor.h"

namespace spark {

/// The nodes of the active scene that monitors see, in depth-first order: transforms, lights and meshes; everything
/// else is transparent, its visible children stand in its place. Looked up again only when the tree or the scene
/// changed.
class VisibleNodes {
 public:
  /// Looks again if needed. True when clients need a full message: nodes came or went, or the scene was marked
  /// modified.
  bool refresh(Kernel& kernel);
  /// True when refresh() would find nothing new: pointers that it gave out are valid.
  bool fresh(Kernel& kernel) const;
  /// Copies what the nodes say now; after refresh().
  void copyTo(std::vector<FrameNode>& out) const;
  /// Numbers of the nodes, in their order. Later made nodes have higher ones.
  const std::vector<std::uint64_t>& ids() const { return ids_; }

 private:
  struct Entry {
    Transform* transform = nullptr;
    IVisual* visual = nullptr;
    int depth = 0;
  };
  void collect(const Node& above, int depth);
  std::vector<Entry> entries_;
  std::vector<std::uint64_t> ids_, lastIds_;
  std::vector<int> depths_, lastDepths_;
  const ISceneServer* server_ = nullptr;
  TreeWatch tree_;
  std::uint64_t modified_ = 0;
};

}  // namespace spark
