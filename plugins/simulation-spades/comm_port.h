#pragma once
/// \file
/// Communication servers on other machines, which run agents for the simulator.

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agent_link.h"
#include "comm_channel.h"

namespace spark {
class Log;
}

namespace spark::spades {

class RemoteAgent;

/// Listens for communication servers (tools/sparkcomm). Messages to one are `start <id> <number> <type>`, `to <id>
/// <message>`, `end`; from it `from <id> <CPU time [us]> <message>`, `lost <id> <why>`. Simulation thread.
class CommPort {
 public:
  /// A communication server that has connected once.
  class Server {
   public:
    explicit Server(CommHello hello) : hello_(std::move(hello)) {}
    const std::string& name() const { return hello_.name; }
    /// The timer of an agent type; nullptr: it has no such type.
    const std::string* timerOf(const std::string& type) const;
    bool connected() const { return channel_.connected(); }

   private:
    friend CommPort;
    friend RemoteAgent;
    CommHello hello_;
    CommChannel channel_;
    std::map<std::uint64_t, RemoteAgent*> agents_;  ///< by id
    std::chrono::steady_clock::time_point goneAt_{};
    bool given_ = false;  ///< up: its agents are lost
  };

  /// Listens; port 0: any free one. Throws Error.
  CommPort(const std::string& address, int port, std::string token, Log& log);
  ~CommPort();
  int port() const { return port_; }

  /// Accepts connections and exchanges messages. `patience`: how long a server may be away before its agents are lost
  /// [s]; `open`: new servers may join.
  void poll(double patience, bool open);
  /// The servers, in the order of their names.
  std::vector<Server*> servers() const;
  /// Starts an agent there, the `number`th of its type, from 1. The server must outlive it.
  std::unique_ptr<AgentLink> start(Server& server, int id, const std::string& type, int number);
  /// Tells all servers that the simulation is over; each leaves then.
  void end();
  /// True while one of them has not left. A connection that is closed before could lose what was sent last.
  bool hasServers() const;
  void addDescriptors(std::vector<pollfd>& out) const;

 private:
  /// A connection without a hello yet.
  struct Newcomer {
    std::unique_ptr<FrameStream> stream;
    std::chrono::steady_clock::time_point since;
  };
  void accept();
  void greet(bool open);
  /// Answers a hello. Throws Error if the server is refused.
  void welcome(std::unique_ptr<FrameStream>& stream, std::string_view frame, bool open);
  /// Throws Error if a server of that name is there.
  void expectNewName(const std::string& name);
  void dispatch(Server& server);
  void checkAway(Server& server, double patience);

  int listener_ = -1, port_ = 0;
  bool over_ = false;
  const std::string token_;
  Log& log_;
  std::vector<Newcomer> newcomers_;                         ///< the oldest first
  std::map<std::string, std::unique_ptr<Server>> servers_;  ///< by session
};

}  // namespace spark::spades
