#pragma once
/// \file
/// Runs agents on this machine for a simulator on another one.

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "agent_process.h"
#include "comm_channel.h"

namespace spark::spades {

/// Starts agents when the simulator says so, and passes messages between them and it. A connection that breaks is made
/// again; messages are kept meanwhile.
class CommServer {
 public:
  struct Options {
    std::string host = "127.0.0.1", database, logs, token, name;
    int port = 12000, most = 100;  ///< most: agents at a time
    double patience = 30;          ///< how long the simulator may be away [s]
  };
  /// Throws Error if the database cannot be read.
  explicit CommServer(Options options);
  /// Works until the simulator says that it is over: true; false: it refused, or was away for too long.
  bool run();
  /// Ends run(). From a signal handler.
  void stop() { stopped_ = 1; }

 private:
  using Clock = std::chrono::steady_clock;
  void connect();
  /// Tries once; nullptr: it cannot be reached.
  std::unique_ptr<FrameStream> open() const;
  void obey();
  void obey(std::string_view message);
  void report();
  void wait() const;
  void start(std::uint64_t id, std::string_view what);
  void endAgents();

  const Options options_;
  std::map<std::string, AgentType> types_;
  CommHello hello_;
  CommChannel channel_;
  std::map<std::uint64_t, std::unique_ptr<AgentLink>> agents_;  ///< by id
  bool over_ = false, confused_ = false;
  std::string refused_;
  volatile int stopped_ = 0;
};

}  // namespace spark::spades
