#pragma once
/// \file
/// Host against raw ODE, in pairs of blocks.

#include "child.h"
#include "house.h"

namespace spark::bench {

/// How a host is reached.
enum class Way { host, tcp };
const char* nameOf(Way way);

/// Measures one world one way in a process of its own. Raw and host step equal houses: before each block of a few
/// cycles the raw side is put into the host's state, and blocks alternate, so that what else the machine does hits both
/// alike. With several threads the host's blocks alternate between one thread and these. Returns rows (README.md), that
/// of raw ODE first. Throws Error.
Json measure(const Setup& setup, Way way, int cycles);

/// What a share (0..1) of some numbers does not exceed; 0 when there are none.
double quantile(std::vector<double> numbers, double share);
inline double median(std::vector<double> numbers) { return quantile(std::move(numbers), 0.5); }

}  // namespace spark::bench
