#pragma once
/// \file
/// Programs that run as agents.

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "agent_database.h"
#include "agent_link.h"
#include "instruction_counter.h"

namespace spark::spades {

/// A running program. Ends it, and what it has started, when it is destroyed.
class AgentProgram {
 public:
  /// A descriptor of this process that the program gets by another number.
  struct Descriptor {
    int ours, theirs;
  };
  /// Starts `command` in the folder of `type`; what it prints goes to `log`-stdout.log and `log`-stderr.log, or nowhere
  /// if `log` is empty. Throws Error.
  AgentProgram(const AgentType& type, const std::vector<std::string>& command, const std::string& log,
               const std::vector<Descriptor>& descriptors);
  ~AgentProgram();
  AgentProgram(const AgentProgram&) = delete;
  AgentProgram& operator=(const AgentProgram&) = delete;

  /// The group of its processes.
  pid_t group() const { return pid_; }
  /// True once it has ended. Does not wait.
  bool ended() const;
  /// See AgentLink.
  void addEnd(std::vector<pollfd>& out) const;
  /// See AgentLink.
  std::string countInstructions();
  /// A thought begins now.
  void beginThought();
  /// A message of the program, with what the thought has taken so far.
  AgentLink::Message measured(std::string text) const;

 private:
  /// CPU time of the program and its threads so far [s]; 0 if it is unknown.
  double cpuSeconds() const;
  pid_t pid_ = -1;
  int end_ = -1;  ///< readable once it has ended
  double cpuAtBegin_ = 0, countAtBegin_ = 0;
  std::unique_ptr<InstructionCounter> counter_;  ///< nullptr: instructions are not counted
};

}  // namespace spark::spades
