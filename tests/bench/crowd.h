#pragma once
/// \file
/// The agents' side of the way over TCP: one thread answers for all, without reading what it is told.

#include <memory>
#include <string>
#include <vector>

#include "dialogue.h"

namespace spark::bench {

class Crowd {
 public:
  /// `line`: to the host's process (tcp_entrance.h).
  Crowd(const World& world, int line);
  ~Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;
  /// Comes when told and answers every message, until the host ends. Throws Error.
  void serve();

 private:
  struct Client;
  void obey();
  void obey(const std::string& command);
  void add(std::unique_ptr<Client> client);
  void hear(Client& client);
  const World& world_;
  int line_, events_, agentPort_ = 0, monitorPort_ = 0;
  bool over_ = false;
  std::string said_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::size_t agents_ = 0;
};

}  // namespace spark::bench
