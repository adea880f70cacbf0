#pragma once
/// \file
/// Has engines find the contacts of a world and step it.

#include "added_forces.h"
#include "world_model.h"

namespace spark::physics {

/// Steps one world. It ends before the world does.
class Stepper {
 public:
  explicit Stepper(WorldModel& world);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// Detects contacts: see IDetector::detect(). `collision` is used unless the engine detects them itself; otherwise it
  /// may be nullptr.
  void detect(engine::IEngine& engine, engine::ICollision* collision, engine::PairFilter filter, int perPair,
              engine::Contacts& out);
  /// Wakes and puts to sleep (BodyWatch), steps the world, and puts bodies whose state is no number or
  /// out of range back to their last valid pose, at rest. `contacts` are those of the last detect(), and nothing was
  /// removed since.
  /// `sink`: for an engine with Capabilities::late; `contacts` are then those of the step before.
  void step(engine::IEngine& engine, engine::Contacts& contacts, double dt, engine::IContactSink* sink = nullptr);
  /// Begins a step of the simulation that has `steps` of the engine's: keeps the forces and torques on the bodies where
  /// there are several.
  void begin(int steps);
  /// Adds the kept ones again, before a further step of the engine.
  void repeatForces();
  /// Writes what engines keep from step to step beside the state.
  void save(StateWriter& out) const;
  /// Reads it again; engines get it before their next detection or step. They throw Error then where it does not fit.
  void load(StateReader& in);
  /// Behind load(), when all is loaded: passes on what the detector has to know before the world changes.
  void settle(engine::IEngine& engine, engine::ICollision* collision);
  /// The bodies that were put back after the last step. Valid until the next step of the simulation.
  std::span<const BodyHandle> repaired() const { return repaired_; }

 private:
  /// What steps the model, or finds its contacts, and the versions of the model that it has compiled.
  template <class Maker>
  struct Compiled {
    engine::Attached<Maker> attached;
    std::uint64_t structure = 0, part = 0;
    /// Calls compile(the part) unless it has this version. Returns the part.
    template <class F>
    typename Maker::Part& bring(Maker& maker, const engine::Model& model, std::uint64_t version, F&& compile);
  };
  engine::ISolver& solver(engine::IEngine& engine);
  /// Compiles an engine's own detector where the model changed.
  void bringOwn(engine::IDetector& detector);
  engine::IDetector* bringDetector(engine::IEngine& engine, engine::ICollision* collision);

  WorldModel& world_;
  WorldData& data_;
  AddedForces added_;
  Compiled<engine::ICollision> collision_;
  Compiled<engine::IEngine> engine_;
  std::pair<std::uint64_t, std::uint64_t> ownAt_;  ///< structure and collision that its own detector has
  struct KeptForce {
    BodyHandle body;
    Vec3 force, torque;
  };
  std::vector<KeptForce> kept_;
  int steps_ = 1;             ///< of the engine, in a step of the simulation
  bool again_ = false;        ///< the next step is a further one
  std::uint64_t lateAt_ = 0;  ///< Model::structure at the contacts of a late engine
  /// What was loaded, and is not taken yet.
  struct Loaded {
    std::int64_t hash = 0;
    std::string bytes;
  };
  Loaded detectorState_, solverState_;
  std::vector<engine::Index> wrong_;
  std::vector<BodyHandle> repaired_;
};

}  // namespace spark::physics
