#pragma once
/// \file
/// The physics server: steps the world of the active scene and keeps bodies and transforms in agreement.
///
///     physics  place transforms that were moved by hand (bodies follow) -> shift the surroundings of re-centred bodies
///              -> detect contacts -> handlers -> step -> feedback -> faults -> script handlers
///     place    poses of awake bodies -> transforms, outer ones first -> world matrices

#include <atomic>
#include <mutex>

#include "api/sound_cone.h"
#include "collider.h"
#include "effects.h"
#include "handlers.h"
#include "ray_scene.h"

namespace spark {

/// Steps the world of a scene, by default of the active one. Its child `collision` detects contacts, its child `engine`
/// solves them. Several servers step several scenes, each with an engine of its own.
class PhysicsServer : public Node, public IPhysicsServer, public IHearing {
  SPARK_CLASS(PhysicsServer, Node)
 public:
  static void describe(Description<PhysicsServer>& d);
  const engine::Model& model() override { return expectWorld().model(); }
  const engine::State& state() override { return expectWorld().state(); }
  void bodies(Node& root, std::vector<IRigidBody*>& out) override;
  std::span<const engine::Contact> contacts() const override;
  std::optional<RayHit> castRay(const Vec3& from, const Vec3& direction, double length, const Node* except) override;
  bool isHidden(const Vec3& from, const Vec3& to, const IRigidBody* own, const Node* except) override;
  void prepareRays() override;
  bool hasWorld() override { return currentWorld() != nullptr; }
  void overlaps(const Vec3& center, double radius, std::vector<ICollider*>& out) override;
  void listen(const SoundCone& cone, int rings, const Node* except, std::vector<Echo>& out) override;
  ICollider& colliderOf(void* owner) const override { return *static_cast<Collider*>(owner); }
  /// Throws Error, with what to do, unless there are an engine and a collision detection.
  void expectEngines() const;
  /// True if it steps the world of that scene.
  bool isOf(const Node& scene);
  /// True: worlds made from now on have Model::exactReplay.
  bool exactReplay() const { return exactReplay_; }
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
    engine::Index index;   ///< of the body in the model, when `structure` was its structure
    bool moving = false;   ///< awake at the last placing: RigidBody::takeUnplaced() need not be called
  };
  /// The scene that it steps; nullptr when there is none.
  Node* scene();
  /// Its world; nullptr when there is none.
  World* findWorld();
  /// The same without a search while the tree is that of refresh(): for calls by the thousand.
  World* currentWorld() { return world_ && !tree_.isStale(*this) ? world_ : findWorld(); }
  /// The same; throws Error when there is none.
  physics::WorldModel& expectWorld();
  bool useRayScene(const physics::WorldModel& world);
  bool isSensed(const engine::Geom& g, const Vec3& from, const Node* except) const;
  /// Collects bodies, colliders and handlers again when the shape of the scene changed. False when there is no world.
  bool refresh();
  void collect(const Node& scene);
  /// Gives each collider its collision group.
  void formGroups(const Node& scene, std::vector<CollisionGroup*>& groups);
  /// The physics phase.
  void physics(const Event& event);
  /// Detects contacts, calls handlers and steps the world.
  void solve(const Event& event);
  /// One of several steps of an engine that finds contacts within it: handlers run after it.
  void restored(const Event&);
  void solveLate(const physics::WorldModel& world, physics::Stepper& stepper, double dt, int steps);
  /// The place phase: writes the poses of bodies to their transforms.
  void place(const Event& event);
  /// Keeps the world poses of colliders and transforms around bodies whose origin moved to their centre of mass.
  void shiftSurroundings();
  /// shiftSurroundings() before the first step, for what reads a scene then.
  /// For scripts: { distance [m], path of the collider, position, normal } of castRay(); nil where it meets nothing.
  Value rayFor(const Vec3& from, const Vec3& direction, double length);
  /// For scripts: { low, high } of the box around all colliders of a node and below it, world frame [m], without
  /// planes; nil where there are none. Throws Error when the node is not there.
  Value boxOf(const std::string& node);
  void settle() {
    if (!refresh()) return;
    placeTransforms();
    shiftSurroundings();
    place({phase::kPlace, 0, 0, 0, nullptr});
  }
  /// Logs the bodies that had to be reset.
  void reportFaults();
  bool hasEngines() const { return engine_ && (collision_ || engine_->capabilities().findsContacts()); }
  /// Logs once that the world cannot be stepped.
  void lacksEngines();
  bool defaultOnTransform() const { return defaultOnTransform_; }
  void setDefaultOnTransform(bool on);
  std::string scenePath() const { return scenePath_; }
  void setScene(std::string path);
  /// Updates the world matrices of the scene. After refresh().
  void placeTransforms();

  bool jointHeating_ = false, batteryDischarge_ = false, defaultOnTransform_ = true, measureForces_ = false,
       exactReplay_ = false;
  int contactsPerPair_ = 4;
  std::string scenePath_;  ///< "": the active scene

  bool lacking_ = false;  ///< lacksEngines() has said so
  TreeWatch tree_;
  World* world_ = nullptr;
  Link<ISceneServer> scenes_;
  Link<engine::IEngine> engine_;
  Link<engine::ICollision> collision_;
  std::vector<Placed> bodies_;
  std::uint64_t structure_ = 0;  ///< Model::structure for which their indices are
  std::vector<Ref<ScriptHandler>> scripts_;
  physics::RayScene rays_;
  std::mutex raysUpdate_;
  std::atomic<std::uint64_t> scannedAt_ = 0;  ///< WorldModel::poses() of the last query that tested every geom
  std::atomic<int> scans_ = 0;                ///< such queries at those poses
  physics::Effects effects_;
  engine::Contacts contacts_;
  std::vector<std::size_t> order_;  ///< of solveLate(), with sorted_
  engine::Contacts sorted_;
  std::uint64_t contactsAt_ = 0;       ///< version of the tree when they were detected
  std::vector<std::size_t> measured_;  ///< indices of contacts that have feedback only because of measureForces
};

}  // namespace spark
