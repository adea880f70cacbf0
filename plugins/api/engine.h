#pragma once
/// \file
/// What an engine does for the plugin `physics`: detect contacts, and step the state of a world (api/model.h). One
/// thread at a time calls an engine.
///
///     compile    when structure or parameters changed: the engine brings up to date what it keeps for the model
///     detect     ICollision: contacts of the present poses; then collision handlers complete them
///     step       IEngine: solves joints and contacts, integrates
///
/// An engine of point masses needs step() alone.

#include "api/model.h"
#include "spark/abi/api/engine.h"
#include "spark/kernel.h"

namespace spark::engine {

/// Finds contacts.
class ICollision {
 public:
  SPARK_INTERFACE(ICollision, 1);
  virtual ~ICollision() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Called before detect() when Model::structure or Model::collision changed. Elements are matched by identity; a
  /// model that the engine has not seen yet is all new.
  virtual void compile(const Model& model, const State& state) = 0;
  /// Appends contacts to `out`, in an order that depends on the world alone: at most `perPair` points for each pair of
  /// geoms, the first geom as comesFirst() has it. Skips pairs of geoms of one body, pairs whose bodies a joint
  /// connects and pairs that the filter rejects. Reads the new poses of the bodies in `state.moved`.
  virtual void detect(const Model& model, const State& state, PairFilter filter, int perPair, Contacts& out) = 0;
  /// Drops what was kept for a model that ends, or that another engine takes over.
  virtual void forget(const Model& model) = 0;
};

/// One step of a world.
struct Step {
  const Model& model;
  State& state;
  std::span<Contact> contacts;  ///< those with `solve` are constraints; forceOnA is written where `feedback` is true
  double dt = 0;                ///< s, above 0
  /// By body: 1 for the bodies that are to be stepped, whole islands; the others stay unchanged. Empty: all.
  std::span<const std::uint8_t> only;
  bool steps(Index body) const { return only.empty() || only[body] != 0; }
};

/// Says once, as from `node`, that an engine leaves out the inertia of rotors, when a joint has one.
inline void warnOfArmature(const Model& model, const Leaf& node, bool& said) {
  const auto hasOne = [](const Joint& j) {
    return std::any_of(j.axes.begin(), j.axes.end(), [](const JointAxis& a) { return a.armature > 0; });
  };
  if (said || !std::any_of(model.joints.begin(), model.joints.end(), hasOne)) return;
  said = true;
  node.kernel().log().warning("{}: the inertia of rotors (armature) has no effect with this engine", node.path());
}

/// Steps worlds.
class IEngine {
 public:
  SPARK_INTERFACE(IEngine, 4);
  virtual ~IEngine() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Called before step() when Model::structure or Model::dynamics changed. See ICollision::compile().
  virtual void compile(const Model& model, const State& state) = 0;
  /// Advances the state by `dt`. An island is a set of bodies that joints and solved contacts connect. Each island with
  /// an awake body is stepped: its bodies wake, forces are cleared, feedback is written, bodies are marked as moved.
  /// Does not throw, and does not allocate while structure and number of contacts repeat. Results may be no numbers:
  /// the caller puts such bodies back.
  virtual void step(Step& step) = 0;
  /// True: the engine applies State::controls itself. False: they come as forces on the bodies. In both cases dry
  /// friction of controlled axes comes as a motor of speed 0.
  virtual bool controls() const { return false; }
  /// True: the engine applies JointAxis::damping itself. False: it comes as forces on the bodies.
  virtual bool damps() const { return controls(); }
  /// True: the engine applies the damping of bodies itself. False: it comes as forces on them.
  virtual bool dampsBodies() const { return false; }
  /// True: the engine applies the springs of JointAxis itself. False: they come as forces on the bodies.
  virtual bool springs() const { return false; }
  /// The length of step that suits the engine [s], of which a step of the simulation has a whole number; 0: any. That
  /// of the world (WorldParameters::timestep) comes first.
  virtual double usualStep() const { return 0; }
  /// False: Step::only has no effect, so the engine cannot be another one's deferred engine.
  virtual bool stepsParts() const { return true; }
  /// False: the engine steps all bodies always, and none is put to sleep.
  virtual bool sleeps() const { return true; }
  /// Drops what was kept for a model that ends, or that another engine takes over.
  virtual void forget(const Model& model) = 0;
};

}  // namespace spark::engine
