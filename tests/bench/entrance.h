#pragma once
/// \file
/// How agents and a monitor connect to a simulation: within the process or over TCP.

#include "local_port.h"

namespace spark::bench {

class Entrance {
 public:
  virtual ~Entrance() = default;
  /// Called after the config has run and before the first cycle.
  virtual void open(Kernel& kernel) = 0;
  /// Connects the next agent. When this returns, its first message can be read.
  virtual void admit(const World& world) = 0;
  /// Connects a monitor.
  virtual void watch() = 0;
};

/// Within the process, without a network.
class LocalEntrance : public Entrance {
 public:
  void open(Kernel& kernel) override;
  void admit(const World& world) override { port_->admit(world); }
  void watch() override { port_->watch(); }
  LocalPort& port() { return *port_; }

 private:
  LocalPort* port_ = nullptr;
};

}  // namespace spark::bench
