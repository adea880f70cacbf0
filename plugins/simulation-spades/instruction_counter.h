#pragma once
/// \file
/// Counts what a program computes, with the counters of the processor.

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace spark::spades {

/// The instructions that a program retires in user mode, with its threads and the programs that it starts from now on.
/// Linux (perf_event_open).
class InstructionCounter {
 public:
  /// Starts to count for a program; 0: this one. Throws Error with what lacks().
  explicit InstructionCounter(pid_t program);
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;
  /// Instructions since the start. While more programs count than the processor has counters, it is an estimate.
  double count() const;

  /// Why this machine cannot count instructions, and what to use instead, as one clause; "": it can.
  static std::string lacks();
  /// The same for an error of perf_event_open; 0: "".
  static std::string lacks(int error);
  /// The instructions of a reading: `counted` in `running` of `enabled` ns; 0 if it never ran.
  static double scaled(std::uint64_t counted, std::uint64_t enabled, std::uint64_t running);

 private:
  int descriptor_ = -1;
};

}  // namespace spark::spades
