#pragma once
/// \file
/// Recorded lockstep sessions, and the host against which they are replayed.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "system/client.h"
#include "system/process.h"

namespace spark::test {

/// A session: the messages sent in each cycle, and the answers.
struct Recording {
  struct Said {
    std::string from, message;
  };
  std::vector<std::string> agents;                             ///< in order of connection
  std::map<int, std::vector<Said>> sent;                       ///< agents' messages, by cycle
  std::map<int, std::vector<std::string>> commands;            ///< trainers' messages, by cycle
  std::map<std::string, std::map<int, std::string>> answered;  ///< by agent and cycle
  std::vector<std::string> frames;                             ///< messages to the monitor
  std::vector<std::string> ball;                               ///< recorded positions of the ball, "x y z" [m]
  int cycles = 0;

  /// The recorded answer to the agent; "" if there is none.
  const std::string& answer(const std::string& agent, int cycle) const;
};
/// Reads a .jsonl or .jsonl.gz file.
Recording readRecording(const std::filesystem::path& file);

/// A host of the humanoid league in lockstep at maximum rate.
class LockstepHost {
 public:
  /// `settings`: K=V for --set.
  explicit LockstepHost(const std::vector<std::string>& settings);
  /// Stops or continues the program. It reads all messages sent meanwhile at once.
  void halt(bool on);
  /// Ends the host. Returns what it wrote to stderr.
  std::string end();
  unsigned short agentPort = 0, monitorPort = 0;

 private:
  std::unique_ptr<Process> process_;
};

/// Sends the recorded messages and calls `each` with every answer: (cycle, agent, answer). When the host closes an
/// agent's connection, `each` is called once more with an empty answer. Returns what the host wrote to stderr.
std::string replay(const Recording& recording, const std::vector<std::string>& settings,
                   const std::function<void(int, const std::string&, const std::string&)>& each);

}  // namespace spark::test
