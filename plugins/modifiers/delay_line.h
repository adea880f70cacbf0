#pragma once
/// \file
/// Percepts or actions under way.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "api/modifier.h"
#include "spark/state.h"

namespace spark::modifiers {

/// A queue of signals. None overtakes an earlier one. Allocates nothing once it has held as much as it has to hold: two
/// buffers are used in turn, as signals that have left are cut off by copying the others.
class DelayLine {
 public:
  /// The most that it holds [bytes]. A signal that would exceed it is lost, so that a client cannot fill the memory.
  static constexpr std::size_t kMaxBytes = std::size_t(16) << 20;

  /// The longest delay [s], some 32 years.
  static constexpr double kMostSeconds = 1e9;

  /// Moves what is in the signal to the end of the queue, if there is anything. It may leave `cycles` cycles and
  /// `seconds` of simulated time later. Then fills the signal with all that may leave now, and counts the cycle.
  void pass(Signal& signal, double time, std::int64_t cycles, double seconds);
  /// Saves what is under way.
  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  /// A signal in the queue.
  struct Entry {
    std::int64_t cycle;      ///< it leaves not before this cycle
    double time;             ///< and this time [s]
    std::uint32_t elements;  ///< its lists
    std::size_t bytes;
  };
  void take(Signal& signal, const Entry& due);
  void release(Signal& signal, double time);
  void dropReleased();

  std::int64_t cycle_ = 0;  ///< number of calls of pass()
  std::vector<Entry> entries_;
  std::size_t left_ = 0;  ///< entries at the beginning that have left
  Predicates lists_, spare_;
  std::uint32_t leftTokens_ = 0;  ///< tokens at the beginning of lists_ that have left
  std::size_t bytes_ = 0;         ///< of the entries that have not left
};

}  // namespace spark::modifiers
