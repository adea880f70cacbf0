#pragma once
/// \file
/// Host against raw ODE, in pairs.

#include "house.h"

namespace spark::bench {

/// What one case gave; times are medians over blocks [µs of CPU time per cycle], of phases of wall time.
struct Result {
  int bodies = 0, joints = 0, agents = 0;
  double contacts = 0;             ///< contact joints per cycle on the raw side
  double raw = 0, host = 0;
  double ratio = 0;                ///< median of the blocks' own ratios
  double perAgent = 0;             ///< (host - raw) / agents
  std::vector<std::pair<std::string, double>> phases;
};

/// Measures one case. Raw and host step equal houses from equal states, in alternating blocks of a few cycles, so that what else the
/// machine does hits both alike.
Result measure(const Case& c, int cycles);

}  // namespace spark::bench
