#pragma once
/// \file
/// The importer of MJCF, MuJoCo's language of models.

#include "api/scene.h"
#include "robot/model.h"

namespace spark {

/// Creates nodes from MJCF files. See README.md.
class MjcfImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(MjcfImporter, Leaf)
 public:
  static void describe(Description<MjcfImporter>& d);

  bool recognises(std::string_view text, std::string_view file) const override;
  /// Arguments: none, or a prefix for the names of all nodes but perceptors and effectors. Throws Error with
  /// file:line:column; the tree is then as before.
  void import(std::string_view file, Node& root, const List& arguments) override;
  bool keepsTransforms(std::string_view) const override { return true; }

 private:
  bool strict_ = false;
  std::int64_t imports_ = 0;
};

}  // namespace spark
