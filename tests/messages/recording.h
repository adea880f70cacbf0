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

/// A session: who sent what in which cycle, and what was answered.
struct Recording {
  struct Said {
    std::string from, message;
  };
  std::vector<std::string> agents;                             ///< in the order in which they connected
  std::map<int, std::vector<Said>> sent;                       ///< agents' messages, by cycle
  std::map<int, std::vector<std::string>> commands;            ///< trainers' messages, by cycle
  std::map<std::string, std::map<int, std::string>> answered;  ///< by agent and cycle
  std::vector<std::string> frames;                             ///< what the monitor got
  std::vector<std::string> ball;                               ///< where the recording says the ball was, "x y z" [m]
  int cycles = 0;

  /// What the agent was answered, "" when nothing was recorded.
  const std::string& answer(const std::string& agent, int cycle) const;
};
/// Reads a .jsonl or .jsonl.gz file.
Recording readRecording(const std::filesystem::path& file);

/// A host of the humanoids' league in lockstep, as fast as it goes.
class LockstepHost {
 public:
  /// `settings`: K=V for --set.
  explicit LockstepHost(const std::vector<std::string>& settings);
  /// Stops the program, or lets it go on: what clients do meanwhile it finds at once.
  void halt(bool on);
  /// Ends the host. Returns what it wrote to stderr.
  std::string end();
  unsigned short agentPort = 0, monitorPort = 0;

 private:
  std::unique_ptr<Process> process_;
};

/// Sends what was sent, and hands each answer over: (cycle, agent, answer). An agent whose connection the host closes
/// is handed over once more, with an empty answer. Returns what the host wrote to stderr.
std::string replay(const Recording& recording, const std::vector<std::string>& settings,
                   const std::function<void(int, const std::string&, const std::string&)>& each);

}  // namespace spark::test
