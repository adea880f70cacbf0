#pragma once
/// \file
/// The host over TCP: a sparkhost of its own, agents in threads of this program; the host's CPU time alone is counted.

namespace spark::bench {

/// What a host did for agents over TCP, per cycle [µs].
struct TcpResult {
  int agents = 0, cycles = 0;
  double cpu = 0;   ///< CPU time of the host process
  double wall = 0;  ///< wall time, agents included
};

/// Runs sparkhost in lockstep with sphere agents that drive, for `cycles` cycles. Throws Error when it does not come up.
TcpResult measureTcp(int agents, int cycles);

}  // namespace spark::bench
