#pragma once
/// \file
/// Colliders: collision geometry, with collision handlers as children.

#include "collision_group.h"
#include "rigid_body.h"

namespace spark {

/// Base of colliders. A collider moves with the RigidBody before it among its siblings; without one it is static, at
/// the pose of its nearest transform. A collider inside a TransformCollider is part of that one.
class Collider : public PhysicsObject,
                 public ICollider,
                 public IFollowsTransform,
                 public engine::IExtended,
                 public ISceneCalls {
  SPARK_CLASS(Collider, PhysicsObject)
 public:
  /// The collision handlers of a collider; collected again when the shape of the tree changed.
  struct Handlers {
    const CollisionHandler* contact = nullptr;  ///< the first handler with a surface
    bool fallback = false;                      ///< there is no handler: defaultSurface() applies
    std::vector<CollisionHandler*> active;      ///< handlers to call for each contact point
  };

  static void describe(Description<Collider>& d);
  Leaf& leaf() override { return *this; }
  std::uint64_t identity() const override;
  IRigidBody* body() const override { return body_.get(); }
  void bounds(Vec3& low, Vec3& high) const override;
  std::optional<engine::ShapeDescription> shape() const override { return std::nullopt; }
  /// Half of the shape's extent along the world axes when it has the rotation `rotation` [m]; nullopt for shapes that
  /// are not symmetric about their origin.
  virtual std::optional<Vec3> halfExtent(const Mat3& /*rotation*/) const { return std::nullopt; }
  Pose poseInTransform() const override { return offset(); }
  void follow(const Matrix& world) override;
  /// Pose, and names of colliders; derived classes add their shape where no property has it.
  std::vector<SceneCall> sceneCalls() const override;
  void setBlock(const engine::Block& block) override;
  void removeBlock(std::uint64_t kind) override;

  /// As of the last refreshHandlers().
  const Handlers& handlers() const { return handlers_; }
  /// Of two colliders that touch the surface of that with the higher one counts alone.
  int priority() const { return priority_; }
  /// As of the last refreshHandlers(): contacts can be solid. Cached, because the pair filter runs for each close pair.
  bool solid() const { return solid_; }
  /// As of the last refreshHandlers(): it has active handlers.
  bool listens() const { return listens_; }
  /// As of the last refreshHandlers(): it is not static.
  bool hasBody() const { return hasBody_; }
  /// Collects the handlers among the children. `defaultOnTransform`: a TransformCollider without a handler of its own
  /// gets the default surface; false: it takes over the handlers of its inner collider.
  void refreshHandlers(bool defaultOnTransform);
  /// False when collisions of the two are excluded: no bit of one's kinds is in the other's affinities (unless they are
  /// in the same space and one asks for the other by name), they are in the same space and one excludes the other by
  /// name, or one is in a detached group that the other is not in.
  bool mayCollideWith(const Collider& other) const;
  /// Sets the innermost group around the collider; nullptr: none.
  void setGroup(const CollisionGroup* group) { group_ = group; }
  /// Moves the collider by `offset` in the body's frame [m], to keep its world pose when the body's origin has moved.
  void shift(const Vec3& offset);

 protected:
  void onLink() override;
  void onMoved() override;
  void onUnlink() override;
  /// Passes a changed shape to the model. Throws Error when it rejects it.
  void reshape();
  /// Sets a parameter of the shape. When the model rejects the new shape, restores the old value and throws Error.
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
  /// Its world; nullptr when it is not linked.
  physics::WorldModel* world() const { return space_ ? space_->world().get() : nullptr; }
  /// World pose of the shape.
  Pose geomPose() const;
  /// Colliders among its children; cached until something changes below.
  const std::vector<const Collider*>& inner() const;
  /// Depth of a point, given in the frame of the nearest transform, below the surface [m]; negative outside.
  double pointDepth(const Vec3& p) const;
  const std::vector<std::string>& notCollideWith() const { return notCollideWith_; }
  const std::vector<std::string>& collideWith() const { return collideWith_; }

 private:
  /// The outermost collider around it (or this), which contacts are reported for.
  Collider& outermost();
  /// Pose in the frame of the body, or of the nearest transform when static.
  Pose offset() const { return outer_ ? compose(outer_->offset(), local_) : local_; }
  /// Passes the pose of the geom, and of those of inner colliders, to the model; static ones are relative to `base`.
  void attach(const Pose& base);
  void attach() { attach(body_ ? Pose{} : physics::frameOf(*this)); }
  void destroyGeom();
  void findHandlers(bool defaultOnTransform);
  void setPosition(const Vec3& p);
  void setLocalPosition(const Vec3& p);
  void setRotation(const std::vector<double>& matrix);
  void setLocalPose(const Vec3& position, const std::vector<double>& rotation);
  void addCollisionHandler(const std::string& className);
  void addNotCollideWithColliderName(std::string name, bool on);
  void addCollideWithColliderName(std::string name, bool on);
  int part() const { return part_; }
  void setPart(int part);
  /// Passes part and blocks to the model.
  void extend();
  bool isStaticInWorld() const { return !outer_ && !body_; }

  std::shared_ptr<physics::SharedSpace> space_;
  physics::GeomHandle geom_ = physics::GeomHandle::none;
  Ref<RigidBody> body_;
  const CollisionGroup* group_ = nullptr;
  Collider* outer_ = nullptr;  ///< the TransformCollider it is part of
  int part_ = 0, priority_ = 0;
  engine::Blocks blocks_;
  Pose local_;                                             ///< in the frame of body, transform or outer collider
  std::int64_t contactTypes_ = 1, contactAffinities_ = 1;  ///< bits
  bool solid_ = false, listens_ = false, hasBody_ = false;
  Handlers handlers_;
  std::vector<std::string> notCollideWith_, collideWith_;
  mutable std::vector<const Collider*> inner_;
  mutable std::uint64_t innerAt_ = 0;
};

/// The surface of colliders without a handler, which is bouncy.
const engine::Surface& defaultSurface();

}  // namespace spark
