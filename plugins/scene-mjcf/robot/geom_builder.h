#pragma once
/// \file
/// Makes the colliders, shapes and sites of an MJCF model.

#include "construction.h"

namespace spark::mjcf {

/// Makes colliders and visible shapes of geoms, transforms of sites, and lets pairs of colliders collide or not. Bodies
/// must be there.
class GeomBuilder {
 public:
  explicit GeomBuilder(Construction& construction) : c_(construction) {}
  /// What cannot be made, or names what is not there, is left out, and named.
  void build();

 private:
  void makeGeoms(PlacedBody& b);
  /// What a convex shape is the hull of; nullptr: itself.
  const engine::Mesh* sourceOf(const engine::ShapeDescription& hull) const;
  /// The shape of its collider. Where meshes are not hulls: what does not move keeps its hollows.
  engine::ShapeDescription collisionShape(const Geom& geom, bool moves);
  void makeCollider(const Geom& geom, PlacedBody& b);
  void makeVisible(const Geom& geom, const PlacedBody& b);
  std::string materialOf(const std::array<double, 4>& color);
  void makeSites(const PlacedBody& b);
  void exclude(const Exclusion& x);
  void pair(const Pair& p);
  /// What MuJoCo alone reads of a pair.
  void surfaceOf(const Pair& p, const Node& first, const Node& second);
  bool inPair(const std::string& geom) const;

  Construction& c_;
};

}  // namespace spark::mjcf
