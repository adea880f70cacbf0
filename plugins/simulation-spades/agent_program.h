#pragma once
/// \file
/// Programs that run as agents.

#include <sys/types.h>

#include <string>
#include <vector>

#include "agent_database.h"

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

  /// True once it has ended. Does not wait.
  bool ended() const;
  /// CPU time of the program and its threads so far [s]; 0 if it is unknown.
  double cpuSeconds() const;

 private:
  pid_t pid_ = -1;
};

}  // namespace spark::spades
