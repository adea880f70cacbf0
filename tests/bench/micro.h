#pragma once
/// \file
/// Micro-benchmarks of small parts, with google-benchmark.

namespace spark::bench {

/// Runs all of them and prints google-benchmark's table, or its JSON.
void runMicro(bool json);

/// Registers what other times are compared with: copying memory, and a message over TCP and its answer.
void registerYardsticks();
/// Registers the cost of waking the kernel's threads for jobs, with and without work.
void registerJobs();
/// Registers the cost of the rays of 22 humanoids.
void registerRays();
/// Registers the cost of saving and restoring the state.
void registerSnapshots();
/// Registers the cost of messages: writing percepts and monitor frames, reading actions.
void registerBytes();

}  // namespace spark::bench
