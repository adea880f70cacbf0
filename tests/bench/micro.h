#pragma once
/// \file
/// Small parts by themselves, with google-benchmark.

namespace spark::bench {

/// Runs all of them and prints google-benchmark's table, or its JSON.
void runMicro(bool json);

/// What it takes to wake the kernel's threads for a few jobs, and to run many small ones.
void registerJobs();
/// What messages cost: percepts and monitor frames written, actions read.
void registerBytes();

}  // namespace spark::bench
