#pragma once
/// \file
/// How agents and a monitor get into a house: within the process or over TCP.

#include "local_port.h"

namespace spark::bench {

class Entrance {
 public:
  virtual ~Entrance() = default;
  /// The config ran; the house has not been stepped yet.
  virtual void open(Kernel& kernel) = 0;
  /// Lets the next agent in: when this returns, its first message can be read.
  virtual void admit(const World& world) = 0;
  /// Lets a monitor in.
  virtual void watch() = 0;
};

/// Within the process; the house has no network.
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
