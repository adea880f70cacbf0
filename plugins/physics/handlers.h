#pragma once
/// \file
/// Collision handlers that record contacts or pass them to scripts.

#include "collider.h"

namespace spark {

/// Records which colliders touched its collider, until clear().
class RecorderHandler : public CollisionHandler, public ICollisionRecorder {
  SPARK_CLASS(RecorderHandler, CollisionHandler)
 public:
  static void describe(Description<RecorderHandler>& d);
  void onCollision(const Collision& collision) override;
  const std::vector<Ref<Leaf>>& colliders() const override { return colliders_; }
  void clear() override { colliders_.clear(); }

 private:
  std::vector<std::string> paths() const;
  std::vector<Ref<Leaf>> colliders_;
};

/// Passes contacts to scripts: after each step it emits an event `collide` at this node for each contact point of its
/// collider.
class ScriptHandler : public CollisionHandler {
  SPARK_CLASS(ScriptHandler, CollisionHandler)
 public:
  static void describe(Description<ScriptHandler>& d);
  void onCollision(const Collision& collision) override;
  /// True when the last step had contact points.
  bool hasEvents() const { return !touches_.empty(); }
  /// Emits the events of the last step. `physics` is the event of the physics phase. Called after the step, because
  /// scripts may change the tree.
  void emit(const Event& physics);

 protected:
  void onLink() override;

 private:
  /// A contact point.
  struct Touch {
    Ref<Leaf> other;  ///< the other collider
    Vec3 position;    ///< world frame [m]
    double depth;     ///< m
  };
  const std::string& script() const { return script_; }
  void setScript(std::string file);
  std::vector<Touch> touches_;
  std::string script_;
};

}  // namespace spark
