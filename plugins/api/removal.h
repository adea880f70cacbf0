#pragma once
/// \file
/// What requests from outside may not remove.

#include <fmt/format.h>

#include <string_view>

#include "spark/abi/api/removal.h"
#include "spark/error.h"
#include "spark/node.h"

namespace spark {

/// Throws Error if calling `method` on `target` would remove a server, or something below or above one. For requests
/// from outside, which a server among /sys/server, `answers`, answers: the run loop and that server are on the call
/// stack, and clients of all servers are connected.
inline void refuseRemovingServers(const Leaf& target, std::string_view method, const Leaf& answers) {
  if (method != "unlinkLeaf" && method != "unlinkChildren") return;
  bool inServers = false;
  for (const Leaf* up = &target; up; up = up->parent()) inServers |= up == answers.parent();
  for (const Leaf* up = &answers; up; up = up->parent()) inServers |= up == &target;
  if (inServers)
    throw Error(fmt::format("cannot remove {} while the simulation runs: servers stay until its end", target.path()));
}

}  // namespace spark
