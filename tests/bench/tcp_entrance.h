#pragma once
/// \file
/// The host's side over TCP. The agents are in another process, which gets commands over a socket.

#include "entrance.h"

namespace spark::bench {

/// Lockstep over the loopback interface. Commands to the crowd, one per line: `open AGENTPORT MONITORPORT`, `admit`,
/// `watch`. Each is acknowledged with one byte.
class TcpEntrance : public Entrance {
 public:
  explicit TcpEntrance(int line) : line_(line) {}
  void open(Kernel& kernel) override;
  void admit(const World&) override { command("admit\n"); }
  void watch() override { command("watch\n"); }

 private:
  void command(const std::string& text);
  int line_;
};

}  // namespace spark::bench
