#pragma once
/// \file
/// Where the simulation's thread and the thread that serves viewers meet. Nobody waits for the other.
///
///     simulation's thread                               I/O thread
///     WebMonitor, publish phase   ◄── wanted ─────────  Audience: a lane is due
///           └─ fills it ──────────── ready ──► wake ──► encodes, sends, wants it again
///     Desk, between cycles        ◄── questions ──────  viewers ask
///           └─ as the budget lets ── answers ─► wake ─► to the viewer that asked

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "mailbox.h"
#include "snapshot.h"

namespace spark::web {

/// Something that only the simulation's thread can know or do.
struct Question {
  enum class Kind {
    request,   ///< JSON, for the control server; `referee`: may change things
    command,   ///< a trainer's, S-expressions; only of referees
    unwatch,   ///< ends watch `id`
    drawings,  ///< wants them from now on, or (`on` false) no longer
    gone,      ///< the viewer left
    status,    ///< how the host is doing, for all
  } kind = Kind::request;
  std::uint64_t viewer = 0;
  std::int64_t id = 0;
  std::string text;
  bool referee = false, on = true;
};

/// A message for viewers.
struct Answer {
  enum class Kind { reply, told, status } kind = Kind::reply;  ///< reply: ends a question; told: comes by itself
  std::uint64_t viewer = 0;
  std::string text;                      ///< JSON
  std::vector<std::uint64_t> viewers{};  ///< told: instead of `viewer`, when several get the same
};

/// Owned by the web server; both sides end before it.
class Exchange {
 public:
  Exchange();
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  std::atomic<Snapshot*> wanted{nullptr}, ready{nullptr};
  std::atomic<bool> watched{false};  ///< there are viewers: events count
  Mailbox<Question> questions;
  Mailbox<Answer> answers;

  /// Tells the I/O thread that something is there for it.
  void wake();
  /// Becomes readable by wake(); the reader takes eight bytes.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace spark::web
