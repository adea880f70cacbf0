#pragma once
/// \file
/// Collision detection by ODE 0.16 in double precision. ODE's types do not leave this folder.
///
/// What it does differently from plain ODE, and why:
///  - Geoms have no bodies in ODE: their poses are computed from the state, in ODE's order of operations.
///  - Order of pairs: the order in which ODE's spaces report pairs depends on history. Here pairs are collected, sorted
///    by the age of their geoms, and then collided: the same tree in the same state gives the same contacts. (Except
///    with Model::exactReplay: see README.md.)
///  - Spaces: each space collides its own geoms once per step.
///
///     moved bodies -> poses of geoms -> sweep and prune -> close pairs -> filters -> sort -> narrow phase -> contacts

#include <memory>
#include <optional>
#include <vector>

#include "api/engine.h"
#include "convex_contacts.h"
#include "ode_numbers.h"
#include "ode_process.h"
#include "ode_shapes.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

class OdeCollision;

namespace ode {

/// A collision space.
struct SpaceData {
  std::uint64_t id;
  dSpaceID space;
  bool inner = true;  ///< its geoms collide with each other
  // Exact replay:
  bool top = false;              ///< not inside another space
  std::uint64_t collidedAt = 0;  ///< number of the detection in which its geoms were last collided with each other
};

/// A geom, in its own place: ODE refers to it.
struct GeomData {
  // The members up to `centred` are read for each geom whose body has moved: they are side by side.
  std::uint64_t id;
  dGeomID geom = nullptr;
  dReal* rotation = nullptr;            ///< ODE's memory: 3 rows of 4 elements; nullptr: a plane
  engine::Index index = engine::kNone;  ///< in the model
  engine::Index body = engine::kNone;   ///< in the model; kNone: static
  void* owner = nullptr;                ///< as in the model
  bool collides = true;
  bool jointed = false;  ///< its body has joints
  bool centred = false;  ///< `offset` is the identity
  /// Pose of ODE's shape in the frame of the body, or in the world.
  Pose offset;
  engine::ShapeDescription shape;
  SharedShape shared;  ///< ODE refers to it
};

/// Two geoms whose bounds overlap, ordered by age.
struct Pair {
  GeomData* a;
  GeomData* b;
  bool operator<(const Pair& o) const { return a->id != o.a->id ? a->id < o.a->id : b->id < o.b->id; }
};

/// What is kept for a world.
struct CollisionWorld {
  LibraryGuard library;
  bool exactReplay;
  dSpaceID root;  ///< the space around all top-level spaces
  std::vector<std::unique_ptr<SpaceData>> spaces;
  MadeShapes made;
  ConvexContacts convex;
  std::vector<std::unique_ptr<GeomData>> geoms;  ///< as in the model
  std::uint64_t detections = 0;
  std::uint64_t builtAt = 0;  ///< Model::structure for which the lists below were made
  // The geoms of body i: geomsOf[firstGeom[i]] .. geomsOf[firstGeom[i + 1] - 1]; the bodies that joints connect it to:
  // likewise, in rising order.
  std::vector<engine::Index> firstGeom, geomsOf, firstJoined, joinedTo;
  std::vector<Pair> pairs;  ///< close pairs of the current detect()
  /// Exact replay, of a state that was loaded: the orders of ODE's spaces, and the bodies that moved since, in order.
  struct Order {
    std::vector<std::vector<dGeomID>> spaces;
    std::vector<engine::Index> moved;
  };
  std::optional<Order> loaded;
  explicit CollisionWorld(bool exactReplay);
  ~CollisionWorld();
  CollisionWorld(const CollisionWorld&) = delete;
  CollisionWorld& operator=(const CollisionWorld&) = delete;
  bool joined(engine::Index a, engine::Index b) const;
};

/// Finds the contacts of one world.
class OdeDetector : public engine::IDetector {
 public:
  /// `node` owns it.
  OdeDetector(OdeCollision& node, bool exactReplay) : node_(node), world_(exactReplay) {}
  void compile(const engine::Model& model, const engine::State& state, std::span<const engine::Index> edited) override;
  void detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int perPair,
              engine::Contacts& out) override;
  void save(const engine::State& state, StateWriter& out) const override;
  void load(const engine::Model& model, const engine::State& state, StateReader& in) override;
  /// ODE's spaces and geoms, for measurements.
  const CollisionWorld& world() const { return world_; }

 private:
  /// Narrow phase of a pair; nothing where ODE fails.
  int collideOrFail(const Pair& pair, int max, dContactGeom* found);
  std::string nameOf(const GeomData& geom) const;

  OdeCollision& node_;
  CollisionWorld world_;
};

}  // namespace ode

/// ODE as the collision detection of the physics server.
class OdeCollision : public Leaf, public engine::ICollision {
  SPARK_CLASS(OdeCollision, Leaf)
 public:
  static void describe(Description<OdeCollision>& d) {
    d.doc("Collision detection by the Open Dynamics Engine.");
    d.implements<engine::ICollision>();
    d.property("messages", &OdeCollision::messages).doc("Number of error and warning messages from ODE.");
  }
  Leaf& leaf() override { return *this; }
  std::unique_ptr<engine::IDetector> create(const engine::Model& model) override {
    return std::make_unique<ode::OdeDetector>(*this, model.exactReplay);
  }

 private:
  friend class ode::OdeDetector;
  std::int64_t messages() const { return messages_.count; }
  ode::LibraryGuard library_;  // worlds end after it, and have their own
  ode::Messages messages_;
};

}  // namespace spark
