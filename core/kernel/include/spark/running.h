#pragma once
/// \file
/// What the threads of this process run at this instant: node and phase, for reports of crashes and for watchdogs.
///
/// Who calls the code of plugins says so with a NowRunning: a few relaxed stores to a record of the calling thread, no
/// lock, no memory, no text. Names and paths are made from it when they are needed, in a signal handler on the very
/// thread: nothing can change meanwhile.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "spark/abi/spark/running.h"

namespace spark {

class Leaf;

/// One thread's record. Written by that thread only.
struct Running {
  std::atomic<const Leaf*> node{
      nullptr};  ///< whose code runs; a class object while it makes an object; nullptr: no node's
  std::atomic<const char*> phase{nullptr};  ///< "sense", "onLink", "constructor", ...: a text that outlives the call
  std::atomic<const char*> file{nullptr};   ///< the plugin's file that is being loaded
  std::atomic<std::uint64_t> beats{0};      ///< grows as long as the thread gets on
  std::atomic<int> thread{0};               ///< the system's number of it, 0: a record that no thread has
  /// The thread gets on: it starts something new, or it waits.
  void beat() { beats.store(beats.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed); }
};

/// The calling thread's record, valid as long as the thread.
Running& running();

/// The calling thread's record, nullptr when it has run no node yet. Safe in signal handlers.
const Running* runningHere();

/// While it lives, its thread runs a phase; of which node, `at` says. What ran before runs again afterwards.
class NowRunning {
 public:
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
  void at(const Leaf* node) { now_.node.store(node, std::memory_order_relaxed); }
  void beat() { now_.beat(); }

 private:
  Running& now_;
  const Leaf* node_;
  const char* phase_;
};

/// Writes what a thread runs as words: "in sense of /usr/scene/x (class Gyro of plugin sensors)". Returns their length,
/// at most `size`. Safe in signal handlers of that very thread.
std::size_t describeRunning(const Running& now, char* words, std::size_t size);

/// The records of all threads, those that no thread has included.
std::span<const Running> runningThreads();

/// From now on `begin` runs in the calling thread, and in each other one when it runs a node for the first time; `end`
/// when such a thread ends. To be called once, before there are other threads.
void watchThreads(void (*begin)(), void (*end)());

}  // namespace spark
