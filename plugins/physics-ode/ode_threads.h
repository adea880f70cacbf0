#pragma once
/// \file
/// Solving the islands of a world in several threads, with the result of one thread.
///
/// ODE posts calls while it steps a world: one "job start" per thread. Each job start takes one island after the other
/// and posts the stages of the island's solution as calls that depend on each other. ODE's own thread pool gives every
/// call to any free thread, so several threads work on one island, and their timing decides the order of sums.
///
/// Here only job starts run in parallel, as the kernel's jobs. The calls that a job start posts are run by the same
/// thread: always the last posted one without open dependencies, as in ODE's implementation for one thread. So each
/// island is solved by one thread, in a fixed order.
///
///     step -> post: group, start 0, start 1 -> wait: jobs run start i
///          -> [island -> stage, stage, ...] [island -> ...] -> group
///
/// The timing of threads would still show in the order in which geoms of different islands move to the heads of their
/// spaces, where hash spaces begin to look for pairs. So the geoms are marked as moved in one thread before the step:
/// see moveGeomsInOrder() in ode_islands.cpp.

#include <ode/ode.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "spark/kernel.h"

namespace spark::ode {

/// An ODE threading implementation for one world. Used by the thread that steps the world.
class IslandThreads {
 public:
  /// `jobs` must outlive it.
  explicit IslandThreads(Jobs& jobs) : jobs_(jobs) {}
  IslandThreads(const IslandThreads&) = delete;
  IslandThreads& operator=(const IslandThreads&) = delete;

  /// Makes ODE use it for `world`. It must outlive the world's steps.
  void attachTo(dWorldID world);
  /// Before a step: solve islands in parallel; false by default. The number of threads that ODE sees stays the same,
  /// because ODE reallocates memory when it changes.
  void setParallel(bool on) { parallel_ = on && jobs_.threads() > 1; }
  bool parallel() const { return parallel_; }
  /// An island that ODE does not solve, by its own message, is a failure.
  void setStrict(bool on) { strict_ = on; }
  /// Before a step: reports one thread to ODE, and switches parallel() off.
  void setSingleThreaded(bool on) {
    singleThreaded_ = on;
    parallel_ = parallel_ && !on;
  }
  /// Writes the last message from ODE in the jobs of the last step to `text`; `text` is unchanged without one.
  void takeMessage(std::string& text);
  /// ODE's text when calls of the last step failed (see Failure): islands remain that were not stepped. Otherwise
  /// empty.
  std::string takeFailure();

 private:
  struct Lane;
  /// A posted call.
  struct Call {
    Lane* owner;  ///< the lane whose memory it is in
    dThreadedCallFunction* function;
    void* context;
    dcallindex_t index;
    Call* dependent;  ///< the call that depends on it; may be nullptr
    int* fault;       ///< receives the result; may be nullptr
    /// Open dependencies. After the start: the call itself and the calls that it made its dependencies.
    std::atomic<std::ptrdiff_t> dependencies{0};
    bool started = false;
  };
  /// The calls that one thread posted. Their memory is reused.
  struct Lane {
    std::deque<Call> memory;
    std::vector<Call*> free;    ///< calls of `memory` that are not in use
    std::vector<Call*> posted;  ///< calls that have not started, in order of posting
    std::string message;        ///< the last message from ODE in this thread
    std::string failure;        ///< of a call
    /// Makes room for this many calls.
    void grow(std::size_t calls);
    /// Forgets calls that wait for one that failed.
    void abandon();
  };
  static thread_local Lane* current;  ///< of the job that this thread runs; nullptr outside of jobs

  static const dThreadingFunctionsInfo& functions();
  static IslandThreads& of(dThreadingImplementationID id) { return *reinterpret_cast<IslandThreads*>(id); }
  unsigned threads() const { return singleThreaded_ ? 1 : static_cast<unsigned>(jobs_.threads()); }
  /// Posts a call to the lane of the current thread.
  Call& post(Call* dependent, int* fault, std::size_t dependencies, dThreadedCallFunction* function, void* context,
             dcallindex_t index);
  /// Runs all posted calls.
  void runAll();
  /// Runs the job starts in parallel.
  void runJobStarts();
  /// Runs the calls of a lane, the last one without open dependencies first.
  void runPosted(Lane& lane);
  void run(Lane& lane, Call& call);
  /// Closes one dependency of `call`. When it was the last one of a started call, the call is finished, and so is one
  /// dependency of its dependent.
  void finishDependency(Lane& lane, Call* call);

  Jobs& jobs_;
  bool parallel_ = false, singleThreaded_ = false, strict_ = false;
  std::atomic<bool> failed_{false};  ///< a call failed since the last result was written
  Lane outside_;                     ///< of the thread that steps the world
  std::deque<Lane> lanes_;           ///< of the jobs
  std::vector<Call*> starts_;        ///< job starts of the current step
};

}  // namespace spark::ode
