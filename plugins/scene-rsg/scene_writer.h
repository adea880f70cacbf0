#pragma once
/// \file
/// The writer of scene files.

#include "api/scene_calls.h"
#include "spark/class_object.h"
#include "spark/node.h"

namespace spark {

/// Writes nodes as a scene file of version 0.2, from which the importer makes the same nodes again: their classes,
/// names and order, the calls that they need (ISceneCalls), and all properties that can be set and are not as in a new
/// node.
class SceneWriter : public Leaf {
  SPARK_CLASS(SceneWriter, Leaf)
 public:
  static void describe(Description<SceneWriter>& d);
  /// The file with all that is below the node at `path`. Throws Error, with node and property, for what the language
  /// cannot express.
  std::string text(const std::string& path);

 private:
  void writeNode(const Leaf& node, int depth, std::string& out);
  void writeProperties(const Leaf& node, const std::string& indent, std::string& out);
};

}  // namespace spark
