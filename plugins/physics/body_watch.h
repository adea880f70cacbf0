#pragma once
/// \file
/// Sleep and repair: what is kept of each body beside model and state.

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
  void add() { entries_.emplace_back(); }
  /// Bodies were removed: see physics::renumber().
  void renumber(const std::vector<engine::Index>& now) { physics::renumber(entries_, now); }
  /// The body was placed: its pose is valid.
  void placed(engine::Index body);
  /// The body was woken: it is as long awake as any.
  void woken(engine::Index body) { setCounters(body, {}); }

  /// The counters of sleep.
  struct Counters {
    // ODE manual, "Automatic enabling and disabling", with the default thresholds there.
    int idleStepsLeft = 10;   ///< idle steps until the body falls asleep
    double idleTimeLeft = 0;  ///< idle time until the body falls asleep [s]
  };
  const Counters& counters(engine::Index body) const { return entries_[body].counters; }
  void setCounters(engine::Index body, const Counters& c) { entries_[body].counters = c; }

  /// Before a step of the simulation of `dt` [s]: bodies that have been idle long enough fall asleep. `contacts`: those
  /// that are solved keep a body from free flight.
  void putToSleep(const engine::Contacts& contacts, double dt);
  /// After a step: appends the bodies whose state was no number or out of range. They are back where they were, at
  /// rest.
  void repair(std::vector<engine::Index>& repaired);

 private:
  struct Entry {
    Counters counters;
    std::uint64_t lastContact = 0;      ///< number of the last call of putToSleep() with a solved contact
    Vec3 validPosition = Vec3::Zero();  ///< pose after the last step with a valid state
    Quaternion validQuaternion{1, 0, 0, 0};
  };
  WorldData& world_;
  std::vector<Entry> entries_;
  std::uint64_t calls_ = 0;  ///< of putToSleep()
};

}  // namespace spark::physics
