#pragma once
/// \file
/// Connections within the process: the host parses and encodes every message, and no socket is involved.

#include <algorithm>
#include <memory>
#include <vector>

#include "api/net.h"
#include "api/phases.h"
#include "dialogue.h"
#include "spark/describe.h"

namespace spark::bench {

/// Number and sizes of the messages sent.
struct Traffic {
  std::int64_t messages = 0, bytes = 0, longest = 0;
  void add(std::int64_t size) { ++messages, bytes += size, longest = std::max(longest, size); }
  double mean() const { return messages ? static_cast<double>(bytes) / static_cast<double>(messages) : 0; }
};

/// A client that accepts every message at once and discards it.
class LocalConnection : public IConnection {
 public:
  LocalConnection(Node& port, std::uint64_t id);
  std::uint64_t id() const override { return id_; }
  const std::string& peer() const override { return peer_; }
  Node& port() override { return port_; }
  bool send(std::string_view message) override;
  bool idle() const override { return true; }
  double stalledSeconds() const override { return 0; }
  /// Throws Error: no connection is closed during a valid measurement.
  void close(std::string_view reason) override;

  Traffic traffic;

 private:
  Node& port_;
  std::uint64_t id_;
  std::string peer_;
};

/// Agents and a monitor within the process: a child of /sys/server that the run loop polls. An agent replies to each
/// message once, in the next cycle.
class LocalPort : public Node, public IInputSource {
  SPARK_CLASS(LocalPort, Node)
 public:
  static void describe(Description<LocalPort>& d);
  void poll() override;
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }

  /// Connects one more agent of the world.
  void admit(const World& world);
  /// Connects a monitor, which gets a full message at once.
  void watch();
  /// Resets the counters.
  void resetTraffic();
  /// Traffic to all agents, and to the monitor.
  Traffic percepts() const;
  Traffic frames() const { return monitor_ ? monitor_->traffic : Traffic{}; }

 private:
  struct Agent {
    LocalConnection connection;
    Dialogue dialogue;
    std::int64_t answered = -1, received = 0;
  };
  std::vector<std::unique_ptr<Agent>> agents_;
  std::unique_ptr<LocalConnection> monitor_;
};

}  // namespace spark::bench
