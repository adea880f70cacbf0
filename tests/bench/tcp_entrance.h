#pragma once
/// \file
/// The host's side of the way over TCP: agents are in another process, which is told over a line when to come.

#include "entrance.h"

namespace spark::bench {

/// Lockstep over the loopback. Lines to the crowd: `open AGENTPORT MONITORPORT`, `admit`, `watch`; each is answered by
/// one byte.
class TcpEntrance : public Entrance {
 public:
  explicit TcpEntrance(int line) : line_(line) {}
  void open(Kernel& kernel) override;
  void admit(const World&) override { tell("admit\n"); }
  void watch() override { tell("watch\n"); }

 private:
  void tell(const std::string& text);
  int line_;
};

}  // namespace spark::bench
