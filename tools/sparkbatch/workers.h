#pragma once
/// \file
/// The threads of one process, a world each at a time.

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

/// A pool whose threads simulate runs. All functions are for the one thread that owns it.
class Workers {
 public:
  using Work = std::function<Row(const Run&, Watch&)>;
  /// What came of a run; no row when it was abandoned.
  using Result = std::optional<Row>;

  Workers(int threads, Work work);
  /// Abandons what runs and waits for it.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Threads with nothing to do, and runs that were begun and not yet taken as finished.
  int idle() const;
  int running() const { return running_; }
  /// Precondition: a thread is idle.
  void begin(Run run);
  /// What has finished; waits up to `patience` for the first.
  std::vector<Result> take(std::chrono::milliseconds patience);
  void abandon();
  /// Simulated seconds of the worlds that run now.
  double time() const;

 private:
  struct Job {
    Run run;
    Watch watch;
  };
  void loop();

  Work work_;
  mutable std::mutex mutex_;
  std::condition_variable begun_, finished_;
  std::deque<std::shared_ptr<Job>> waiting_;
  std::vector<std::shared_ptr<Job>> active_;
  std::vector<Result> results_;
  std::vector<std::thread> threads_;
  int running_ = 0;
  bool ending_ = false;
};

}  // namespace sparkbatch
