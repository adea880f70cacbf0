#pragma once
/// \file
/// The physics server: steps the active scene's world and brings bodies and transforms together.
///
///     physics  place what was moved by hand (bodies follow) -> shift what surrounds re-centred bodies
///              -> detect -> handlers -> solve -> feedback -> faults -> script handlers
///     place    poses of what is awake in one call -> transforms, outer ones first -> world matrices

#include "collider.h"
#include "handlers.h"

namespace spark {

/// Steps the world of the active scene. The engine is its child `engine`.
class PhysicsServer : public Node, public IPhysicsServer {
  SPARK_CLASS(PhysicsServer, Node)
 public:
  static void describe(Description<PhysicsServer>& d);
  engine::IEngine& engine() override;
  engine::World world() override;
  void bodies(Node& root, std::vector<IRigidBody*>& out) override;
  std::span<const engine::Contact> contacts() const override;
  ICollider& colliderOf(void* owner) const override { return *static_cast<Collider*>(owner); }
  /// Motors that model heat get warm.
  bool jointHeating() const { return jointHeating_; }
  /// Motors draw from their batteries.
  bool batteryDischarge() const { return batteryDischarge_; }

 private:
  /// A body with what its placing needs.
  struct Placed {
    RigidBody* body;
    Transform* transform;  ///< that it moves
    Transform* above;      ///< the transform around that, nullptr for none
    int depth;             ///< transforms above the body
    bool moving =
        false;  ///< was awake when it was placed last: what the body itself keeps for placing need not be looked at
  };
  World* findWorld();
  /// Looks at the scene again when its shape changed. False when there is nothing to step.
  bool refresh();
  void collect(const Node& scene);
  void formGroups(const Node& scene, std::vector<CollisionGroup*>& groups);
  void physics(const Event& event);
  void solve(const Event& event);
  void place(const Event& event);
  void shiftSurroundings();
  void reportFaults();
  bool defaultOnTransform() const { return defaultOnTransform_; }
  void setDefaultOnTransform(bool on);

  bool jointHeating_ = false, batteryDischarge_ = false, defaultOnTransform_ = true, measureForces_ = false;
  int contactsPerPair_ = 4;

  TreeWatch tree_;
  World* world_ = nullptr;
  Link<ISceneServer> scene_;
  std::vector<Placed> bodies_;
  std::vector<Ref<ScriptHandler>> scripts_;
  engine::Contacts contacts_;
  std::uint64_t contactsAt_ = 0;       ///< the tree's version when they were found
  std::vector<std::size_t> measured_;  ///< contacts whose force only measureForces asked for
  std::vector<engine::Body> handles_;  ///< of bodies_
  std::vector<std::uint8_t> awake_;
  std::vector<Matrix> poses_;
};

}  // namespace spark
