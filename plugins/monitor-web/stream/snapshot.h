#pragma once
/// \file
/// The scene at one instant as plain data. The simulation thread fills it, the I/O thread reads it.

#include <memory>
#include <string>
#include <vector>

#include "api/appearance.h"
#include "api/monitor.h"
#include "stream_encoder.h"

namespace spark::web {

/// The shape of a collider, in the frame of the transform that it belongs to.
struct SceneShape {
  enum class Kind { box, sphere, capsule, cylinder } kind = Kind::box;
  std::vector<double> size;      ///< [m] box: edges x y z; sphere: radius; others: radius, length (without caps)
  Vec3 position = Vec3::Zero();  ///< m
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< unit quaternion x y z w
};

/// A node of the scene.
struct NodeDescription {
  FrameNode::Kind kind = FrameNode::Kind::transform;
  int parent = -1;                 ///< index in SceneDescription::nodes; -1: top level
  std::string path;                ///< transforms: in the tree; "" in recorded scenes
  std::vector<SceneShape> shapes;  ///< transforms: of their colliders
  std::string load;                ///< meshes: as IVisual::load()
  Vec3f scale{1, 1, 1};
  std::vector<std::string> materials;
  bool transparent = false, visible = true;
  std::array<Color, 3> colors{};  ///< lights: diffuse, ambient, specular
};

/// A material that meshes of the scene name.
struct MaterialDescription {
  std::string name;
  IMaterial::Look look;
  std::string texture;  ///< resource name; "": none
};

/// The part of a scene that stays the same while MonitorFrame::shape does.
struct SceneDescription {
  std::vector<NodeDescription> nodes;
  std::vector<MaterialDescription> materials;  ///< those that the host has, in alphabetical order
  std::vector<Mount> mounts;                   ///< of each transform, in order
};

/// One instant. It is reused: its buffers keep their capacity.
struct Snapshot {
  std::uint64_t shape = 0;            ///< MonitorFrame::shape
  double time = 0;                    ///< s, simulated
  std::vector<Matrix> transforms;     ///< local matrices of the transform nodes, in order
  std::vector<std::uint8_t> visible;  ///< of all nodes, in order
  Environment environment;
  std::vector<EntryKey> keys;      ///< one per entry of `environment`
  Predicates events;               ///< `once` entries since the last snapshot
  std::vector<double> eventTimes;  ///< s, simulated; one per event
  /// Description of `shape`, if the I/O thread does not have it and wants it; otherwise nullptr.
  std::shared_ptr<const SceneDescription> scene;
};

}  // namespace spark::web
