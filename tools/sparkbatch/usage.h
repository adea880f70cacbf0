#pragma once
/// \file
/// What a process, or several together, used.

#include "row.h"

namespace sparkbatch {

/// Memory in MB of 10^6 bytes: the most that the process had in memory, and how much of that came after this object was
/// made, per thread that simulated.
class Usage {
 public:
  explicit Usage(int threads);
  int threads() const { return threads_; }
  double cpuSeconds() const { return cpuSeconds_; }
  double peakMegabytes() const { return peak_; }
  double megabytesPerWorld() const { return perWorld_; }
  /// Reads the system's counts for this process.
  void measure();
  void addCpu(double seconds) { cpuSeconds_ += seconds; }
  Json json() const;
  /// Takes in another process: threads are summed, of memory the larger counts.
  void add(const Json& other);

 private:
  int threads_;
  double cpuSeconds_ = 0, before_ = 0, peak_ = 0, perWorld_ = 0;
};

}  // namespace sparkbatch
