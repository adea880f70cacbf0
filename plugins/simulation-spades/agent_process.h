#pragma once
/// \file
/// An agent's program, and the pipes to it.

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "agent_database.h"

namespace spark::spades {

/// A running program. Messages have a length of four bytes, big-endian, before them. Ends the program when it is
/// destroyed: it should have got the message X before.
class AgentProcess {
 public:
  /// Most bytes that wait for the agent to read, and longest message from it.
  static constexpr std::size_t kMostUnread = 1 << 20;

  /// Starts the program; what it prints goes to `log`-stdout.log and `log`-stderr.log, or nowhere if `log` is empty.
  /// Throws Error.
  AgentProcess(const AgentType& type, const std::string& log);
  ~AgentProcess();
  AgentProcess(const AgentProcess&) = delete;
  AgentProcess& operator=(const AgentProcess&) = delete;

  /// Sends a message, as far as the agent reads; the rest later.
  void send(std::string_view message);
  /// Sends what is unsent, and reads what has come. Does not wait.
  void poll();
  /// The next message that has come; valid until the next call.
  std::optional<std::string_view> receive();
  /// Why nothing more will come; "": it runs.
  const std::string& lost() const { return lost_; }
  /// CPU time of the program and its threads so far [s]; 0 if it is unknown.
  double cpuSeconds() const;
  /// The descriptors to wait for: input always, output while something is unsent.
  int input() const { return fromAgent_; }
  int output() const { return out_.empty() ? -1 : toAgent_; }
  pid_t id() const { return pid_; }
  /// True once the program has ended. Does not wait.
  bool ended();
  /// Ends the program and its children at once.
  void kill();

 private:
  void fail(std::string why) {
    if (lost_.empty()) lost_ = std::move(why);
  }
  void flush();
  pid_t pid_ = -1;
  bool reaped_ = false;
  int toAgent_ = -1, fromAgent_ = -1;
  std::string out_, in_, message_, lost_;
  std::size_t read_ = 0;  ///< bytes of in_ that were received as messages
};

}  // namespace spark::spades
