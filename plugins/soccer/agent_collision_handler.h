#pragma once

#include "field_nodes.h"
#include "player_contact_aspect.h"

namespace spark {

/// Stands in the colliders of robots and tells PlayerContactAspect, where there is one, which robots (and the ball)
/// they meet.
class AgentCollisionHandler : public CollisionHandler {
  SPARK_CLASS(AgentCollisionHandler, CollisionHandler)
 public:
  static void describe(Description<AgentCollisionHandler>& d) {
    d.doc("Tells the rules of touching and charging which robots its collider meets; contacts are not changed.");
    d.link(&AgentCollisionHandler::contacts_, At<Node>(IGameControl::kPath).child<PlayerContactAspect>());
  }
  void onCollision(const Collision& collision) override {
    if (!collision.other.body()) return;  // ground and goals
    refresh();
    if (!contacts_ || !self_) return;
    if (other_ != &collision.other) look(collision.other);
    if (otherAgent_ ? otherAgent_ != self_ : otherIsBall_)
      contacts_->add(*self_, otherAgent_, collision.contact.position);
  }

 private:
  void refresh() {
    if (!tree_.changed(*this)) return;
    self_ = outermost(*this);
    other_ = nullptr;
  }
  /// The last collider it met stays in mind: contacts go on for many points and cycles.
  void look(ICollider& other) {
    other_ = &other;
    otherAgent_ = outermost(other.leaf());
    otherIsBall_ = !otherAgent_ && other.leaf().ancestor<Ball>();
  }
  static const AgentAspect* outermost(const Leaf& leaf) {
    auto* agent = leaf.ancestor<AgentAspect>();
    return agent ? &agent->outermost() : nullptr;
  }

  Link<PlayerContactAspect> contacts_;
  TreeWatch tree_;
  const AgentAspect* self_ = nullptr;
  const ICollider* other_ = nullptr;
  const AgentAspect* otherAgent_ = nullptr;
  bool otherIsBall_ = false;
};

}  // namespace spark
