#pragma once
/// \file
/// The worker threads of a process, each with one world at a time.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "row.h"
#include "sweep.h"
#include "world.h"

namespace sparkbatch {

/// A thread pool that executes runs. All functions must be called by the thread that created it.
class Workers {
 public:
  /// Executes a run. Called by several threads at once; must not throw.
  using Work = std::function<Row(const Run&, RunControl&)>;
  /// The row of a run; empty if it was abandoned.
  using Result = std::optional<Row>;

  /// Starts the threads.
  Workers(int threads, Work work);
  /// Abandons the current runs and joins the threads.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Number of threads without a run.
  int idle() const;
  /// Number of runs that were started and not collected yet.
  int running() const { return running_; }
  /// Starts a run. Precondition: idle() > 0.
  void start(Run run);
  /// The results of finished runs; waits up to `timeout` for the first.
  std::vector<Result> collect(std::chrono::milliseconds timeout);
  /// Ends the current runs after their current cycle.
  void abandon();
  /// Simulated seconds of the current runs, in sum.
  double time() const;

 private:
  struct Job {
    Run run;
    RunControl control;
  };
  void loop();

  Work work_;
  mutable std::mutex mutex_;  ///< of the members below, except running_
  std::condition_variable started_, finished_;
  std::deque<std::shared_ptr<Job>> waiting_;
  std::vector<std::shared_ptr<Job>> active_;
  std::vector<Result> results_;
  std::vector<std::thread> threads_;
  int running_ = 0;
  bool ending_ = false;
};

}  // namespace sparkbatch
