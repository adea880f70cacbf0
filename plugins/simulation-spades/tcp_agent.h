#pragma once
/// \file
/// Agents made for the plain loop: programs that connect to a server over TCP.

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "agent_database.h"
#include "agent_link.h"
#include "agent_program.h"
#include "frame_stream.h"

namespace spark::spades {

/// Listens at a port of its own for the one connection of a program that it starts, and translates: a sensation with
/// percepts is a message to the program, a message of it is an act, and one with AgentType::ends, such as (syn), ends
/// the thought. Sensations without percepts it answers itself, as the plain loop sends none.
///
/// The program's first message, such as (scene ...), waits for the first sensation: the agent is ready once that
/// message is there. What it sends unasked waits for the next sensation with percepts. So nothing depends on when a
/// message comes.
class TcpAgent final : public AgentLink {
 public:
  /// Starts the program; {port} and {number} in its command become the port and `number`. Throws Error.
  TcpAgent(const AgentType& type, int number, const std::string& log);
  ~TcpAgent() override;
  TcpAgent(const TcpAgent&) = delete;
  TcpAgent& operator=(const TcpAgent&) = delete;

  void send(std::string_view message) override;
  void poll() override;
  std::optional<Message> receive() override;
  std::string countInstructions() override { return program_->countInstructions(); }
  const std::string& lost() const override { return lost_.empty() && connection_ ? connection_->lost() : lost_; }
  void addEnd(std::vector<pollfd>& out) const override { program_->addEnd(out); }
  void addDescriptors(std::vector<pollfd>& out) const override;

 private:
  enum class Cycle {
    none,
    open,   ///< it thinks
    done,   ///< D is to be sent
    first,  ///< the first sensation: it has not been told, and its first message is the answer
  };
  void accept();
  void keepMessages();

  const std::string ends_;
  int listener_ = -1;
  std::unique_ptr<AgentProgram> program_;
  std::unique_ptr<FrameStream> connection_;  ///< nullptr: it has not connected
  std::deque<std::string> messages_;         ///< of the program, that wait for a cycle
  std::size_t bytes_ = 0;                    ///< of memory of messages_
  std::string lost_;
  int strangers_ = 0;  ///< connections of other programs, which were refused
  bool asked_ = false, ready_ = false, begun_ = false;
  Cycle cycle_ = Cycle::none;
};

}  // namespace spark::spades
