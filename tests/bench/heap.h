#pragma once
/// \file
/// A heap of robots.

#include "spark/kernel.h"

namespace spark::bench {

/// Lays all robots on top of each other, two per layer, just above the ground. They collapse into one heap within about
/// 100 cycles.
void pileUp(Kernel& kernel);

}  // namespace spark::bench
