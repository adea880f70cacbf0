#pragma once
/// \file
/// The importer of what programs for 3D models write.

#include "api/scene.h"

namespace spark {

/// Creates nodes from files of 3D models: OBJ, glTF, COLLADA, STL, PLY and others. See README.md.
class MeshImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(MeshImporter, Leaf)
 public:
  static void describe(Description<MeshImporter>& d);

  /// By the name of the file alone: what such files begin with is of too many kinds.
  bool recognises(std::string_view text, std::string_view file) const override;
  /// Arguments: none, or a scale (one number, or three), then "shown" where it shall not collide. Throws Error, also
  /// if the file has no triangle; the tree is then as before.
  void import(std::string_view file, Node& root, const List& arguments) override;
  bool keepsTransforms(std::string_view) const override { return true; }
};

}  // namespace spark
