#pragma once
/// \file
/// Colliders: geometry that touches, with collision handlers as children.

#include "collision_group.h"
#include "rigid_body.h"

namespace spark {

/// Base of colliders. Belongs to the RigidBody that stands before it among its siblings; without one it is static,
/// where its nearest transform is. A collider inside a TransformCollider is part of that.
class Collider : public PhysicsObject, public ICollider, public IFollowsTransform {
  SPARK_CLASS(Collider, PhysicsObject)
 public:
  /// What a contact needs to know of a collider; made anew when the tree's shape changed.
  struct Handlers {
    const CollisionHandler* contact = nullptr;  ///< the first child with a surface
    bool fallback = false;                      ///< no handler at all: the bouncy default
    std::vector<CollisionHandler*> active;      ///< those that want to hear of contacts
  };

  static void describe(Description<Collider>& d);
  Leaf& leaf() override { return *this; }
  IRigidBody* body() const override { return body_.get(); }
  void bounds(Vec3& low, Vec3& high) const override;
  std::optional<engine::ShapeDescription> shape() const override { return std::nullopt; }
  /// Half of the shape's extent along the world's axes when it is turned so [m]; nothing for shapes that are not alike
  /// on both sides.
  virtual std::optional<Vec3> halfExtent(const Mat3&) const { return std::nullopt; }
  Pose poseInTransform() const override { return offset(); }
  void follow(const Matrix& world) override;

  /// As of the last change of the tree.
  const Handlers& handlers() const { return handlers_; }
  /// As of the last change of the tree: the answers for each close pair of a step.
  bool solid() const { return solid_; }
  bool listens() const { return listens_; }
  bool hasBody() const { return hasBody_; }
  /// Looks at the children again. `defaultOnTransform`: a TransformCollider without a handler of its own gets the
  /// default one.
  void refreshHandlers(bool defaultOnTransform);
  /// False when the two are told not to collide: same space, and one names the other; or one is in a detached group.
  bool mayCollideWith(const Collider& other) const;
  /// The innermost group around it; nullptr: none. As of the last change of the tree.
  void setGroup(const CollisionGroup* group) { group_ = group; }
  /// The body's centre of mass moved: a part of a TransformCollider stays where it is.
  void shift(const Vec3& by);

 protected:
  void onLink() override;
  void onMoved() override;
  void onUnlink() override;
  /// After a change of shape. Throws Error when the engine refuses it.
  void reshape();
  /// Sets what the shape is made of; it stays as it was when the engine refuses the new one.
  template <class T>
  void change(T& member, T value) {
    std::swap(member, value);
    try {
      reshape();
    } catch (...) {
      std::swap(member, value);
      throw;
    }
  }
  engine::IEngine* engine() const { return space_ ? space_->world()->engine() : nullptr; }
  /// Of the shape in the world.
  Pose geomPose() const;
  /// Colliders among its children, looked up again when something changed below.
  const std::vector<const Collider*>& inner() const;
  /// A point in the frame of the nearest transform, seen from the shape's own frame.
  Vec3 toShape(const Vec3& p) const;
  const std::vector<std::string>& notCollideWith() const { return notCollideWith_; }

 private:
  /// The collider that is reported in contacts: the outermost around it.
  Collider& outermost();
  Pose offset() const { return outer_ ? physics::compose(outer_->offset(), local_) : local_; }
  /// Puts the geom, and those of the colliders inside, where it belongs; static ones relative to `base`.
  void attach(const Pose& base);
  void dropGeom();
  void findHandlers(bool defaultOnTransform);
  void attach() { attach(body_ ? Pose{} : physics::frameOf(*this)); }
  void setPosition(const Vec3& p);
  void setLocalPosition(const Vec3& p);
  void setRotation(std::vector<double> matrix);
  void addCollisionHandler(std::string className);
  void addNotCollideWithColliderName(std::string name, bool on);
  bool isStaticInWorld() const { return !outer_ && !body_; }

  std::shared_ptr<physics::SpaceHandle> space_;
  engine::Geom geom_{};
  Ref<RigidBody> body_;
  const CollisionGroup* group_ = nullptr;
  Collider* outer_ = nullptr;  ///< the TransformCollider it is part of
  Pose local_;                 ///< in the frame of body, transform or outer collider
  bool solid_ = false, listens_ = false, hasBody_ = false;
  Handlers handlers_;
  std::vector<std::string> notCollideWith_;
  mutable std::vector<const Collider*> inner_;
  mutable std::uint64_t innerAt_ = 0;
};

/// The surface of colliders that have no handler: bouncy.
const engine::Surface& defaultSurface();

}  // namespace spark
