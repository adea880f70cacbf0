#pragma once
/// \file
/// Materials by name.

#include <set>

#include "api/scene.h"

namespace spark {

/// A material of one colour, for viewers.
class MaterialSolid : public Leaf {
  SPARK_CLASS(MaterialSolid, Leaf)
 public:
  static void describe(Description<MaterialSolid>& d);

 private:
  Color ambient_{0.2f, 0.2f, 0.2f, 1}, diffuse_{1, 1, 1, 1}, specular_{0, 0, 0, 1}, emission_{0, 0, 0, 1};
  double shininess_ = 128;
  bool depthCheck_ = true;
};

/// Holds materials by name, as children. At /sys/server/material.
class MaterialServer : public Node {
  SPARK_CLASS(MaterialServer, Node)
 public:
  static void describe(Description<MaterialServer>& d);
  /// Logs a warning, once for each name, when there is no such material; viewers use their default then. `user` is the
  /// node that refers to it.
  void warnUnlessKnown(const std::string& name, const Leaf& user);

 private:
  void define(const std::string& name, Color diffuse);
  void reset();
  std::set<std::string, std::less<>> warned_;  ///< names that were warned about
};

}  // namespace spark
