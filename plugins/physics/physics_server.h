#pragma once
/// \file
/// The physics server: steps the world of the active scene and keeps bodies and transforms in agreement.
///
///     physics  place transforms that were moved by hand (bodies follow) -> shift the surroundings of re-centred bodies
///              -> detect contacts -> handlers -> step -> feedback -> faults -> script handlers
///     place    poses of awake bodies, read in one call -> transforms, outer ones first -> world matrices

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
  /// True: modelled motors change their temperature.
  bool jointHeating() const { return jointHeating_; }
  /// True: modelled motors drain their batteries.
  bool batteryDischarge() const { return batteryDischarge_; }

 private:
  /// A body and the transform that it moves.
  struct Placed {
    RigidBody* body;
    Transform* transform;  ///< the transform that the body moves
    Transform* above;      ///< the transform above that one; nullptr: none
    int depth;             ///< number of transforms above the body
    bool moving = false;   ///< awake at the last placing: RigidBody::takeUnplaced() need not be called
  };
  /// The world of the active scene; nullptr when there is none, or no engine.
  World* findWorld();
  /// Collects bodies, colliders and handlers again when the shape of the scene changed. False when there is no world.
  bool refresh();
  void collect(const Node& scene);
  /// Gives each collider its collision group.
  void formGroups(const Node& scene, std::vector<CollisionGroup*>& groups);
  /// The physics phase.
  void physics(const Event& event);
  /// Detects contacts, calls handlers and steps the world.
  void solve(const Event& event);
  /// The place phase: writes the poses of bodies to their transforms.
  void place(const Event& event);
  /// Keeps the world poses of colliders and transforms around bodies whose origin moved to their centre of mass.
  void shiftSurroundings();
  /// Logs the bodies that the engine had to reset.
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
  std::uint64_t contactsAt_ = 0;       ///< version of the tree when they were detected
  std::vector<std::size_t> measured_;  ///< indices of contacts that have feedback only because of measureForces
  std::vector<engine::Body> handles_;  ///< of bodies_, in the same order
  std::vector<std::uint8_t> awake_;    ///< of bodies_: 1 for an awake one
  std::vector<Matrix> poses_;          ///< of bodies_
};

}  // namespace spark
