#pragma once
/// \file
/// The simulations that are measured.

#include <memory>
#include <string>
#include <vector>

#include "entrance.h"
#include "spark/kernel.h"
#include "worlds.h"

namespace spark::bench {

/// The parameters of an instance.
struct Setup {
  World world;
  std::string solver = "dense";
  int threads = 1;
};

/// Mean wall time per cycle [µs], by phase of the cycle.
using Phases = std::vector<std::pair<std::string, double>>;

/// A kernel that runs one world. After construction it is loaded, at rest, and ready to be stepped.
class Instance {
 public:
  /// Builds the world, and has all agents connect through `entrance` and go to their positions. `entrance` must outlive
  /// the instance. Throws Error.
  Instance(const Setup& setup, Entrance& entrance);
  ~Instance();
  Kernel& kernel() { return kernel_; }
  const World& world() const { return setup_.world; }
  /// Steps the host.
  void run(std::int64_t cycles);
  /// Cycles since construction, when agents begin to move.
  std::int64_t cycles() const { return played_ - ready_; }
  void setThreads(int threads);
  /// Mean times since the last call.
  Phases phases();
  /// State hash of the whole tree.
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
