#pragma once
/// \file
/// Sleep and repair: what is kept of each body beside model and state.
///
/// A body that is at rest sleeps: the solver skips it. It may do so as long as a step would leave it where it is, and
/// that depends on
///
///     what touches it     poses, shapes, surfaces, and which pairs collide: all of it shows in its contacts. The
///                         watch keeps a digest of those with which it fell asleep; with others it wakes.
///     all else            joints, motors, masses, gravity: WorldModel wakes the bodies when one is set to another
///     value.
///
/// What is driven may creep: a motor of 0.3 deg/s is slower than any threshold of idleness, and moves all the same. A
/// body with a motor that turns, a controller, spring or damping sleeps only if it is where it was when it became idle.
/// What joints and contacts connect with one that moves stays awake with it: put to rest in each step, it would be a
/// brake.
///
/// Solvers wake what is connected with a body that is awake, so a pile wakes as a whole. With exactReplay nothing of
/// this holds, as in the installed base: a body sleeps until it is pushed, or touched by one that is awake.

#include "api/contacts.h"
#include "rotations.h"
#include "world_data.h"

namespace spark::physics {

/// Puts bodies at rest to sleep, and bodies whose numbers went wrong back to their last valid pose. By index.
class BodyWatch {
 public:
  /// `world` must outlive it.
  explicit BodyWatch(WorldData& world) : world_(world) {}
  /// A body was added at the end.
  void add() {
    entries_.emplace_back();
    // A step must not allocate.
    ready_.reserve(entries_.capacity());
    root_.reserve(entries_.capacity());
  }
  /// Bodies were removed: see physics::renumber().
  void renumber(const std::vector<engine::Index>& now) {
    physics::renumber(entries_, now);
    loaded_.clear();
  }
  /// The body was placed: its pose is valid.
  void placed(engine::Index body);
  /// Wakes a body, because something that its rest depends on is another: its idle time starts anew. Not with
  /// exactReplay.
  void rouse(engine::Index body);
  void rouseAll();
  /// The body was woken or put to sleep by hand: it is as long awake as any, and rests on what touches it next.
  void switched(engine::Index body, bool awake);

  /// The counters of sleep.
  struct Counters {
    // ODE manual, "Automatic enabling and disabling", with the default thresholds there.
    int idleStepsLeft = 10;   ///< idle steps until the body falls asleep
    double idleTimeLeft = 0;  ///< idle time until the body falls asleep [s]
  };
  const Counters& counters(engine::Index body) const { return entries_[body].counters; }
  /// What a body rests on.
  struct Support {
    std::uint64_t digest = 0;    ///< of its solved contacts, if it sleeps
    std::uint32_t contacts = 0;  ///< their number in the last step in which it was awake and idle
    bool known = false;          ///< false: the digest is that of the next step
    bool slept = false;          ///< it has slept for a whole step
  };
  const Support& support(engine::Index body) const { return entries_[body].support; }
  /// While it lives, rouse() does nothing: state is loaded, that of the bodies included.
  class Loading {
   public:
    explicit Loading(BodyWatch& watch) : watch_(watch) { ++watch_.loadings_; }
    ~Loading() { --watch_.loadings_; }
    Loading(const Loading&) = delete;
    Loading& operator=(const Loading&) = delete;

   private:
    BodyWatch& watch_;
  };
  bool loading() const { return loadings_ > 0; }
  /// Where a body was when it became idle.
  struct Start {
    Vec3 position = Vec3::Zero();
    Quaternion quaternion{1, 0, 0, 0};
  };
  const Start& start(engine::Index body) const { return entries_[body].start; }
  /// It is awake and has been idle for a step at least.
  bool idles(engine::Index body) const {
    return world_.state.bodies[body].awake && counters(body).idleStepsLeft < Counters().idleStepsLeft;
  }
  /// The state of the body was loaded, with these. What it depends on may be loaded later: see settle().
  void loaded(engine::Index body, const Counters& counters, const Support& support, const Start& start);
  /// All is loaded: what was loaded holds, whatever woke bodies since.
  void settle();
  /// True once after loaded(): contacts of an earlier step are not those of now.
  bool takeLoaded();

  /// Before a step of the simulation: wakes bodies that rest on other contacts than those with which they fell asleep.
  void wake(const engine::Contacts& contacts);
  /// Before a step of the simulation of `dt` [s]: bodies that have been idle long enough fall asleep. `contacts`: those
  /// that are solved keep a body from free flight. `late`: they are those of the step before, and what a body rests on
  /// is known at the next call of wake().
  void putToSleep(const engine::Contacts& contacts, double dt, bool late = false);
  /// After a step: appends the bodies whose state was no number or out of range. They are back where they were, at
  /// rest.
  void repair(std::vector<engine::Index>& repaired);

 private:
  struct Entry {
    Counters counters;
    Support support;
    Start start;
    bool driven = false;                ///< see findDriven()
    std::uint64_t lastContact = 0;      ///< number of the last call of putToSleep() with a solved contact
    std::uint32_t contacts = 0;         ///< their number in that call
    std::uint64_t touching = 0;         ///< sum of addDigests(); 0 otherwise
    Vec3 validPosition = Vec3::Zero();  ///< pose after the last step with a valid state
    Quaternion validQuaternion{1, 0, 0, 0};
  };
  /// Adds the digest of each solved contact to `touching` of those of its bodies that `counts` is true for.
  template <class Counts>
  void addDigests(const engine::Contacts& contacts, Counts&& counts);
  /// Sets Entry::driven.
  void findDriven();
  /// True if a body that is ready to sleep has not moved since it became idle.
  bool isStill(engine::Index body) const;
  /// Removes from ready_ what is driven and moves, and all that is connected with it.
  void keepDriven(const engine::Contacts& contacts);
  WorldData& world_;
  std::vector<Entry> entries_;
  std::vector<engine::Index> ready_;  ///< bodies that have been idle long enough, in rising order
  std::vector<engine::Index> root_;   ///< by body: disjoint sets of what joints and contacts connect
  std::uint64_t calls_ = 0;           ///< of putToSleep()
  bool anyRests_ = false;             ///< a body may sleep, or have slept at the last call of wake()
  struct Loaded {
    engine::Index body;
    bool awake;
    Counters counters;
    Support support;
    Start start;
  };
  std::vector<Loaded> loaded_;  ///< until settle() or the next step
  bool anyLoaded_ = false;      ///< see takeLoaded()
  int loadings_ = 0;            ///< see Loading
};

}  // namespace spark::physics
