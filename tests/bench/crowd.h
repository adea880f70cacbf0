#pragma once
/// \file
/// The agents' side over TCP: one thread replies for all agents and ignores the contents of their percepts.

#include <memory>
#include <string>
#include <vector>

#include "dialogue.h"

namespace spark::bench {

class Crowd {
 public:
  /// `line`: socket to the host's process (tcp_entrance.h).
  Crowd(const World& world, int line);
  ~Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;
  /// Connects agents on command and replies to every message until the host ends. Throws Error.
  void serve();

 private:
  struct Client;
  void readCommands();
  void execute(const std::string& command);
  void add(std::unique_ptr<Client> client);
  void receive(Client& client);
  const World& world_;
  int line_, events_, agentPort_ = 0, monitorPort_ = 0;
  bool over_ = false;
  std::string commands_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::size_t agents_ = 0;
};

}  // namespace spark::bench
