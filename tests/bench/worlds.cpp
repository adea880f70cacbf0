#include "worlds.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::bench {

namespace {
/// The dense solver needs a quarter of a second for each cycle of a large heap.
int cycles(World::Motion motion, int count) { return count < 11 ? 400 : motion == World::Motion::heap ? 40 : 200; }

void addHumanoids(std::vector<World>& all, World::Motion motion, const char* name, const char* what) {
  for (const int count : {1, 2, 6, 11, 22})
    all.push_back({World::Kind::humanoids, motion, fmt::format("{}{}", name, count),
                   fmt::format("{} humanoid{}, {}", count, count > 1 ? "s" : "", what), count, cycles(motion, count)});
}
}  // namespace

const std::vector<World>& worlds() {
  static const std::vector<World> all = [] {
    std::vector<World> out{{World::Kind::field, World::Motion::rest, "empty", "empty field", 0, 2000}};
    addHumanoids(out, World::Motion::rest, "rest", "at rest");
    addHumanoids(out, World::Motion::moving, "moving", "moving");
    addHumanoids(out, World::Motion::heap, "heap", "fallen in a heap");
    out.push_back({World::Kind::boxes, World::Motion::moving, "boxes1000", "1,000 boxes", 1000, 200});
    for (const int count : {10, 100, 1000})
      out.push_back({World::Kind::spheres, World::Motion::moving, fmt::format("spheres{}", count),
                     fmt::format("{} sphere agents, driving", count == 1000 ? "1,000" : std::to_string(count)), count,
                     count < 1000 ? 1000 : 100});
    return out;
  }();
  return all;
}

const World& worldOf(std::string_view name) {
  return *std::find_if(worlds().begin(), worlds().end(), [name](const World& w) { return w.name == name; });
}

}  // namespace spark::bench
