#pragma once
/// \file
/// The scene: base of scene nodes, transforms, what a monitor sees of a visual node, and the scene server's services.

#include "api/math.h"
#include "spark/abi/api/scene.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/node.h"
#include "spark/state.h"

namespace spark {

class Transform;
class SceneNode;

/// The scene server, at /sys/server/scene. The active scene is /usr/scene unless set otherwise.
class ISceneServer {
 public:
  SPARK_INTERFACE(ISceneServer, 2);
  static constexpr const char* kPath = "/sys/server/scene";
  virtual ~ISceneServer() = default;
  virtual Leaf& leaf() = 0;
  /// Root of the active scene (class Scene); nullptr when there is none.
  virtual Node* activeScene() = 0;
  /// The same; throws Error when there is none.
  virtual Node& scene() = 0;
  /// Imports a file below `root` through the first importer that knows it. Throws Error with file:line:column; see the
  /// importer for what stays in the tree.
  virtual void importScene(std::string_view file, Node& root, const List& arguments) = 0;
  /// Tells monitors and caches that nodes or materials changed (counted).
  virtual void markModified() = 0;
  virtual std::uint64_t modifiedCount() const = 0;
  /// Brings world matrices up to date, top-down, and lets bodies below hand-moved transforms follow.
  virtual void place() = 0;
};

/// An importer, child of the scene server.
class ISceneImporter {
 public:
  SPARK_INTERFACE(ISceneImporter, 1);
  virtual ~ISceneImporter() = default;
  /// True when the text looks like this importer's format.
  virtual bool recognises(std::string_view text) const = 0;
  /// Builds the file's nodes below `root`. Throws Error.
  virtual void import(std::string_view file, Node& root, const List& arguments) = 0;
};

/// A named group of variables that scene files may read as `Name.variable`; a child of /sys/variables.
class IVariables {
 public:
  SPARK_INTERFACE(IVariables, 1);
  virtual ~IVariables() = default;
  /// The variable's value, nil when there is none.
  virtual Value variable(std::string_view name) const = 0;
};

/// Base of all nodes of a scene (scene files call it BaseNode). Registered by `scene`.
class SceneNode : public Node {
 public:
  static constexpr const char* kClassName = "BaseNode";
  using ClassSelf = SceneNode;
  using ClassBase = Node;
  static constexpr InterfaceId kInterface{"BaseNode", 1};

  static void describe(Description<SceneNode>& d);
  /// The nearest transform above, nullptr at the scene's root.
  Transform* transform() const { return transform_.get(); }
  void importScene(std::string file, std::vector<Value> arguments) {
    kernel().root().require<ISceneServer>().importScene(file, *this, arguments);
  }

 private:
  Link<Transform, true> transform_;
};

/// Places what is below it. Local and world matrix; the world matrix is brought up to date in the place phase and by
/// worldNow(). Registered by `scene`.
class Transform : public SceneNode {
  SPARK_CLASS(Transform, SceneNode)
 public:
  static void describe(Description<Transform>& d) {
    d.doc("Places what is below it.");
    d.property("localTransform", &Transform::local, &Transform::placeLocal)
        .doc("Local 4x4 matrix, column-major; all its numbers within 1e9.");
    d.property("localPos", &Transform::localPos, &Transform::placeLocalPos)
        .unit("m")
        .doc("Local translation, within 1e9 m.");
    d.property("worldTransform", &Transform::world).doc("World 4x4 matrix as of the last place phase.");
    d.method("setLocalRotation", &Transform::turnLocal)
        .parameters({"x [deg]", "y [deg]", "z [deg]"})
        .doc("R = Rx Ry Rz; the translation is kept.");
    d.alias("SLT", "setLocalTransform");
  }

  /// What scripts and scene files may set: numbers of no greater magnitude [m; degrees]. Farther out single precision
  /// resolves 64 m.
  static constexpr float kFarthest = 1e9f;

  const Matrix& local() const { return local_; }
  const Matrix& world() const { return world_; }
  Vec3f localPos() const { return positionOf(local_); }
  /// By hand: bodies below follow before the next physics phase.
  void setLocal(const Matrix& m) {
    local_ = m;
    movedByHand();
  }
  void setLocalPos(const Vec3f& p) {
    local_.block<3, 1>(0, 3) = p;
    movedByHand();
  }
  void setLocalRotationDeg(float x, float y, float z) {
    const Vec3f p = positionOf(local_);
    local_ = rotationDeg(x, y, z);
    local_.block<3, 1>(0, 3) = p;
    movedByHand();
  }
  /// From a body in the place phase: nothing follows.
  void setLocalFromBody(const Matrix& m) {
    local_ = m;
    dirty_ = true;
  }
  /// The world matrix from all locals above, computed now (set-up and trainer commands; the step reads world()).
  Matrix worldNow() const { return transform() ? Matrix(transform()->worldNow() * local_) : local_; }
  /// For the scene server's place: world := above * local. True when moved by hand since the last call or when told
  /// that above was.
  bool updateWorld(bool aboveMoved) {
    world_ = transform() ? Matrix(transform()->world_ * local_) : local_;
    const bool moved = moved_ || aboveMoved;
    moved_ = dirty_ = false;
    return moved;
  }
  bool movedSincePlace() const { return moved_; }
  /// True when the local matrix changed, by hand or by a body, since the last place.
  bool dirty() const { return dirty_; }

 protected:
  void onLink() override { world_ = worldNow(); }
  /// The local matrix is state; a restored one does not pull bodies along, they are restored themselves.
  void saveState(StateWriter& out) const override {
    for (int i = 0; i < 16; ++i) out.write(double(local_.data()[i]));
    out.write(moved_);
  }
  void loadState(StateReader& in) override {
    for (int i = 0; i < 16; ++i) local_.data()[i] = static_cast<float>(in.readNumber());
    moved_ = in.readBool();
    dirty_ = true;
    world_ = transform() ? Matrix(transform()->world_ * local_)
                         : local_;  // parents are loaded first; prepare reads it before place
  }

 private:
  /// Throws RefusedValue unless the numbers are finite and within kFarthest.
  template <class M>
  static const M& sane(const M& numbers, const char* what) {
    if (!(numbers.cwiseAbs().maxCoeff() <= kFarthest) || !numbers.allFinite())
      throwAbsurd(what, numbers.data(), static_cast<int>(numbers.size()));
    return numbers;
  }
  [[noreturn]] static void throwAbsurd(const char* what, const float* numbers, int n) {
    std::string found;
    for (int i = 0; i < n; ++i) found += (i > 0 ? " " : "") + Value(double(numbers[i])).text();
    throw RefusedValue(std::string("expected ") + what + " of finite numbers from -1e9 to 1e9, found " + found);
  }
  void placeLocal(const Matrix& m) { setLocal(sane(m, "a matrix")); }
  void placeLocalPos(const Vec3f& p) { setLocalPos(sane(p, "a position")); }
  void turnLocal(float x, float y, float z) {
    sane(Vec3f(x, y, z), "angles");
    setLocalRotationDeg(x, y, z);
  }
  void movedByHand() {
    moved_ = dirty_ = true;
    if (isLinked()) world_ = worldNow();
  }
  Matrix local_ = Matrix::Identity(), world_ = Matrix::Identity();
  bool moved_ = false, dirty_ = true;
};

inline void SceneNode::describe(Description<SceneNode>& d) {
  d.doc("Base of all scene nodes.");
  d.link(&SceneNode::transform_, Above<Transform>());
  d.method("importScene", &SceneNode::importScene)
      .parameters({"file", "arguments"})
      .doc("Imports a scene file below this node; the arguments bind to its template.");
}

/// What follows when a transform above it is moved by hand: bodies (and static colliders).
class IFollowsTransform {
 public:
  SPARK_INTERFACE(IFollowsTransform, 1);
  virtual ~IFollowsTransform() = default;
  /// The nearest transform's world matrix changed by hand; called top-down by place().
  virtual void follow(const Matrix& world) = 0;
};

/// What monitors print of a visual node. Registered classes that have it: Light, StaticMesh, Box, Sphere, ...
class IVisual {
 public:
  SPARK_INTERFACE(IVisual, 1);
  virtual ~IVisual() = default;
  virtual Leaf& leaf() = 0;
  enum class Kind { light, mesh, singleMaterial };
  virtual Kind kind() const = 0;
  /// Mesh name with parameters: `models/x.obj` or `StdCapsule 0.1 0.2`. "" for lights.
  virtual const std::string& load() const = 0;
  virtual Vec3f scale() const = 0;
  virtual bool visible() const = 0;
  virtual void setVisible(bool on) = 0;
  virtual bool transparent() const = 0;
  /// Material names, in the mesh's order (alphabetical by the mesh's own names).
  virtual const std::vector<std::string>& materials() const = 0;
  /// Replaces material number i and marks the scene modified.
  virtual void setMaterialName(std::size_t i, std::string name) = 0;
  /// Diffuse, ambient, specular of a light.
  virtual std::array<Color, 3> lightColors() const { return {}; }
};

}  // namespace spark
