#pragma once
/// \file
/// Memory and CPU time of the batch.

#include "row.h"

namespace sparkbatch {

/// Memory is in MB of 10^6 bytes: the peak of the process, and the part of it since construction per worker thread.
/// With several processes, memory is the maximum over the processes; threads and CPU time are summed.
class Usage {
 public:
  /// `threads`: number of worker threads of this process.
  explicit Usage(int threads);
  /// Worker threads of all processes.
  int threads() const { return threads_; }
  double cpuSeconds() const { return cpuSeconds_; }
  double peakMegabytes() const { return peak_; }
  double megabytesPerWorld() const { return perWorld_; }
  /// Measures the memory of this process.
  void measure();
  /// Adds CPU time of runs.
  void addCpu(double seconds) { cpuSeconds_ += seconds; }
  /// The usage as a message to the leader.
  Json json() const;
  /// Adds the usage of another process, as json() returned it there.
  void add(const Json& other);

 private:
  int threads_;
  double cpuSeconds_ = 0, before_ = 0, peak_ = 0, perWorld_ = 0;
};

}  // namespace sparkbatch
