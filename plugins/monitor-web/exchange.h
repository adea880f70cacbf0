#pragma once
/// \file
/// Data shared by the simulation thread and the I/O thread that serves viewers. Neither blocks on the other.
///
///     simulation thread                                 I/O thread
///     WebMonitor, publish phase   ◄── wanted ─────────  ViewerHub: a lane is due, or a time of the history
///           └─ fills it ──────────── ready ──► wake ──► encodes, sends, requests the next ones
///     RequestQueue, between cycles ◄─ requests ───────  viewers' requests
///           └─ within its budget ─── replies ─► wake ─► to the viewer that sent the request

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "file_question.h"
#include "mailbox.h"
#include "stream/snapshot.h"

namespace spark::web {

/// Work for the simulation thread.
struct SimulationRequest {
  enum class Kind {
    control,     ///< `text`: JSON for the control server; `referee`: it may change the simulation
    command,     ///< `text`: a trainer command as S-expressions; sent for referees only
    unwatch,     ///< ends watch `id`
    drawings,    ///< subscribes the viewer to drawings, or unsubscribes it if `on` is false
    disconnect,  ///< the viewer disconnected: drop what it requested, watches and subscribed to
    status,      ///< the status report for all viewers
    file,        ///< finds the resource `text` and answers `file`
  } kind = Kind::control;
  std::uint64_t viewer = 0;  ///< Viewer::id()
  std::int64_t id = 0;       ///< chosen by the viewer; repeated in the reply
  std::string text;
  bool referee = false, on = true;
  std::shared_ptr<FileQuestion> file{};
};

/// A message from the simulation thread to viewers.
struct SimulationReply {
  enum class Kind {
    reply,   ///< completes a request of `viewer`
    update,  ///< unsolicited: a new value of a watch, changed drawings
    status,  ///< the status report, for all viewers
  } kind = Kind::reply;
  std::uint64_t viewer = 0;
  std::string text;                      ///< JSON
  std::vector<std::uint64_t> viewers{};  ///< updates: the recipients, if there are several; then `viewer` is unused
};

/// Snapshots that are handed over together. Those of the history are not urgent, and to wake a thread for each one
/// would cost more than to fill it. Belongs to one thread at a time.
struct SnapshotBatch {
  static constexpr double kAnyTime = std::numeric_limits<double>::lowest();
  std::array<Snapshot, 8> snapshots;
  std::size_t filled = 0;  ///< how many of them are
  // Set by the I/O thread before it requests the snapshots.
  double due = kAnyTime;         ///< s, simulated time from which the next one is to be filled
  double interval = 0;           ///< s, simulated, from one to the next
  std::uint64_t knownShape = 0;  ///< shape of the last description that it got
  bool describe = true;          ///< false: it wants no description now

  /// True if there is nothing to wait for: all are filled, or the scene has changed.
  bool complete() const {
    return filled == snapshots.size() || (filled > 0 && snapshots[filled - 1].shape != knownShape);
  }
};

/// Owned by the WebServer; must outlive the users on both threads.
class Exchange {
 public:
  /// Throws Error if the process has no file descriptor left.
  Exchange();
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  std::atomic<SnapshotBatch*> wanted{nullptr};  ///< lent to the simulation thread, which fills it
  std::atomic<SnapshotBatch*> ready{nullptr};   ///< filled, on its way back to the I/O thread
  /// A viewer waits: `wanted` is to be handed over with the next frame, whatever its time.
  std::atomic<bool> urgent{false};
  std::atomic<bool> watched{false};     ///< frames are sent or kept, so events are collected
  Mailbox<SimulationRequest> requests;  ///< I/O thread to simulation thread
  Mailbox<SimulationReply> replies;     ///< simulation thread to I/O thread

  /// True if the next frame is wanted, whatever its time.
  bool wantsNow() const { return wanted.load(std::memory_order_acquire) && urgent.load(std::memory_order_relaxed); }
  /// A snapshot of the batch that is wanted was filled: hands the batch over if a viewer waits or it is complete.
  /// Simulation thread only.
  void filled();
  /// Wakes the I/O thread. Any thread; does not block.
  void wake();
  /// The eventfd that wake() makes readable; a reader consumes eight bytes. Owned by this object.
  int wakeupFd() const { return wakeupFd_; }

 private:
  int wakeupFd_;
};

}  // namespace spark::web
