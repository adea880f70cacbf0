#pragma once

#include "field_nodes.h"
#include "player_contact_aspect.h"

namespace spark {

/// A child of a robot's collider. Reports the contacts of that collider with other robots and with the ball to
/// PlayerContactAspect. Does not change the contacts.
class AgentCollisionHandler : public CollisionHandler {
  SPARK_CLASS(AgentCollisionHandler, CollisionHandler)
 public:
  static void describe(Description<AgentCollisionHandler>& d) {
    d.doc("Reports the contacts of its collider with other robots and the ball; does not change the contacts.");
    d.link(&AgentCollisionHandler::contacts_, At<Node>(IGameControl::kPath).child<PlayerContactAspect>());
  }
  void onCollision(const Collision& collision) override {
    if (!collision.other.body()) return;  // ground and goals
    refresh();
    if (!contacts_ || !self_) return;
    if (other_ != &collision.other) classify(collision.other);
    if (otherAgent_ ? otherAgent_ != self_ : otherIsBall_)
      contacts_->report(*self_, otherAgent_, collision.contact.position);
  }

 private:
  void refresh() {
    if (!tree_.changed(*this)) return;
    self_ = outermostAgent(*this);
    other_ = nullptr;
  }
  /// Finds out what `other` belongs to. The result is cached, because a pair of colliders usually touches at several
  /// points and over many cycles.
  void classify(ICollider& other) {
    other_ = &other;
    otherAgent_ = outermostAgent(other.leaf());
    otherIsBall_ = !otherAgent_ && other.leaf().ancestor<Ball>();
  }
  static const AgentAspect* outermostAgent(const Leaf& leaf) {
    auto* agent = leaf.ancestor<AgentAspect>();
    return agent ? &agent->outermost() : nullptr;
  }

  Link<PlayerContactAspect> contacts_;
  TreeWatch tree_;
  const AgentAspect* self_ = nullptr;
  // The last collider that it touched.
  const ICollider* other_ = nullptr;
  const AgentAspect* otherAgent_ = nullptr;  ///< nullptr: the collider belongs to no agent
  bool otherIsBall_ = false;
};

}  // namespace spark
