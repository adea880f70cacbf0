#pragma once
/// \file
/// A world's islands in several threads, with the result of one thread.
///
/// ODE posts calls while it steps a world: as many "job starts" as there are threads, each of which then takes one
/// island after the other and posts the stages of an island's solution as calls that wait for each other. ODE's own
/// pool gives every call to whoever is free, so several threads work in one island, and the order in which they come
/// decides the order of sums. Here only job starts run side by side, by the kernel's jobs; what one of them posts is
/// run by the same thread, the last posted that waits for nothing first, as ODE's implementation for one thread does
/// it. So each island is solved by one thread, in one order.
///
///     step -> post: group, start 0, start 1 -> wait: jobs run start i
///          -> [island -> stage, stage, ...] [island -> ...] -> group
///
/// The order of threads would still show in the order in which geoms of different islands go to the heads of their
/// spaces, where hash spaces begin to look for pairs. So they are told in one thread, before the step: see
/// moveGeomsInOrder() in ode_islands.cpp.

#include <ode/ode.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "spark/kernel.h"

namespace spark::ode {

/// What ODE calls a threading implementation, of one world. Used by the thread that steps the world.
class IslandThreads {
 public:
  /// `jobs` outlives it.
  explicit IslandThreads(Jobs& jobs) : jobs_(jobs) {}
  IslandThreads(const IslandThreads&) = delete;
  IslandThreads& operator=(const IslandThreads&) = delete;

  /// Makes ODE use it for that world from now on.
  void serve(dWorldID world);
  /// Before a step: solve islands side by side (by default not). ODE keeps memory for as many threads as it was told of
  /// in the last step, so what changes from step to step is this, not the number.
  void setParallel(bool on) { parallel_ = on && jobs_.threads() > 1; }
  bool parallel() const { return parallel_; }
  /// Before a step: ODE is to think that there is one thread, whatever the jobs have.
  void setAlone(bool on) {
    alone_ = on;
    parallel_ = parallel_ && !on;
  }
  /// What ODE said in other threads during the last step is appended to `text`.
  void hear(std::string& text);

 private:
  struct Lane;
  /// A posted call.
  struct Call {
    Lane* home;  ///< of who posted it
    dThreadedCallFunction* function;
    void* context;
    dcallindex_t index;
    Call* then;  ///< waits for it; may be none
    int* fault;
    /// Calls that it waits for; once it has started, itself and calls that it posted in its stead.
    std::atomic<std::ptrdiff_t> waitsFor{0};
    bool started = false;
  };
  /// The calls that one thread posted. Memory is kept.
  struct Lane {
    std::deque<Call> memory;
    std::vector<Call*> free, posted;
    std::string said;
  };
  static thread_local Lane* current;

  static const dThreadingFunctionsInfo& functions();
  static IslandThreads& of(dThreadingImplementationID id) { return *reinterpret_cast<IslandThreads*>(id); }
  unsigned threads() const { return alone_ ? 1 : static_cast<unsigned>(jobs_.threads()); }
  Call& post(Call* then, int* fault, std::size_t waitsFor, dThreadedCallFunction* function, void* context,
             dcallindex_t index);
  /// Runs all that was posted.
  void runAll();
  void runStarts();
  void runPosted(Lane& lane);
  void run(Lane& lane, Call& call);
  /// One of the things that `call` waits for is done.
  void done(Lane& lane, Call* call);

  Jobs& jobs_;
  bool parallel_ = false, alone_ = false;
  std::atomic<bool> failed_{false};
  Lane outside_;            ///< of the thread that steps, outside jobs
  std::deque<Lane> lanes_;  ///< of jobs
  std::vector<Call*> starts_;
};

}  // namespace spark::ode
