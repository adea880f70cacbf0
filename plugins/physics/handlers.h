#pragma once
/// \file
/// Collision handlers that need nothing but a contact.

#include "collider.h"

namespace spark {

/// Remembers what touched its collider until it is asked to forget.
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

/// Lets a script react: after each step, each contact point of its collider is an event `collide` at this node.
class ScriptHandler : public CollisionHandler {
  SPARK_CLASS(ScriptHandler, CollisionHandler)
 public:
  static void describe(Description<ScriptHandler>& d);
  void onCollision(const Collision& collision) override;
  bool hasEvents() const { return !touches_.empty(); }
  /// Emits what the last step brought. Scripts may change the tree, so nothing of the step is in use any more.
  void emit(const Event& physics);

 protected:
  void onLink() override;

 private:
  struct Touch {
    Ref<Leaf> other;
    Vec3 position;
    double depth;
  };
  const std::string& script() const { return script_; }
  void setScript(std::string file);
  std::vector<Touch> touches_;
  std::string script_;
};

}  // namespace spark
