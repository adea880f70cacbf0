#pragma once
/// \file
/// Makes nodes of the equalities and tendons of an MJCF model.

#include "construction.h"

namespace spark::mjcf {

/// Makes them where there are classes for them. Bodies and joints must be there.
class ConstraintBuilder {
 public:
  explicit ConstraintBuilder(Construction& construction) : c_(construction) {}
  /// What names something that is not there is left out, and named.
  void build();

 private:
  /// A node in the model; nullptr where no plugin provides its class.
  Leaf* make(const Element& from, const char* className, const std::string& name, const char* kind);
  std::string pathOf(const Construction::MadeJoint& joint);
  /// The joint of that name, which has one coordinate.
  const Construction::MadeJoint& jointOf(const std::string& name, const Element& user);
  void equality(const Equality& x);
  void place(const Equality& x, Leaf& node);
  void tendon(const Tendon& t);
  double springLength(const Tendon& t);
  /// True if a joint whose reference or spring is not where the file has the bodies moves its sites in each other.
  bool hasShiftedJoint(const Tendon& t);
  /// A tendon's node, nullptr if no plugin provides its class. Throws Error where there is none of that name.
  const Leaf* tendonOf(const std::string& name, const Element& user);
  /// The geom that a tendon goes around, and its body.
  std::pair<PlacedBody*, const Geom*> geomOf(const TendonPart& part);
  void addPart(const TendonPart& part, Leaf& node);

  Construction& c_;
};

}  // namespace spark::mjcf
