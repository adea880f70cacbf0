#pragma once
/// \file
/// Lights, meshes and cameras, for viewers. The simulation only stores their values.

#include "api/scene.h"
#include "api/scene_calls.h"
#include "modified.h"

namespace spark {

/// A light source at its transform.
class Light : public SceneNode, public IVisual {
  SPARK_CLASS(Light, SceneNode)
 public:
  static void describe(Description<Light>& d);
  Leaf& leaf() override { return *this; }
  Kind kind() const override { return Kind::light; }
  const std::string& load() const override { return nothing_; }
  Vec3f scale() const override { return {1, 1, 1}; }
  bool visible() const override { return true; }
  void setVisible(bool) override {}
  bool transparent() const override { return false; }
  const std::vector<std::string>& materials() const override { return none_; }
  void setMaterialName(std::size_t, std::string) override {}
  std::array<Color, 3> lightColors() const override { return {diffuse_, ambient_, specular_}; }

 private:
  template <Color Light::*kPart>
  const Color& color() const {
    return this->*kPart;
  }
  template <Color Light::*kPart>
  void setColor(const Color& color) {
    setShown(*this, this->*kPart, color);
  }
  Color diffuse_{1, 1, 1, 1}, ambient_{0, 0, 0, 1}, specular_{1, 1, 1, 1};
  double radius_ = 1000;
  // Empty results of load() and materials().
  std::string nothing_;
  std::vector<std::string> none_;
};

/// A view of the scene.
class Camera : public SceneNode {
  SPARK_CLASS(Camera, SceneNode)
 public:
  static void describe(Description<Camera>& d);

 private:
  void setViewport(int x, int y, int width, int height) { x_ = x, y_ = y, width_ = width, height_ = height; }
  void adjustZNear(double by) { zNear_ += by; }
  void adjustZFar(double by) { zFar_ += by; }
  int x_ = 0, y_ = 0, width_ = 640, height_ = 480;
  double fovDeg_ = 60, zNear_ = 0.1, zFar_ = 1000;
  Vec3 lookAt_ = Vec3::Zero();
};

/// A visible coordinate frame at its transform.
class Axis : public SceneNode {
  SPARK_CLASS(Axis, SceneNode)
 public:
  static void describe(Description<Axis>& d);

 private:
  double size_ = 1;
};

/// Base of all visible shapes.
class RenderNode : public SceneNode {
  SPARK_CLASS(RenderNode, SceneNode)
 public:
  static void describe(Description<RenderNode>& d);
  bool isVisible() const { return visible_; }
  /// Shows or hides the shape. Monitors send this without a full message.
  void show(bool on) { visible_ = on; }
  bool isTransparent() const { return transparent_; }

 private:
  void setVisibleValue(Value v);
  void setTransparent() { transparent_ = true; }
  bool visible_ = true, transparent_ = false;
};

/// A mesh by name, with the materials of its face groups.
class StaticMesh : public RenderNode, public IVisual, public ISceneCalls {
  SPARK_CLASS(StaticMesh, RenderNode)
 public:
  static void describe(Description<StaticMesh>& d);
  Leaf& leaf() override { return *this; }
  Kind kind() const override { return Kind::mesh; }
  const std::string& load() const override { return load_; }
  Vec3f scale() const override { return scale_; }
  bool visible() const override { return isVisible(); }
  void setVisible(bool on) override { show(on); }
  bool transparent() const override { return isTransparent(); }
  const std::vector<std::string>& materials() const override { return materials_; }
  void setMaterialName(std::size_t i, std::string name) override;
  std::vector<SceneCall> sceneCalls() const override;

 protected:
  /// Sets the mesh: its name and parameters as monitors send them.
  void loadMesh(std::string load);
  /// Scale, materials and transparency as calls.
  std::vector<SceneCall> callsBesideMesh() const;
  /// Called when the mesh changed: takes over its materials.
  virtual void meshChanged();
  void setScale(const Vec3f& scale);
  /// Replaces all materials. Logs a warning for unknown names.
  void resetMaterials(std::vector<std::string> names);
  /// Materials are state: robots get the colours of their team while the simulation runs.
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void loadCall(std::string mesh, const std::vector<Value>& parameters);
  std::string load_, externalMesh_;
  Vec3f scale_{1, 1, 1}, externalScale_{1, 1, 1};
  bool castShadows_ = true, useExternalMesh_ = false;
  std::vector<std::string> materials_;
};

/// A mesh with one material.
class SingleMatNode : public StaticMesh {
  SPARK_CLASS(SingleMatNode, StaticMesh)
 public:
  static void describe(Description<SingleMatNode>& d);
  Kind kind() const override { return Kind::singleMaterial; }

 protected:
  void meshChanged() override {}

 private:
  void setMaterial(std::string name) { resetMaterials({std::move(name)}); }
};

/// A box; its extents are its scale.
class Box : public SingleMatNode {
  SPARK_CLASS(Box, SingleMatNode)
 public:
  Box() { loadMesh("StdUnitBox"); }
  static void describe(Description<Box>& d);
};

/// A sphere; its radius is its scale.
class Sphere : public SingleMatNode {
  SPARK_CLASS(Sphere, SingleMatNode)
 public:
  Sphere() { loadMesh("StdUnitSphere"); }
  static void describe(Description<Sphere>& d);
  std::vector<std::string_view> setByCalls() const override { return {"radius"}; }

 private:
  double radius() const { return scale().x(); }
  void setRadius(double r) { setScale(Vec3f::Constant(static_cast<float>(r))); }
};

/// A capsule along z: a cylinder with a half sphere at each end.
class Capsule : public SingleMatNode {
  SPARK_CLASS(Capsule, SingleMatNode)
 public:
  Capsule() { setParams(1, 1); }
  static void describe(Description<Capsule>& d);
  std::vector<SceneCall> sceneCalls() const override;

 private:
  void setParams(float radius, float length);
  float radius_ = 1, length_ = 1;
};

/// A cylinder along z.
class Cylinder : public SingleMatNode {
  SPARK_CLASS(Cylinder, SingleMatNode)
 public:
  Cylinder() { setParams(1, 1); }
  static void describe(Description<Cylinder>& d);
  std::vector<SceneCall> sceneCalls() const override;

 private:
  void setParams(float radius, float length);
  float radius_ = 1, length_ = 1;
};

}  // namespace spark
