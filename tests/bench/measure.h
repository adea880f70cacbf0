#pragma once
/// \file
/// Compares the host with raw ODE in pairs of blocks.

#include "child.h"
#include "house.h"

namespace spark::bench {

/// How agents connect to the host.
enum class Way { host, tcp };
const char* nameOf(Way way);

/// Measures one world in one way in a separate process. Raw side and host step equal instances. Before each block of a
/// few cycles the raw side gets the host's state, and blocks alternate, so other load affects both alike. With several
/// threads the host's blocks alternate between one thread and all of them. Returns rows (README.md), the row of raw ODE
/// first. Throws Error.
Json measure(const Setup& setup, Way way, int cycles);

/// The `share`-quantile (0..1) of the numbers; 0 if there are none.
double quantile(std::vector<double> numbers, double share);
inline double median(std::vector<double> numbers) { return quantile(std::move(numbers), 0.5); }

}  // namespace spark::bench
