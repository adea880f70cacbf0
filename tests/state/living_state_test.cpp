/// saveState and loadState of objects in running worlds. A world runs and is saved at regular intervals. Each time the
/// state is loaded into a copy of the world in a second kernel. The copy is some cycles behind, so a field that is not
/// restored keeps an old value. Every node must then save the same bytes, and both worlds must continue with equal
/// hashes, and with equal values of all properties. The state of each class with saveState must differ from that of a
/// new object at least once.
#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "../contract/all_plugins.h"
#include "../readable.h"
#include "spark/error.h"
#include "worlds.h"

using namespace spark;
using namespace spark::test;

namespace {

constexpr int kBetween = 25, kTogether = 15;  // cycles from save to save, and those in which both worlds run

std::string treeState(const Leaf& leaf) {
  StateWriter out(true);
  saveTree(leaf, out);
  return out.bytes();
}

std::string propertyState(const Leaf& leaf) {
  StateWriter out(true);
  for (const Property* p : leaf.classObject()->stateProperties()) out.write(p->get(leaf));
  return out.bytes();
}

/// A node's own part of the saved state: its properties, and what its saveState writes.
struct Own {
  std::string path;
  ClassObject* type;
  std::string properties, hidden;
};

/// Appends `leaf` and the nodes below it, and returns their saved state.
std::string collect(const Leaf& leaf, std::vector<Own>& out) {
  const std::size_t mine = out.size();
  out.push_back({leaf.path(), leaf.classObject(), propertyState(leaf), {}});
  std::string all = treeState(leaf);
  std::size_t below = 0;
  if (const Node* node = leaf.asNode())
    for (const auto& c : node->children()) below += collect(*c, out).size();
  const std::size_t own = out[mine].properties.size();
  out[mine].hidden = all.substr(own, all.size() - below - own);
  return all;
}

std::vector<Own> nodesOf(World& world) {
  std::vector<Own> out;
  collect(world.kernel.root(), out);
  return out;
}

/// What saveState writes for a new object; "" for nothing.
std::string defaultState(ClassObject& type) {
  const auto object = type.create();
  std::vector<Own> out;
  collect(*object, out);
  return out.front().hidden;
}

/// Names of classes whose saveState has written something else than for a new object, over all worlds.
using Seen = std::set<std::string>;

void note(const std::vector<Own>& nodes, Seen& seen) {
  for (const Own& n : nodes)
    if (!n.hidden.empty() && n.type->plugin() && !seen.contains(n.type->name()) && n.hidden != defaultState(*n.type))
      seen.insert(n.type->name());
}

std::size_t firstDifference(const std::string& a, const std::string& b) {
  const std::size_t n = std::min(a.size(), b.size());
  return static_cast<std::size_t>(
             std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n), b.begin()).first - a.begin()) /
         8;
}

/// Compares the state of both worlds node by node.
void checkEqual(World& one, World& other) {
  const auto wanted = nodesOf(one), found = nodesOf(other);
  REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (found[i].properties == wanted[i].properties && found[i].hidden == wanted[i].hidden) continue;
    FAIL_CHECK(
        found[i].path << " (" << found[i].type->name() << "): its state differs from the saved one from word "
                      << firstDifference(wanted[i].properties + wanted[i].hidden, found[i].properties + found[i].hidden)
                      << " on");
  }
}

void play(const Scenario& scenario, Seen& seen) {
  World one, other;
  for (World* w : {&one, &other}) scenario.make(*w);
  checkEqual(one, other);
  REQUIRE(one.hash() == other.hash());
  bool together = true;
  for (int cycle = 1; cycle <= scenario.cycles; ++cycle) {
    scenario.input(one, cycle);
    one.cycle();
    if (together) {
      scenario.input(other, cycle);
      other.cycle();
      INFO(scenario.name << ", cycle " << cycle);
      if (one.hash() != other.hash()) checkEqual(one, other);
      REQUIRE(one.hash() == other.hash());
      if (const auto lines = readableDifferences(one.kernel, other.kernel); !lines.empty())
        FAIL_CHECK(fmt::format("{}", fmt::join(lines, "\n")));
    }
    if (cycle % kBetween == kTogether) together = false;
    if (cycle % kBetween != 0) continue;
    INFO(scenario.name << ", saved after cycle " << cycle);
    note(nodesOf(one), seen);
    const std::string saved = one.saved();
    other.load(saved);
    checkEqual(one, other);
    CHECK((other.saved() == saved));
    REQUIRE(other.hash() == one.hash());
    together = true;
  }
}

}  // namespace

TEST_CASE("The state of a running world is restored in another kernel, and both continue with equal hashes") {
  Seen seen;
  for (const Scenario& scenario : scenarios()) play(scenario, seen);
  AllPlugins host;
  std::string unseen;
  for (Plugin* plugin : pluginsOf(host.kernel))
    for (ClassObject* type : host.classesOf(*plugin))
      if (!type->isAbstract() && !seen.contains(type->name()) && !defaultState(*type).empty())
        unseen += " " + type->name();
  INFO(
      "Classes whose saveState only wrote the state of a new object. Add them to tests/state/scenarios.cpp:" << unseen);
  CHECK(unseen.empty());
}
