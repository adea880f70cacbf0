#pragma once
/// \file
/// Agents that are programs of this machine, for the middleware SPADES.

#include <memory>
#include <optional>
#include <string>

#include "agent_database.h"
#include "agent_link.h"
#include "agent_program.h"
#include "frame_stream.h"

namespace spark::spades {

/// Starts an agent of a type, which speaks as the type says. `number`: counts the agents of the type, from 1; `log`:
/// see AgentProgram. Throws Error.
std::unique_ptr<AgentLink> startAgent(const AgentType& type, int number, const std::string& log);

/// A program with pipes. It should have got the message X before it is destroyed.
class AgentProcess final : public AgentLink {
 public:
  /// Starts the program. Throws Error.
  AgentProcess(const AgentType& type, const std::string& log);

  void send(std::string_view message) override;
  void poll() override { pipes_->poll(); }
  std::optional<Message> receive() override;
  std::string countInstructions() override { return program_->countInstructions(); }
  const std::string& lost() const override { return pipes_->lost(); }
  void addEnd(std::vector<pollfd>& out) const override { program_->addEnd(out); }
  void addDescriptors(std::vector<pollfd>& out) const override { pipes_->addDescriptors(out); }

 private:
  std::unique_ptr<AgentProgram> program_;
  std::unique_ptr<FrameStream> pipes_;
};

}  // namespace spark::spades
