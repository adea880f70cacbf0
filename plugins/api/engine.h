#pragma once
/// \file
/// What an engine does for the plugin `physics`: detect contacts, and step the state of a world (api/model.h). One
/// thread at a time calls an engine and all that it made.
///
///     create     the node makes what one world needs: a solver, or a detector
///     compile    structure or parameters changed: the solver brings up to date what it keeps
///     detect     IDetector: contacts of the present poses; then collision handlers complete them
///     step       ISolver: solves joints and contacts, integrates
///
/// An engine whose contacts exist only within its step says so (Capabilities::late): it asks IContactSink for each pair
/// what to do, and reports at the end. Collision handlers then run after the step, in the order of the geoms.
///
/// An engine of point masses needs create() and step() alone.

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/contacts.h"
#include "api/state.h"
#include "spark/abi/api/engine.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/state.h"

namespace spark::engine {

/// A node that makes one `Part` for each world. A part belongs to its node: it ends with end(), with the node at the
/// latest, after the node's own members.
template <class Made>
class PerWorld {
 public:
  using Part = Made;
  virtual ~PerWorld() = default;
  /// The node.
  virtual Leaf& leaf() = 0;
  /// Makes the part of a new world. The model stays where it is as long as the part lives. It is compiled before its
  /// first use.
  virtual std::unique_ptr<Part> create(const Model& model) = 0;
  /// The same; the node keeps it.
  Part& start(const Model& model) { return *parts_.emplace_back(create(model)); }
  void end(const Part& part) {
    std::erase_if(parts_, [&](const auto& p) { return p.get() == &part; });
  }
  /// The parts of all worlds, in the order of their start.
  std::span<const std::unique_ptr<Part>> parts() const { return parts_; }

 private:
  std::vector<std::unique_ptr<Part>> parts_;
};

/// The part of one world: of whichever node is asked for it. It ends with this object.
template <class Maker>
class Attached {
 public:
  using Part = typename Maker::Part;
  Attached() = default;
  ~Attached() { end(); }
  Attached(const Attached&) = delete;
  Attached& operator=(const Attached&) = delete;
  /// True when the next of() starts another part.
  bool startsAnew(Maker& maker) const { return leaf_.get() != &maker.leaf(); }
  /// The part that was made last; nullptr: there is none, or it has ended.
  Part* present() const { return leaf_ ? part_ : nullptr; }
  /// The part that `maker` has made for the model, always the same model. That of another node ends.
  Part& of(Maker& maker, const Model& model) {
    if (!startsAnew(maker)) return *part_;
    end();
    part_ = &maker.start(model);
    maker_ = &maker;
    leaf_ = Ref<Leaf>(&maker.leaf());
    return *part_;
  }

 private:
  void end() {
    if (leaf_) maker_->end(*part_);
    leaf_ = {};
  }
  Ref<Leaf> leaf_;  ///< none: the node has gone, and the part with it
  Maker* maker_ = nullptr;
  Part* part_ = nullptr;
};

/// Finds the contacts of one world.
class IDetector {
 public:
  virtual ~IDetector() = default;
  /// Called before detect() when Model::structure or Model::collision changed. Elements are matched by identity (see
  /// indexOf()). `edited`: the geoms whose shape, body or offset was set since the last call, each once, in that
  /// order; when it is called for the first time all are new.
  virtual void compile(const Model& model, const State& state, std::span<const Index> edited) = 0;
  /// Appends contacts to `out`, in an order that depends on the world alone: at most `perPair` points for each pair of
  /// geoms, the first geom as comesFirst() has it. Skips pairs of geoms of one body, pairs whose bodies a joint
  /// connects and pairs that the filter rejects. Reads the new poses of the bodies in `state.moved`.
  virtual void detect(const Model& model, const State& state, PairFilter filter, int perPair, Contacts& out) = 0;
  /// Writes what decides the next detection and is neither in the model nor in the poses. Called between two steps.
  virtual void save(const State&, StateWriter&) const {}
  /// Reads it again. Called after compile(), when all bodies are loaded, before a detection that has all of them in
  /// `state.moved`. Throws Error where it does not fit.
  virtual void load(const Model&, const State&, StateReader&) {}
};

/// Makes the detectors of worlds.
class ICollision : public PerWorld<IDetector> {
 public:
  SPARK_INTERFACE(ICollision, 3);
};

/// Takes the contacts of an engine that finds them within its step (Capabilities::late).
class IContactSink {
 public:
  virtual ~IContactSink() = default;
  /// Most points of two geoms.
  virtual int perPair() const = 0;
  /// Two geoms touch; `points` are complete but for `solve`, `surface` and `feedback`, which it sets. Called in any
  /// thread, in several at a time, at most once for a pair and step. False for pairs that are of no interest.
  virtual bool decide(std::span<Contact> points) = 0;
  /// All contacts of the step, after it, with forceOnA where `feedback` is true; in any order. Called once, in the
  /// thread of the step.
  virtual void report(std::span<const Contact> contacts) = 0;
};

/// One step of a world.
struct Step {
  const Model& model;
  State& state;
  std::span<Contact> contacts;  ///< those with `solve` are constraints; forceOnA is written where `feedback` is true
  double dt = 0;                ///< s, above 0
  /// By body: 1 for the bodies that are to be stepped, whole islands; the others stay unchanged. Empty: all.
  std::span<const std::uint8_t> only;
  IContactSink* sink = nullptr;  ///< of an engine with Capabilities::late; others have `contacts`
  bool steps(Index body) const { return only.empty() || only[body] != 0; }
};

/// Steps one world.
class ISolver {
 public:
  virtual ~ISolver() = default;
  /// Called before step() when Model::structure or Model::dynamics changed. Elements are matched by identity (see
  /// indexOf()).
  virtual void compile(const Model&, const State&) {}
  /// Advances the state by `dt`. An island is a set of bodies that joints and solved contacts connect. Each island with
  /// an awake body is stepped: its bodies wake, forces are cleared, feedback is written, bodies are marked as moved.
  /// Does not throw, and does not allocate while structure and number of contacts repeat. Results may be no numbers:
  /// the caller puts such bodies back.
  virtual void step(Step& step) = 0;
  /// What finds the contacts, of an engine with Capabilities::detects; otherwise nullptr. Before detect() the solver is
  /// compiled where it has to be, also when Model::collision changed, and then the detector with the edited geoms.
  virtual IDetector* detector() { return nullptr; }
  /// Writes what decides the next step and is neither in the model nor in the state.
  virtual void save(StateWriter&) const {}
  /// Reads it again. Called after compile(), before a step. Throws Error where it does not fit.
  virtual void load(const Model&, StateReader&) {}
};

/// What an engine can do. `tests/engines` tests each of them and writes them to docs/engines.md; a world with something
/// that has no effect is reported in the log.
struct Capabilities {
  bool rotation = true;     ///< bodies rotate
  bool joints = true;       ///< joints have an effect
  bool loops = true;        ///< joints may close loops of bodies, and angular motors may drive other joints
  bool jointForces = true;  ///< joints measure their load (Joint::wantsFeedback)
  bool armature = false;    ///< joints have the inertia of their rotors (JointAxis::armature)
  bool sleeps = true;       ///< bodies at rest fall asleep; otherwise it steps all bodies always
  bool surfaces = true;     ///< contacts have bounce, slip, and friction as a force, each its own
  bool stateless = true;    ///< a solver has nothing of its own from step to step: another one continues bit for bit
  bool parts = true;        ///< it can step some islands alone (Step::only), as another engine's deferred engine
  bool detects = false;     ///< it finds contacts itself, before the step (ISolver::detector())
  bool late = false;        ///< it finds contacts within its step, and passes them to Step::sink
  // Which shapes collide, of an engine that finds contacts; the others have those of their ICollision.
  bool meshes = true;        ///< static meshes with all their triangles; otherwise their convex hulls
  bool bodyMeshes = true;    ///< so do those of bodies
  bool heightFields = true;  ///< height fields collide
  bool laws = false;         ///< it applies State::laws. Otherwise they come as forces on the bodies
  bool controls = false;     ///< it applies State::controls. Otherwise they come as laws; in both cases dry friction of
                             ///< controlled axes comes as a motor of speed 0
  bool damping = false;      ///< it applies damping and armature of JointAxis. Otherwise they come as laws
  bool springs = false;      ///< it applies the springs of JointAxis. Otherwise they come as laws
  bool bodyDamping = false;  ///< it applies the damping of bodies. Otherwise it comes as forces
  /// The length of step that suits it [s], of which a step of the simulation has a whole number; 0: any. That of the
  /// world (WorldParameters::timestep) comes first.
  double usualStep = 0;
  /// It needs no ICollision.
  bool findsContacts() const { return detects || late; }
};

/// The capabilities that a user notices, by name, as in docs/engines.md.
struct NamedCapability {
  const char* name;
  bool Capabilities::*has;
};
inline constexpr NamedCapability kNamedCapabilities[] = {
    {"rotation", &Capabilities::rotation},
    {"joints", &Capabilities::joints},
    {"joints that close loops, angular motors", &Capabilities::loops},
    {"forces of joints", &Capabilities::jointForces},
    {"inertia of rotors (armature)", &Capabilities::armature},
    {"sleep", &Capabilities::sleeps},
    {"surfaces of contacts: bounce, slip, friction as a force", &Capabilities::surfaces},
    {"continues bit for bit when its solver is made anew", &Capabilities::stateless},
    {"contacts of its own, before the step", &Capabilities::detects},
    {"contacts of its own, within the step", &Capabilities::late},
    {"static meshes with hollows", &Capabilities::meshes},
    {"meshes with hollows on bodies", &Capabilities::bodyMeshes},
    {"height fields", &Capabilities::heightFields},
};

/// The names of those that it has, or lacks.
inline std::vector<std::string> namesOf(const Capabilities& can, bool has = true) {
  std::vector<std::string> out;
  for (const NamedCapability& c : kNamedCapabilities)
    if (can.*c.has == has) out.emplace_back(c.name);
  return out;
}

/// Makes the solvers of worlds. Its class has `static constexpr engine::Capabilities kCapabilities`, and calls
/// describeEngine() in its describe().
class IEngine : public PerWorld<ISolver> {
 public:
  SPARK_INTERFACE(IEngine, 8);
  virtual Capabilities capabilities() const = 0;
  /// True for kinds of extensions that it reads (api/extension.h).
  virtual bool reads(std::uint64_t /*kind*/) const { return false; }
  std::vector<std::string> capabilityNames() const { return namesOf(capabilities()); }
};

/// Describes what all engines have.
template <class E>
void describeEngine(Description<E>& d) {
  d.template implements<IEngine>();
  d.property("capabilities", &IEngine::capabilityNames)
      .doc(fmt::format("What it does: {}. What it does not: {}.", fmt::join(namesOf(E::kCapabilities), "; "),
                       fmt::join(namesOf(E::kCapabilities, false), "; ")));
}

}  // namespace spark::engine
