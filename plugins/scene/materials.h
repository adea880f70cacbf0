#pragma once
/// \file
/// Materials by name.

#include <set>

#include "api/appearance.h"
#include "api/scene.h"
#include "modified.h"

namespace spark {

/// A material of one colour, for viewers.
class MaterialSolid : public Leaf, public IMaterial {
  SPARK_CLASS(MaterialSolid, Leaf)
 public:
  static void describe(Description<MaterialSolid>& d);
  Look look() const override { return {ambient_, diffuse_, specular_, emission_, shininess_}; }
  const std::string& texture() const override { return texture_; }

 protected:
  void setTexture(const std::string& name) { setShown(*this, texture_, name); }

 private:
  template <class T, T MaterialSolid::*kPart>
  const T& shown() const {
    return this->*kPart;
  }
  template <class T, T MaterialSolid::*kPart>
  void show(const T& value) {
    setShown(*this, this->*kPart, value);
  }
  std::string texture_;
  Color ambient_{0.2f, 0.2f, 0.2f, 1}, diffuse_{1, 1, 1, 1}, specular_{0, 0, 0, 1}, emission_{0, 0, 0, 1};
  double shininess_ = 128;
  bool depthCheck_ = true;
};

/// A material with a picture on it, for viewers.
class Material2DTexture : public MaterialSolid {
  SPARK_CLASS(Material2DTexture, MaterialSolid)
 public:
  static void describe(Description<Material2DTexture>& d);
};

/// Holds materials by name, as children. At /sys/server/material.
class MaterialServer : public Node {
  SPARK_CLASS(MaterialServer, Node)
 public:
  static void describe(Description<MaterialServer>& d);
  /// Logs a warning, once for each name, when there is no such material; viewers use their default then. `user` is the
  /// node that refers to it. A name that says its colour, such as "rgb22bb22", is defined.
  void warnUnlessKnown(const std::string& name, const Leaf& user);

 private:
  void define(const std::string& name, Color diffuse);
  void reset();
  std::set<std::string, std::less<>> warned_;  ///< names that were warned about
};

}  // namespace spark
