#pragma once
/// \file
/// What a simulation looks like, for viewers of recordings: shapes, and where they are.

#include <memory>
#include <string>
#include <vector>

#include "api/scene.h"
#include "mcap.h"
#include "stream/scene_capture.h"

namespace spark::recorder {

/// Where the shapes are at one instant. Needs no scene any more.
struct Places {
  struct Frame {
    std::string path;
    int parent = -1;  ///< the frame to which joints link it, which is before it; -1: the world
  };
  std::shared_ptr<const std::vector<Frame>> frames;
  std::vector<Matrix> worlds;  ///< of each frame
  /// A message of the schema foxglove.FrameTransforms: each frame relative to its parent.
  std::string message(mcap::Time time) const;
};

/// The shapes of all colliders in the active scene, in the frames of their transforms.
class Frames {
 public:
  explicit Frames(Kernel& kernel) : kernel_(kernel) {}
  /// Looks at the scene again if it has changed. True if shapes() is another one.
  bool refresh();
  /// A message of the schema foxglove.SceneUpdate: all shapes, in place of those before.
  std::string shapes(mcap::Time time) const;
  /// Where they are now, as of the last place phase.
  Places places() const;

 private:
  Kernel& kernel_;
  TreeWatch tree_;
  std::uint64_t modified_ = 0;
  std::vector<const Transform*> transforms_;  ///< those with shapes; valid until the tree changes
  std::shared_ptr<const std::vector<Places::Frame>> frames_;
};

}  // namespace spark::recorder
