#pragma once
/// \file
/// A pool of worker threads.

#include <cstddef>
#include <functional>
#include <memory>

#include "spark/abi/spark/jobs.h"

namespace spark {

/// Runs a function for 0..n-1 on several threads. The result must not depend on the number of threads. Set it up and
/// call it from one thread only.
class Jobs {
 public:
  /// A pool of one thread: the caller's.
  Jobs();
  /// Ends and joins all worker threads.
  ~Jobs();
  /// Sets the total number of threads, the caller's included: 1 to 64, larger numbers are clamped. Joins the old
  /// workers and starts new ones. Must not be called while run() runs.
  void setThreads(int count);
  /// The total number of threads, the caller's included.
  int threads() const;
  /// Calls job(i) once for every i in [0, n), in any order, and returns when all calls have returned. `job` must not
  /// throw and must not change the tree.
  void run(std::size_t n, const std::function<void(std::size_t)>& job);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spark
