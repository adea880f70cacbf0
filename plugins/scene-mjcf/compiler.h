#pragma once
/// \file
/// The element `compiler`, and the attributes that are read as it says.

#include <array>

#include "api/math.h"
#include "api/model.h"
#include "document.h"

namespace spark::mjcf {

/// Reads angles, orientations, poses and limits.
class Compiler {
 public:
  /// Reads an element `compiler`; what it does not name stays. Throws Error.
  void read(Attributes& a);
  /// "" or "a/".
  const std::string& meshFolder() const { return meshFolder_; }
  /// "auto", "true" or "false".
  const std::string& inertiaFromGeom() const { return inertiaFromGeom_; }
  /// Geoms of this group add to the masses of their bodies.
  bool weighs(int group) const { return group >= inertiaGroups_[0] && group <= inertiaGroups_[1]; }
  /// Raises mass and moments of inertia to the least ones of the file; a mass of 0 stays when there is no least mass.
  void raise(engine::Mass& mass) const;

  /// An angle of the file in rad.
  double angle(double v) const { return degrees_ ? degToRad(v) : v; }
  /// nullopt where no attribute gives one. Throws Error.
  std::optional<Mat3> orientation(Attributes& a) const;
  /// Position and orientation; `frame`: of the `frame` elements around. Throws Error.
  Pose pose(Attributes& a, const Pose& frame) const;
  /// Where a capsule lies, for example, whose two ends are given.
  struct Span {
    Pose pose;  ///< of its middle; z points from the second end to the first, as in MuJoCo
    double length;
  };
  /// nullopt where there is no `fromto`. Throws Error.
  std::optional<Span> fromTo(Attributes& a, const Pose& frame) const;
  /// Whether `range`, the attribute `name`, is a limit: as `flag` says, or because it is there. Throws Error.
  bool limited(Attributes& a, const char* flag, const char* name,
               const std::optional<std::vector<double>>& range) const;

 private:
  bool degrees_ = true;
  bool autolimits_ = true;
  std::string eulerSequence_ = "xyz";
  std::string meshFolder_;
  std::string inertiaFromGeom_ = "auto";
  std::array<int, 2> inertiaGroups_{0, 5};
  double boundMass_ = 0, boundInertia_ = 0;
};

}  // namespace spark::mjcf
