#pragma once
/// \file
/// The importer of Webots worlds and PROTO files.

#include "api/scene.h"

namespace spark {

/// Creates nodes from Webots files. See README.md.
class WebotsImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(WebotsImporter, Leaf)
 public:
  static void describe(Description<WebotsImporter>& d);

  bool recognises(std::string_view text, std::string_view file) const override;
  /// Arguments: none, or a prefix for the names of all nodes but perceptors and effectors, and "fixed" or "free" for
  /// robots. Throws Error with file:line:column; the tree is then as before.
  void import(std::string_view file, Node& root, const List& arguments) override;
  bool keepsTransforms(std::string_view) const override { return true; }

 private:
  bool strict_ = false;
  std::vector<std::string> folders_;
};

}  // namespace spark
