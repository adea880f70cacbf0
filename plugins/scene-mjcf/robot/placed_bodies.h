#pragma once
/// \file
/// The bodies of an MJCF model in the world, and which of them move as one.

#include <map>

#include "model.h"
#include "spark/node.h"

namespace spark::mjcf {

/// A body of the file. One without joints is part of the next one above that has any, its carrier, or of the world.
struct PlacedBody {
  const Body* body = nullptr;
  int carrier = 0;                                   ///< index; its own: it is a carrier; 0: the world
  Pose inCarrier;                                    ///< of the body's frame
  Pose world;                                        ///< of the body's frame, when built
  engine::Mass mass{0, Vec3::Zero(), Mat3::Zero()};  ///< of a carrier: all of it, centre in its frame
  std::vector<engine::Part> parts;  ///< of a carrier: its own, and the bodies fixed to it; in its frame
  int part = 0;                     ///< index in the carrier's
  double compensatedMass = 0;       ///< of a carrier: the part of its mass that gravity spares
  int above = 0;                    ///< of a carrier: the carrier that its joints connect it to
  Node* node = nullptr;             ///< of a carrier: its transform, once made
  std::vector<Node*> colliders;     ///< of the body's own geoms, once made
};

/// All bodies of a model, which must outlive them.
class PlacedBodies {
 public:
  /// `root`: world pose of what they are built below. Throws Error for free joints that bodies cannot have, and for two
  /// bodies of one name.
  PlacedBodies(const Model& model, const Pose& root);
  auto begin() { return bodies_.begin(); }
  auto end() { return bodies_.end(); }
  PlacedBody& operator[](int index) { return bodies_[static_cast<std::size_t>(index)]; }
  PlacedBody& carrierOf(const PlacedBody& b) { return (*this)[b.carrier]; }
  bool isCarrier(const PlacedBody& b) const { return b.carrier != 0 && &bodies_[std::size_t(b.carrier)] == &b; }
  /// The body of that name; "world": the world. Throws Error with the place of `user`.
  PlacedBody& find(const std::string& name, const Element& user);
  /// World pose of what all is built below.
  const Pose& root() const { return root_; }

 private:
  void place(std::size_t index, const Body& b);

  Pose root_;
  std::vector<PlacedBody> bodies_;  ///< as in the model
  std::map<std::string, PlacedBody*, std::less<>> byName_;
  std::set<std::string, std::less<>> held_;  ///< by equalities, which depend on where a massless body is
};

}  // namespace spark::mjcf
