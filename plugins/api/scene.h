#pragma once
/// \file
/// The scene: the base of scene nodes, transforms, the interface of visual nodes, and the scene server.

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
  SPARK_INTERFACE(ISceneServer, 4);
  static constexpr const char* kPath = "/sys/server/scene";
  /// The path of the active scene by default, and without a scene server.
  static constexpr const char* kDefaultScene = "/usr/scene";
  virtual ~ISceneServer() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Root of the active scene (class Scene); nullptr when there is none.
  virtual Node* activeScene() = 0;
  /// Root of the active scene. Throws Error when there is none.
  virtual Node& scene() = 0;
  /// Imports a file below `root` with the first importer that recognises its format. Throws Error with
  /// file:line:column; the tree then is as before, unless the language keeps what was made before the error
  /// (ISceneImporter::transactional).
  virtual void importScene(std::string_view file, Node& root, const List& arguments) = 0;
  /// Importers call it before they change the name, properties or pose of a node that may be older than the import: if
  /// the import is undone, the node gets them back.
  virtual void willChange(Leaf&) {}
  /// Importers call it before they remove a node that may be older than the import. Throws Error if it is and the
  /// import can be undone: what is removed cannot be brought back.
  virtual void willRemove(Leaf&) {}
  /// A file that was imported, and the objects that came with it.
  struct Import {
    std::string file;
    Ref<Node> root;  ///< below which it was imported
    List arguments;
    std::uint64_t first = 0, last = 0;  ///< Leaf::id of the first and of the last object
  };
  /// The imports of which something may still be there, in their order, without those that a file made.
  virtual const std::vector<Import>& imports() const = 0;
  /// Counts a change of nodes or materials, for monitors and caches.
  virtual void markModified() = 0;
  /// Number of such changes so far.
  virtual std::uint64_t modifiedCount() const = 0;
  /// Updates the world matrices of the active scene, top-down. Bodies and static colliders below transforms that were
  /// moved by hand follow.
  virtual void place() = 0;
  /// The same for a scene that need not be the active one.
  virtual void placeScene(Node& scene) = 0;
};

/// An importer of a scene format. A child of the scene server.
class ISceneImporter {
 public:
  SPARK_INTERFACE(ISceneImporter, 3);
  virtual ~ISceneImporter() = default;
  /// True when `text` is in the format of this importer, judged by its beginning, or by the name `file` of the resource
  /// where the beginning is in no known format. The scene server passes "" as `file` until every importer has seen the
  /// text, so that a name never outweighs what the text says.
  virtual bool recognises(std::string_view text, std::string_view file) const = 0;
  /// Creates the nodes of the file below `root`. `arguments` are those of the file's template. Throws Error.
  virtual void import(std::string_view file, Node& root, const List& arguments) = 0;
  /// True: when the import of a file with this text fails, the scene server removes all nodes that it created. False:
  /// they stay, as in the installed base. SceneServer::transactionalImport overrides it.
  virtual bool transactional(std::string_view /*text*/) const { return true; }
  /// True: all transforms that a file with this text creates are kept. False: the scene server removes those that are
  /// empty or contain only transforms, as the installed base does.
  virtual bool keepsTransforms(std::string_view /*text*/) const { return false; }
};

/// A named group of variables, which scene files read as `Name.variable`. A child of /sys/variables.
class IVariables {
 public:
  SPARK_INTERFACE(IVariables, 1);
  /// The folder of all groups.
  static constexpr const char* kFolder = "/sys/variables";
  virtual ~IVariables() = default;
  /// The value of a variable; nil when there is none. "" is the value of the group itself.
  virtual Value variable(std::string_view name) const = 0;
};

/// Base of all nodes of a scene; its class name is BaseNode. Registered by `scene`.
class SceneNode : public Node {
 public:
  static constexpr const char* kClassName = "BaseNode";
  using ClassSelf = SceneNode;
  using ClassBase = Node;
  static constexpr InterfaceId kInterface{"BaseNode", 1};

  static void describe(Description<SceneNode>& d);
  /// The nearest transform above; nullptr when there is none.
  Transform* transform() const { return transform_.get(); }
  /// Imports a scene file below this node. Throws Error: see ISceneServer::importScene().
  void importScene(const std::string& file, const std::vector<Value>& arguments) {
    kernel().root().require<ISceneServer>().importScene(file, *this, arguments);
  }

 private:
  Link<Transform, true> transform_;
};

/// A coordinate frame for the nodes below it. It has a local matrix, relative to the transform above, and a world
/// matrix, which the place phase updates. Registered by `scene`.
class Transform : public SceneNode {
  SPARK_CLASS(Transform, SceneNode)
 public:
  static void describe(Description<Transform>& d) {
    d.doc("Positions the nodes below it.");
    d.property("localTransform", &Transform::local, &Transform::placeLocal)
        .savedByClass()
        .doc("Local 4x4 matrix, column-major; each element from -1e9 to 1e9.");
    d.property("localPos", &Transform::localPos, &Transform::placeLocalPos)
        .unit("m")
        .savedByClass()
        .doc("Local translation; each coordinate from -1e9 to 1e9 m.");
    d.property("worldTransform", &Transform::world).doc("World 4x4 matrix as of the last place phase.");
    d.method("setLocalRotation", &Transform::turnLocal)
        .parameters({"x [deg]", "y [deg]", "z [deg]"})
        .doc("Sets the rotation R = Rx Ry Rz and keeps the translation.");
    d.alias("SLT", "setLocalTransform");
  }

  /// Largest magnitude of numbers that scripts and scene files may set [m; deg]. At this distance the spacing of
  /// single-precision numbers is 64 m.
  static constexpr float kMaxMagnitude = 1e9f;

  /// Matrix relative to the transform above.
  const Matrix& local() const { return local_; }
  /// World matrix as of the last place phase.
  const Matrix& world() const { return world_; }
  /// Translation of local() [m].
  Vec3f localPos() const { return positionOf(local_); }
  /// Moves the transform by hand: bodies below follow before the next step.
  void setLocal(const Matrix& m) {
    local_ = m;
    movedByHand();
  }
  /// Sets the translation [m] by hand.
  void setLocalPos(const Vec3f& p) {
    local_.block<3, 1>(0, 3) = p;
    movedByHand();
  }
  /// Sets the rotation R = Rx Ry Rz by hand and keeps the translation.
  void setLocalRotationDeg(float x, float y, float z) {
    const Vec3f p = positionOf(local_);
    local_ = rotationDeg(x, y, z);
    local_.block<3, 1>(0, 3) = p;
    movedByHand();
  }
  /// Moves the transform with its body, in the place phase: bodies below do not follow.
  void setLocalFromBody(const Matrix& m) {
    local_ = m;
    dirty_ = true;
  }
  /// The world matrix, computed now from all local matrices above. For set-up and trainer commands; the step reads
  /// world().
  Matrix worldNow() const { return transform() ? Matrix(transform()->worldNow() * local_) : local_; }
  /// Updates the world matrix from that of the transform above; called by the scene server, top-down. Returns true when
  /// this transform was moved by hand since the last call, or when `aboveMoved`.
  bool updateWorld(bool aboveMoved) {
    world_ = transform() ? Matrix(transform()->world_ * local_) : local_;
    const bool moved = moved_ || aboveMoved;
    moved_ = dirty_ = false;
    return moved;
  }
  /// True when the transform was moved by hand since the last update.
  bool movedSincePlace() const { return moved_; }
  /// Restores movedSincePlace() after a movement by hand was taken back.
  void setMovedSincePlace(bool moved) { moved_ = moved; }
  /// True when the local matrix changed, by hand or by a body, since the last update.
  bool dirty() const { return dirty_; }

 protected:
  void onLink() override { world_ = worldNow(); }
  /// The local matrix is state. A restored matrix does not move the bodies below: they restore their own poses.
  void saveState(StateWriter& out) const override {
    for (int i = 0; i < 16; ++i) out.write(double(local_.data()[i]));
    out.write(moved_);
  }
  void loadState(StateReader& in) override {
    for (int i = 0; i < 16; ++i) local_.data()[i] = static_cast<float>(in.readNumber());
    moved_ = in.readBool();
    dirty_ = true;
    // Parents are loaded first. The prepare phase reads the world matrix before the place phase updates it.
    world_ = transform() ? Matrix(transform()->world_ * local_) : local_;
  }

 private:
  /// Returns `numbers`. Throws RefusedValue unless they are finite and within kMaxMagnitude.
  template <class M>
  static const M& checked(const M& numbers, const char* what) {
    if (!(numbers.cwiseAbs().maxCoeff() <= kMaxMagnitude) || !numbers.allFinite())
      throwOutOfRange(what, numbers.data(), static_cast<int>(numbers.size()));
    return numbers;
  }
  [[noreturn]] static void throwOutOfRange(const char* what, const float* numbers, int n) {
    std::string found;
    for (int i = 0; i < n; ++i) found += (i > 0 ? " " : "") + Value(double(numbers[i])).text();
    throw RefusedValue(fmt::format("expected {} of finite numbers from -1e9 to 1e9, found {}", what, found));
  }
  void placeLocal(const Matrix& m) { setLocal(checked(m, "a matrix")); }
  void placeLocalPos(const Vec3f& p) { setLocalPos(checked(p, "a position")); }
  void turnLocal(float x, float y, float z) {
    checked(Vec3f(x, y, z), "angles");
    setLocalRotationDeg(x, y, z);
  }
  /// Marks the transform as moved by hand. A linked one updates its world matrix at once.
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
      .doc("Imports a scene file below this node; the arguments bind to the parameters of its template.");
}

/// A node that follows when a transform above it is moved by hand: a body or a static collider.
class IFollowsTransform {
 public:
  SPARK_INTERFACE(IFollowsTransform, 1);
  virtual ~IFollowsTransform() = default;
  /// Called by ISceneServer::place(), top-down, when the nearest transform or one above it was moved by hand. `world`
  /// is the new world matrix of the nearest transform.
  virtual void follow(const Matrix& world) = 0;
};

/// A visual node, for monitors. Offered by Light, StaticMesh, Box, Sphere, ...
class IVisual {
 public:
  SPARK_INTERFACE(IVisual, 1);
  virtual ~IVisual() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  enum class Kind { light, mesh, singleMaterial };
  virtual Kind kind() const = 0;
  /// Mesh name with parameters: `models/x.obj` or `StdCapsule 0.1 0.2`. "" for lights.
  virtual const std::string& load() const = 0;
  /// Scale along the three axes of its transform.
  virtual Vec3f scale() const = 0;
  virtual bool visible() const = 0;
  virtual void setVisible(bool on) = 0;
  /// True: viewers use the opacity of its materials.
  virtual bool transparent() const = 0;
  /// Material names, in the mesh's order: alphabetical by the mesh's own names.
  virtual const std::vector<std::string>& materials() const = 0;
  /// Replaces material `i` and marks the scene modified. Ignored when there is no such material.
  virtual void setMaterialName(std::size_t i, std::string name) = 0;
  /// Diffuse, ambient and specular colour of a light.
  virtual std::array<Color, 3> lightColors() const { return {}; }
};

/// True if `node` is `above` or below it.
inline bool isBelow(const Leaf& node, const Node& above) {
  const Leaf* up = &node;
  while (up && up != &above) up = up->parent();
  return up != nullptr;
}

}  // namespace spark
