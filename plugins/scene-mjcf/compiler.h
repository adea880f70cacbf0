#pragma once
/// \file
/// The element `compiler`, and the attributes that are read as it says.

#include <array>

#include "api/math.h"
#include "api/model.h"
#include "robot/document.h"

namespace spark::mjcf {

/// A pair of attributes such as `limited` and `range`. Default classes may set one and elements the other, so both are
/// read first, and checked by Compiler::limit().
struct Limit {
  std::string word = "auto";
  std::optional<std::vector<double>> range;
  /// Reads the attributes `flag` and `name`; what is not there stays. Throws Error.
  void read(Attributes& a, const char* flag, const char* name);
};

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
  /// Poses in the file are world poses.
  bool global() const { return global_; }
  /// Shapes are fitted to the bounds of meshes, not to their inertia.
  bool fitsBounds() const { return fitsBounds_; }
  /// The name of a file as the file system has it.
  std::string fileName(const std::string& name) const;
  /// False: MuJoCo 2.2.2 estimates masses of meshes as if they were convex.
  bool exactMeshInertia() const { return exactMeshInertia_; }
  /// What the masses of all bodies are scaled to [kg]; 0 or less: they stay.
  double totalMass() const { return totalMass_; }
  /// Raises mass and moments of inertia to the least ones of the file; a mass of 0 stays when there is no least mass.
  /// With `balanceinertia`, moments that no body can have become their mean.
  void adjust(engine::Mass& mass) const;

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
  /// The range that `limit`, with the attribute `name`, sets; nullopt if it sets none. Throws Error if a limit has no
  /// valid range; where `a` forgives there is none then, which is named.
  std::optional<std::array<double, 2>> limit(Attributes& a, const char* name, const Limit& limit) const;

 private:
  bool degrees_ = true;
  bool global_ = false;
  bool autolimits_ = true;
  bool exactMeshInertia_ = false, fitsBounds_ = false, stripsPaths_ = false, balances_ = false;
  std::string eulerSequence_ = "xyz";
  std::string meshFolder_;
  std::string inertiaFromGeom_ = "auto";
  std::array<int, 2> inertiaGroups_{0, 5};
  double boundMass_ = 0, boundInertia_ = 0, totalMass_ = 0;
};

}  // namespace spark::mjcf
