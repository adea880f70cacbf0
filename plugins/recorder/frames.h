#pragma once
/// \file
/// What a simulation looks like, for viewers of recordings: shapes, and where they are.

#include <string>
#include <vector>

#include "api/scene.h"
#include "mcap.h"

namespace spark::recorder {

/// The shapes of all colliders in the active scene, in the frames of their transforms.
class Frames {
 public:
  explicit Frames(Kernel& kernel) : kernel_(kernel) {}
  /// Looks at the scene again if it has changed. True if shapes() is another one.
  bool refresh();
  /// A message of the schema foxglove.SceneUpdate: all shapes, in place of those before.
  std::string shapes(mcap::Time time) const;
  /// A message of the schema foxglove.FrameTransforms: where they are now, as of the last place phase.
  std::string places(mcap::Time time) const;

 private:
  void collect(const Node& parent);
  Kernel& kernel_;
  TreeWatch tree_;
  std::uint64_t modified_ = 0;
  std::vector<Transform*> transforms_;  ///< those with shapes; valid until the tree changes
  std::vector<std::string> paths_;      ///< their paths
};

}  // namespace spark::recorder
