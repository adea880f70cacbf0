#pragma once
/// \file
/// Robots on top of each other.

#include "spark/kernel.h"

namespace spark::bench {

/// Lays all agents down and on top of each other, two a layer, just above the ground: they fall into one heap within
/// some 100 cycles.
void pileUp(Kernel& kernel);

}  // namespace spark::bench
