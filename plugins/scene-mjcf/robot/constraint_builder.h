#pragma once
/// \file
/// Makes nodes of the equalities and tendons of an MJCF model.

#include "construction.h"

namespace spark::mjcf {

/// Makes them where there are classes for them. Bodies and joints must be there.
class ConstraintBuilder {
 public:
  explicit ConstraintBuilder(Construction& construction) : c_(construction) {}
  /// Throws Error with file:line:column.
  void build();

 private:
  /// A node in the model; nullptr where no plugin provides its class.
  Leaf* make(const Element& from, const char* className, const std::string& name, const char* kind);
  /// The path of a body's node; "": the world.
  std::string path(const PlacedBody& body);
  std::string pathOf(const Construction::MadeJoint& joint);
  /// The joint of that name, which has one coordinate.
  const Construction::MadeJoint& jointOf(const std::string& name, const Element& user);
  /// The frame of a body in that of the link that carries it, or in the world.
  Pose frameOf(const PlacedBody& body);
  void equality(const Equality& x);
  void place(const Equality& x, Leaf& node);
  void tendon(const Tendon& t);
  double springLength(const Tendon& t);
  /// True if a joint whose reference or spring is not where the file has the bodies moves its sites in each other.
  bool hasShiftedJoint(const Tendon& t);
  /// A site and its body.
  struct Place {
    PlacedBody* body;
    const Site* site;
  };
  Place siteOf(const TendonPart& part);
  void addSite(const TendonPart& part, Leaf& node);

  Construction& c_;
};

}  // namespace spark::mjcf
