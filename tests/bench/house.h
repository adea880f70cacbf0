#pragma once
/// \file
/// The houses that are measured.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "brain.h"
#include "spark/kernel.h"

namespace spark::bench {

/// One row of the bench.
struct Case {
  std::string name, title;
  int agents = 0;
  bool moving = false;
  bool needsReference = false;  ///< robots of the reference scenes
  int cycles = 400;             ///< measured by default
};

/// All rows in order.
const std::vector<Case>& cases();

/// The folder with the reference scenes' rsg/, empty where they are not present.
std::filesystem::path referenceScenes();

/// A kernel that plays one case, loaded, settled, and ready to be stepped.
class House {
 public:
  /// Builds it and lets everybody take his place. Throws Error.
  explicit House(const Case& c);
  Kernel& kernel() { return kernel_; }
  const Case& kind() const { return case_; }
  const std::vector<BenchBrain*>& brains() const { return brains_; }
  /// Steps the host.
  void run(std::int64_t cycles);
  /// Mean µs per cycle of each phase since the last call.
  std::vector<std::pair<std::string, double>> phases();

 private:
  void build();
  void runSoccer();
  void addAgents();
  void settle();
  Kernel kernel_;
  Case case_;
  Leaf* simulation_ = nullptr;
  std::vector<BenchBrain*> brains_;
};

}  // namespace spark::bench
