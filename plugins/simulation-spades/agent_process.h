#pragma once
/// \file
/// An agent's program, and the pipes to it.

#include <sys/types.h>

#include <memory>
#include <string>

#include "agent_database.h"
#include "agent_link.h"
#include "frame_stream.h"
#include "instruction_counter.h"

namespace spark::spades {

/// A running program. Ends it, and what it has started, when it is destroyed: it should have got the message X before.
class AgentProcess final : public AgentLink {
 public:
  /// Starts the program; what it prints goes to `log`-stdout.log and `log`-stderr.log, or nowhere if `log` is empty.
  /// Throws Error.
  AgentProcess(const AgentType& type, const std::string& log);
  ~AgentProcess() override;
  AgentProcess(const AgentProcess&) = delete;
  AgentProcess& operator=(const AgentProcess&) = delete;

  void send(std::string_view message) override;
  void poll() override { pipes_->poll(); }
  std::optional<Message> receive() override;
  std::string countInstructions() override;
  const std::string& lost() const override { return pipes_->lost(); }
  bool ended() override;
  void addDescriptors(std::vector<pollfd>& out) const override;

 private:
  /// Ends the program and what it has started.
  void kill();
  /// CPU time of the program and its threads so far [s]; 0 if it is unknown.
  double cpuSeconds() const;
  pid_t pid_ = -1;
  double cpuAtBegin_ = 0, countAtBegin_ = 0;
  std::unique_ptr<InstructionCounter> counter_;  ///< nullptr: instructions are not counted
  std::unique_ptr<FrameStream> pipes_;
};

}  // namespace spark::spades
