#pragma once
/// \file
/// The importer of URDF, the robot description language of ROS.

#include "api/scene.h"

namespace spark {

/// Creates nodes from URDF files. See README.md.
class UrdfImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(UrdfImporter, Leaf)
 public:
  static void describe(Description<UrdfImporter>& d);

  bool recognises(std::string_view text, std::string_view file) const override;
  /// Arguments: none, or a prefix for the names of all nodes but perceptors and effectors, and "fixed" or "free" for
  /// the root link. Throws Error with file:line:column; the tree is then as before.
  void import(std::string_view file, Node& root, const List& arguments) override;
  bool keepsTransforms(std::string_view) const override { return true; }

 private:
  bool strict_ = false, selfCollide_ = false;
};

}  // namespace spark
