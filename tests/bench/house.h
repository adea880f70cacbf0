#pragma once
/// \file
/// The houses that are measured.

#include <memory>
#include <string>
#include <vector>

#include "entrance.h"
#include "spark/kernel.h"
#include "worlds.h"

namespace spark::bench {

/// How a house is to be built.
struct Setup {
  World world;
  std::string solver = "dense";
  int threads = 1;
};

/// Mean µs of wall time per cycle, by part of the cycle.
using Phases = std::vector<std::pair<std::string, double>>;

/// A kernel that plays one world: loaded, settled, and ready to be stepped.
class House {
 public:
  /// Builds it and lets everybody come in through `entrance` (which outlives it) and take his place. Throws Error.
  House(const Setup& setup, Entrance& entrance);
  ~House();
  Kernel& kernel() { return kernel_; }
  const World& world() const { return setup_.world; }
  /// Steps the host.
  void run(std::int64_t cycles);
  /// Cycles since it was ready, and agents began to move.
  std::int64_t cycles() const { return played_ - ready_; }
  void setThreads(int threads);
  /// Means since the last call.
  Phases phases();
  /// Of the whole tree.
  std::uint64_t hash();

 private:
  void build();
  void admitAgents();
  Kernel kernel_;
  Setup setup_;
  Entrance& entrance_;
  Leaf* simulation_ = nullptr;
  std::int64_t played_ = 0, ready_ = 0;
};

}  // namespace spark::bench
