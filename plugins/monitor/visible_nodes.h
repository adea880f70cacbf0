#pragma once
/// \file
/// The nodes of the scene that monitors see.

#include <vector>

#include "api/monitor.h"

namespace spark {

/// The transforms, lights and meshes of the active scene in depth-first order. Other nodes are skipped; their visible
/// children take their place. The list is rebuilt only if the tree or the scene has changed.
class VisibleNodes {
 public:
  /// Rebuilds the list if needed. True if clients need a full message: nodes were added or removed, or the scene was
  /// marked as modified.
  bool refresh(Kernel& kernel);
  /// True if refresh() would find no change; then the pointers of copyTo() are valid.
  bool fresh(Kernel& kernel) const;
  /// Writes the nodes with their current matrices and visibility. Call refresh() before.
  void copyTo(std::vector<FrameNode>& out) const;
  /// The nodes' ids, in the same order; a node that was created later has a higher one.
  const std::vector<std::uint64_t>& ids() const { return ids_; }

 private:
  struct Entry {
    Transform* transform = nullptr;
    IVisual* visual = nullptr;
    int depth = 0;
  };
  void collect(const Node& parent, int depth);
  std::vector<Entry> entries_;
  std::vector<std::uint64_t> ids_, lastIds_;
  std::vector<int> depths_, lastDepths_;
  const ISceneServer* server_ = nullptr;
  TreeWatch tree_;
  std::uint64_t modified_ = 0;
};

}  // namespace spark
