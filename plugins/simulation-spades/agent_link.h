#pragma once
/// \file
/// The way to an agent's program, on this machine or another.

#include <poll.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spark::spades {

/// Owned by the SpadesServer; simulation thread.
class AgentLink {
 public:
  virtual ~AgentLink() = default;
  /// Sends a message to the agent.
  virtual void send(std::string_view message) = 0;
  /// Sends what is unsent, and reads what has come. Does not wait.
  virtual void poll() = 0;
  /// A message of the agent.
  struct Message {
    std::string text;
    double cpuSeconds = 0;    ///< CPU time since the last S or T was sent to it
    double instructions = 0;  ///< retired since then; 0 before countInstructions()
  };
  /// The next message that has come.
  virtual std::optional<Message> receive() = 0;
  /// Counts instructions from now on. Returns why it cannot, as one clause; "": it does.
  virtual std::string countInstructions() = 0;
  /// Why nothing more will come; "": the agent is there.
  virtual const std::string& lost() const = 0;
  /// False while it cannot be reached, though it is not lost.
  virtual bool reachable() const { return true; }
  /// True once the program has ended. Does not wait.
  virtual bool ended() = 0;
  /// Appends the descriptors to wait for.
  virtual void addDescriptors(std::vector<pollfd>& out) const = 0;
};

/// True for messages that begin a think cycle.
inline bool beginsCycle(std::string_view message) { return message.starts_with('S') || message.starts_with('T'); }

}  // namespace spark::spades
