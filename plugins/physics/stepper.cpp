#include "stepper.h"

#include <algorithm>

namespace spark::physics {

using engine::DynamicState;
using engine::Index;
using engine::kNone;

namespace {
/// Passes what was loaded on, once.
template <class Loaded, class F>
void takeState(Loaded& loaded, F&& load) {
  const std::string bytes = std::exchange(loaded, {}).bytes;
  if (bytes.empty()) return;
  StateReader in(bytes);
  load(in);
}
}  // namespace

Stepper::Stepper(WorldModel& world) : world_(world), data_(world.data()), added_(data_, world.kinematics()) {}

template <class Maker>
template <class F>
typename Maker::Part& Stepper::Compiled<Maker>::bring(Maker& maker, const engine::Model& model, std::uint64_t version,
                                                      F&& compile) {
  const bool fresh = attached.startsAnew(maker);
  auto& made = attached.of(maker, model);
  if (fresh) structure = part = UINT64_MAX;  // should the first compile() throw
  if (structure == model.structure && part == version) return made;
  compile(made);
  structure = model.structure;
  part = version;
  return made;
}

engine::ISolver& Stepper::solver(engine::IEngine& engine) {
  // One that detects contacts has geoms, too.
  const engine::Capabilities can = engine.capabilities();
  const std::uint64_t version = data_.model.dynamics + (can.findsContacts() ? data_.model.collision : 0);
  if (engine_.attached.startsAnew(engine)) ownAt_ = {};
  return engine_.bring(engine, data_.model, version, [&](engine::ISolver& s) { s.compile(data_.model, data_.state); });
}

void Stepper::bringOwn(engine::IDetector& detector) {
  const std::pair now{data_.model.structure, data_.model.collision};
  if (std::exchange(ownAt_, now) != now || !world_.edited().empty())
    detector.compile(data_.model, data_.state, world_.edited());
}

void Stepper::save(StateWriter& out) const {
  // An engine may keep much that follows from what is hashed.
  const auto write = [&](const Loaded& loaded, auto&& save) {
    StateWriter own(out.keeps());
    if (loaded.bytes.empty()) save(own);
    out.write(loaded.bytes.empty() ? static_cast<std::int64_t>(own.hash()) : loaded.hash);
    out.aside(loaded.bytes.empty() ? own.bytes() : loaded.bytes);
  };
  engine::ISolver* const solver = engine_.attached.present();
  engine::IDetector* const own = solver ? solver->detector() : nullptr;
  engine::IDetector* const detector = own ? own : collision_.attached.present();
  write(detectorState_, [&](StateWriter& to) {
    if (detector) detector->save(data_.state, to);
  });
  write(solverState_, [&](StateWriter& to) {
    if (solver) solver->save(to);
  });
}

void Stepper::load(StateReader& in) {
  for (Loaded* l : {&detectorState_, &solverState_}) {
    l->hash = in.readInteger();
    l->bytes = in.readString();
  }
}

/// The detector, compiled, with the state that was loaded; nullptr if the engine finds contacts in its step, or nobody
/// does.
engine::IDetector* Stepper::bringDetector(engine::IEngine& engine, engine::ICollision* collision) {
  world_.compact();
  const auto compile = [&](engine::IDetector& d) { d.compile(data_.model, data_.state, world_.edited()); };
  engine::IDetector* const own = engine.capabilities().detects ? solver(engine).detector() : nullptr;
  if (!own && (!collision || engine.capabilities().late)) return nullptr;
  engine::IDetector& detector = own ? *own : collision_.bring(*collision, data_.model, data_.model.collision, compile);
  if (own) bringOwn(*own);
  world_.clearEdited();
  takeState(detectorState_, [&](StateReader& in) { detector.load(data_.model, data_.state, in); });
  return &detector;
}

void Stepper::settle(engine::IEngine& engine, engine::ICollision* collision) {
  world_.watch().settle();
  bringDetector(engine, collision);
}

void Stepper::detect(engine::IEngine& engine, engine::ICollision* collision, engine::PairFilter filter, int perPair,
                     engine::Contacts& out) {
  if (engine::IDetector* const detector = bringDetector(engine, collision))
    detector->detect(data_.model, data_.state, filter, perPair, out);
  world_.clearEdited();
  for (const Index i : data_.state.moved) data_.state.bodies[i].moved = false;
  data_.state.moved.clear();
}

void Stepper::begin(int steps) {
  steps_ = steps;
  kept_.clear();
  if (steps == 1) return;
  for (Index i = 0; i < data_.state.bodies.size(); ++i)
    if (const DynamicState& s = data_.state.bodies[i]; s.awake && !(s.force.isZero(0) && s.torque.isZero(0)))
      kept_.push_back({world_.handleOf(i), s.force, s.torque});
}

void Stepper::repeatForces() {
  again_ = true;
  for (const KeptForce& k : kept_) {
    // A handler removed it, or it fell asleep, and would keep them.
    const Index i = world_.index(k.body);
    if (i == kNone || !data_.state.bodies[i].awake) continue;
    data_.state.bodies[i].force += k.force;
    data_.state.bodies[i].torque += k.torque;
  }
}

void Stepper::step(engine::IEngine& engine, engine::Contacts& contacts, double dt, engine::IContactSink* sink) {
  world_.compact();
  engine::ISolver& solver = Stepper::solver(engine);
  takeState(solverState_, [&](StateReader& in) { solver.load(data_.model, in); });
  const engine::Capabilities can = engine.capabilities();
  engine::State& state = data_.state;
  const bool first = !std::exchange(again_, false);
  if (first) repaired_.clear();
  // Contacts of the step before name bodies that may be others by now.
  const bool restored = world_.watch().takeLoaded();
  const bool current =
      !can.late || (!restored && std::exchange(lateAt_, data_.model.structure) == data_.model.structure);
  // Sleep counts steps of the simulation.
  const bool sleeps = first && current && can.sleeps;
  if (sleeps) world_.watch().wake(contacts);
  const auto awake = [](const DynamicState& s) { return s.awake; };
  // A late engine finds the contacts that wake bodies in its step.
  if (!can.late && std::none_of(state.bodies.begin(), state.bodies.end(), awake)) return;
  // A step must not allocate.
  wrong_.reserve(state.bodies.size());
  repaired_.reserve(state.bodies.size());
  if (sleeps && data_.model.parameters.autoDisable) world_.watch().putToSleep(contacts, steps_ * dt, can.late);
  added_.add(can, dt);
  world_.kinematics().begin();
  engine::Step step{data_.model, state, contacts, data_.rounded(dt), {}, sink};
  if (can.late) step.contacts = {};
  solver.step(step);
  ++data_.poses;
  wrong_.clear();
  world_.watch().repair(wrong_);
  for (const Index i : wrong_) repaired_.push_back(world_.handleOf(i));
  world_.kinematics().countTurns();
}

}  // namespace spark::physics
