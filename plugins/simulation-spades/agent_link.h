#pragma once
/// \file
/// The way to an agent's program, on this machine or another.

#include <poll.h>

#include <cerrno>
#include <chrono>
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
  /// Appends a descriptor that is readable once the program has ended, unless it has ended already, or its server ends
  /// it.
  virtual void addEnd(std::vector<pollfd>& out) const = 0;
  /// Appends the descriptors to wait for.
  virtual void addDescriptors(std::vector<pollfd>& out) const = 0;
};

/// Waits until one of the descriptors is ready, or a signal comes: true, or until `end`: false.
inline bool waitUntil(std::chrono::steady_clock::time_point end, std::vector<pollfd>& descriptors) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
  if (left <= 0) return false;
  const int ready = ::poll(descriptors.data(), descriptors.size(), static_cast<int>(left));
  return ready > 0 || (ready < 0 && errno == EINTR);
}

/// True for messages that begin a think cycle.
inline bool beginsCycle(std::string_view message) { return message.starts_with('S') || message.starts_with('T'); }

}  // namespace spark::spades
