#pragma once
/// \file
/// When a client that hangs gives way to its successor: a program that was started again while its predecessor, which
/// neither reads nor answers, still has its name.

#include "api/agents.h"
#include "spark/abi/api/succession.h"

namespace spark {

/// Decides whether an agent gives way to another one. Offered by game control.
class ISuccession {
 public:
  SPARK_INTERFACE(ISuccession, 1);
  virtual ~ISuccession() = default;
  /// The outcome of a claim.
  enum class Claim {
    refused,  ///< the holder is there
    waiting,  ///< the holder has not sent anything since the claim: claim again in the next cycle
    granted,  ///< the holder hung and is closed, or has left; its robot goes at the start of the next act phase
  };
  /// Another agent claims what only one can have and `holder` has, such as its number in a team. `again`: the last call
  /// of this claim, in the last cycle, returned `waiting`. Simulation thread.
  virtual Claim claim(AgentAspect& holder, bool again) = 0;
};

}  // namespace spark
