#pragma once
/// \file
/// Worker threads.

#include <cstddef>
#include <functional>
#include <memory>

#include "spark/abi/spark/jobs.h"

namespace spark {

/// Runs the same function for 0..n-1 on several threads. Results must not depend on how many.
class Jobs {
 public:
  Jobs();
  ~Jobs();
  /// Total number of threads, the caller's included (1..64). Joins and starts threads; not to be called while run()
  /// runs.
  void setThreads(int count);
  int threads() const;
  /// Calls job(i) once for every i in [0, n) and returns when all are done. `job` must not throw and not change the
  /// tree.
  void run(std::size_t n, const std::function<void(std::size_t)>& job);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spark
