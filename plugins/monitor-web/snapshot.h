#pragma once
/// \file
/// One instant of the scene as plain data: what the simulation's thread hands to the thread that serves viewers.

#include <memory>
#include <string>
#include <vector>

#include "api/monitor.h"

namespace spark::web {

/// A shape that touches, in the frame of the transform it belongs to.
struct SceneShape {
  enum class Kind { box, sphere, capsule, cylinder } kind = Kind::box;
  std::vector<double> size;                    ///< [m]: edges; radius; radius and length without caps
  Vec3 position = Vec3::Zero();                ///< m
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< x y z w
};

/// A node of the scene, as viewers build it.
struct NodeDescription {
  FrameNode::Kind kind = FrameNode::Kind::transform;
  int parent = -1;  ///< index among the nodes
  std::string path;
  std::vector<SceneShape> shapes;
  std::string load;
  Vec3f scale{1, 1, 1};
  std::vector<std::string> materials;
  bool transparent = false, visible = true;
};

/// What does not change from frame to frame.
struct SceneDescription {
  std::vector<NodeDescription> nodes;
};

/// One instant. Buffers keep their capacity from one to the next.
struct Snapshot {
  std::uint64_t shape = 0;            ///< MonitorFrame's
  double time = 0;                    ///< s
  std::vector<Matrix> transforms;     ///< of the transform nodes, in order
  std::vector<std::uint8_t> visible;  ///< of all nodes
  Environment environment;
  std::vector<EntryKey> keys;      ///< of its entries
  Predicates events;               ///< `once` entries since the last snapshot
  std::vector<double> eventTimes;  ///< s, of each
  /// Of this shape; made only when the shape is not `knownShape` and whoever asks wants it described.
  std::shared_ptr<const SceneDescription> scene;
  std::uint64_t knownShape = 0;  ///< what whoever asks has the scene of
  bool describe = true;
};

}  // namespace spark::web
