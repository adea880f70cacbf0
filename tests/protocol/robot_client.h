#pragma once
/// \file
/// A client with a robot, and what robots did.

#include "arena.h"

namespace spark::test {

using Deeds = std::vector<std::string>;

/// Connects and cycles until the first percepts are there.
inline Client robot(Arena& a, std::string_view scene = "(scene robot)", const std::string& port = "agents") {
  Client c = a.client(port);
  const auto before = a.agents();
  a.until([&] { return a.agents() > before; });
  c.send(scene);
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
  return c;
}

/// Delivers what clients sent and realises it in one cycle.
inline void realise(Arena& a, std::size_t deedsWanted) {
  a.until(
      [&] {
        a.cycle();
        return deeds().size() >= deedsWanted;
      },
      false);
}

}  // namespace spark::test
