#pragma once
/// \file
/// A client with a robot, and a helper that applies its actions.

#include "arena.h"

namespace spark::test {

using ActionLog = std::vector<std::string>;

/// Connects and runs cycles until the first percepts have arrived.
inline Client robot(Arena& a, std::string_view scene = "(scene robot)", const std::string& port = "agents") {
  Client c = a.client(port);
  const auto before = a.agents();
  a.until([&] { return a.agents() > before; });
  c.send(scene);
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
  return c;
}

/// Runs cycles until the log has `wanted` actions.
inline void applyActions(Arena& a, std::size_t wanted) {
  a.until(
      [&] {
        a.cycle();
        return actionLog().size() >= wanted;
      },
      false);
}

}  // namespace spark::test
