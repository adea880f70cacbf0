#pragma once
/// \file
/// What the builders of one MJCF model share.

#include "api/physics.h"
#include "api/provides.h"
#include "names.h"
#include "placed_bodies.h"

namespace spark::mjcf {

/// A model on its way into the tree. Names in the maps are those of the file.
struct Construction {
  /// A joint of the file and the node that was made of it.
  struct MadeJoint {
    const Joint* joint;
    IJoint* made;
  };

  /// Makes a transform. `local`: its pose in the transform above.
  Node& transform(Node& parent, const std::string& name, const Pose& local);
  /// The transform for what belongs to a body, and a pose in that transform: `local` is one in the body.
  Node& nodeOf(const PlacedBody& body);
  Pose inNode(const PlacedBody& body, const Pose& local);
  /// The path of a body's node as seen from a node below `top`; "": the world.
  std::string path(const PlacedBody& body);
  /// The frame of a body in that of the link that carries it, or in the world.
  static Pose frameOf(const PlacedBody& body) { return body.carrier == 0 ? body.world : body.inCarrier; }
  /// A site and its body.
  struct FoundSite {
    PlacedBody* body;
    const Site* site;
  };
  /// Throws Error, with the place of `user`, where there is none of that name.
  FoundSite site(const std::string& name, const Element& user);
  /// As Unsupported::attempt(); what failed leaves no nodes in `parent`.
  bool attempt(const Element& from, Node& parent, const std::function<void()>& work);
  /// True when there is such a class of perceptors or effectors.
  bool has(const char* className);

  const Model& model;
  Unsupported& unsupported;
  Node& top;  ///< all is below it
  Names names;
  PlacedBodies bodies;
  std::map<std::string, MadeJoint, std::less<>> joints{};
  std::map<std::string, Leaf*, std::less<>> freeJoints{};          ///< by the names of free joints
  std::map<std::string, const Leaf*, std::less<>> tendons{};       ///< by name
  std::map<std::string, Node*, std::less<>> sites{}, colliders{};  ///< colliders: by the names of geoms
  Flags flags{};              ///< those of the file, unless the model is attached to a world with flags of its own
  bool withoutParts = false;  ///< has() found no class for a sensor or an actuator
};

/// The child `mujoco`, or `name`, of an element's node, which holds what MuJoCo alone reads; nullptr where no plugin
/// provides its class.
Leaf* extensionOf(Leaf& element, const char* className, const char* name = "mujoco");

/// Says what of a file an extension was made of (IExtension::writtenAs()).
void setWritten(Leaf& extension, const std::string& text);

// Values for properties and methods.
inline List toList(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
template <std::size_t N>
List toList(const std::array<double, N>& a) {
  return List(a.begin(), a.end());
}

}  // namespace spark::mjcf
