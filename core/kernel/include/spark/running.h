#pragma once
/// \file
/// Records which node and phase each thread runs, for crash reports and watchdogs.
///
/// Code that calls plugins makes a NowRunning: a few relaxed stores to a record of the calling thread, without locks,
/// allocation or text. Names and paths are read from the tree only for a report, in a signal handler of that thread, so
/// that they cannot change meanwhile.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "spark/abi/spark/running.h"

namespace spark {

class Leaf;

/// The record of a thread. It is written by that thread only.
struct Running {
  /// The node whose code runs; the class object while a constructor runs; nullptr outside of nodes.
  std::atomic<const Leaf*> node{nullptr};
  std::atomic<const char*> phase{nullptr};  ///< "sense", "onLink", ...: a text that outlives the call
  std::atomic<const char*> file{nullptr};   ///< file of the plugin that is being loaded, else nullptr
  std::atomic<std::uint64_t> beats{0};      ///< increases while the thread makes progress
  std::atomic<int> thread{0};               ///< the system's id of the thread; 0: the record is free
  /// Records progress: the thread begins something new, or it waits.
  void beat() { beats.store(beats.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed); }
};

/// The record of the calling thread, valid as long as the thread.
Running& running();

/// The record of the calling thread; nullptr if it has not run a node yet. Safe in signal handlers.
const Running* runningHere();

/// Records what the calling thread runs while this object lives. The destructor restores the record.
class NowRunning {
 public:
  /// The thread runs `phase`, a text that outlives this object, of `node`.
  explicit NowRunning(const char* phase, const Leaf* node = nullptr)
      : now_(running()),
        node_(now_.node.load(std::memory_order_relaxed)),
        phase_(now_.phase.load(std::memory_order_relaxed)) {
    at(node);
    now_.phase.store(phase, std::memory_order_relaxed);
  }
  ~NowRunning() {
    at(node_);
    now_.phase.store(phase_, std::memory_order_relaxed);
  }
  NowRunning(const NowRunning&) = delete;
  NowRunning& operator=(const NowRunning&) = delete;
  /// The thread continues with another node.
  void at(const Leaf* node) { now_.node.store(node, std::memory_order_relaxed); }
  /// Records progress, see Running::beat.
  void beat() { now_.beat(); }

 private:
  Running& now_;
  const Leaf* node_;
  const char* phase_;
};

/// Writes a record in words: "in sense of /usr/scene/x (class Gyro of plugin sensors)". Returns the length [bytes], at
/// most `size`; the text is not terminated. Safe in signal handlers of the record's own thread.
std::size_t describeRunning(const Running& now, char* words, std::size_t size);

/// All records, those without a thread included. Valid as long as the process.
std::span<const Running> runningThreads();

/// Calls `begin` now in the calling thread, and later in each other thread when it first runs a node; `end` is called
/// in such a thread when it ends. Call it once, before other threads are started.
void watchThreads(void (*begin)(), void (*end)());

}  // namespace spark
