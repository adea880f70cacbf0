#pragma once
/// \file
/// Checks whether a thread makes progress.

#include <cstdint>

#include "spark/running.h"

namespace sparkhost {

/// Checks whether the thread that created it makes progress. At most one such object may exist per process; its
/// functions are called by another thread.
class Watchdog {
 public:
  /// Watches the calling thread.
  Watchdog();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  /// True if the thread has made progress since the last call, or runs no node's code.
  bool gotOn();
  /// Describes what the thread, or the thread that it waits for, is running, in at most 1000 bytes; "" if that thread
  /// does not answer in time. Interrupts that thread briefly.
  const char* words();

 private:
  spark::Running& watched_;
  std::uint64_t seen_ = 0;
};

}  // namespace sparkhost
