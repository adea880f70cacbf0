#pragma once
/// \file
/// Whether a thread gets on.

#include <cstdint>

#include "spark/running.h"

namespace sparkhost {

/// Looks whether the thread that made it gets on. At most one object a process at a time; its functions are called by
/// another thread.
class Watchdog {
 public:
  /// Watches the calling thread.
  Watchdog();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  /// True when the thread did something new since the last call, or runs no node's code.
  bool gotOn();
  /// What the thread runs, or the thread that it waits for, in words of at most 1000 bytes; "" when there is no answer
  /// within some 0.1 s. Interrupts that thread for a moment.
  const char* words();

 private:
  spark::Running& watched_;
  std::uint64_t seen_ = 0;
};

}  // namespace sparkhost
