/// saveState and loadState of objects in running worlds. A world runs and is saved at regular intervals. Each time the
/// state is loaded into a copy of the world in a second kernel. The copy is some cycles behind, so a field that is not
/// restored keeps an old value. Every node must then save the same bytes, and both worlds must continue with equal
/// hashes, and with equal values of all properties. So must a third world, which has not run since its beginning. The
/// state of each class with saveState must differ from that of a new object at least once, and another value in each
/// word of it must be restored.
#include <fmt/ranges.h>

#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <set>

#include "../contract/all_plugins.h"
#include "../readable.h"
#include "spark/error.h"
#include "worlds.h"

using namespace spark;
using namespace spark::test;

namespace {

constexpr int kFirst = 10;                    // cycles, in which a world gets its nodes
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

/// The protected functions that save and load what is no property.
struct Hidden : Leaf {
  using Leaf::loadState;
  using Leaf::saveState;
};

std::string hiddenOf(const Leaf& leaf) {
  StateWriter out(true);
  (leaf.*&Hidden::saveState)(out);
  return out.bytes();
}

/// Other values of a word, of which it is not known whether it is an integer, a truth or a number.
std::vector<std::uint64_t> others(std::uint64_t word) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  if (word >> 52 == 0) return {word ^ 1, bits(0.125)};
  const double number = std::bit_cast<double>(word);
  return {word ^ std::uint64_t{1} << 40, 0, bits(0.125), bits(number + 4 * kPi)};  // by two turns
}

/// True if another value in a word of the saved state makes a difference to what the object saves after it was loaded.
bool restores(Leaf& leaf, const std::string& saved, std::size_t at) {
  const auto load = [&leaf](const std::string& bytes) {
    StateReader in(bytes);
    (leaf.*&Hidden::loadState)(in);
  };
  std::uint64_t word = 0;
  std::memcpy(&word, &saved[8 * at], 8);
  for (const std::uint64_t value : others(word)) {
    std::string changed = saved;
    std::memcpy(&changed[8 * at], &value, 8);
    bool differs = true;
    try {
      load(changed);
      differs = hiddenOf(leaf) != saved;
    } catch (const std::exception&) {
      // a number of elements, or a kind
    }
    load(saved);
    if (differs) return true;
  }
  return false;
}

/// How many words of a class's saved state, at most, make no difference when they are loaded.
const std::map<std::string, std::size_t> kNotRestored{
    // What an axis has no use for: a suspension is the first axis' of a Hinge2Joint alone, motors have no coordinate,
    // that of a slider follows from its bodies.
    {"AngularMotor", 9},   {"Hinge2Joint", 2},     {"HingeJoint", 2}, {"SliderJoint", 3},
    {"UniversalJoint", 4}, {"BallStateAspect", 1},  // the number of kicks, which is 0 between cycles
    {"GameControl", 8},   // port and key of connections, which no player here has (tests/system/snapshot_test.cpp)
    {"ScriptServer", 1},  // the spare number of a random stream that has none
    {"World", 1},         // what the detector keeps beside its hash
};

/// The words of each class's saved state, and those of them that were restored in some object.
struct Words {
  std::size_t length = 0;
  std::set<std::size_t> restored;
};
using Restored = std::map<std::string, Words>;

void note(World& world, Restored& all) {
  for (const Own& n : nodesOf(world)) {
    Leaf& leaf = world.at(n.path);
    const std::string saved = hiddenOf(leaf);
    Words& w = all[n.type->name()];
    w.length = std::max(w.length, saved.size() / 8);
    for (std::size_t i = 0; i < saved.size() / 8; ++i)
      if (!w.restored.contains(i) && restores(leaf, saved, i)) w.restored.insert(i);
  }
}

void expectTwins(World& one, World& other, const Scenario& scenario, int cycle) {
  INFO(scenario.name << ", cycle " << cycle);
  if (one.hash() != other.hash()) checkEqual(one, other);
  REQUIRE(one.hash() == other.hash());
  if (const auto lines = readableDifferences(one.kernel, other.kernel); !lines.empty())
    FAIL_CHECK(fmt::format("{}", fmt::join(lines, "\n")));
}

void play(const Scenario& scenario, Seen& seen, Restored& restored) {
  World one, late, fresh;  // `late` is some cycles behind when it is loaded, `fresh` as it was in the beginning
  for (World* w : {&one, &late, &fresh}) scenario.make(*w);
  const auto run = [&scenario](World& w, int cycle) {
    scenario.input(w, cycle);
    w.cycle();
  };
  checkEqual(one, late);
  std::string initial;
  for (int cycle = 1; cycle <= scenario.cycles; ++cycle) {
    run(one, cycle);
    const bool together = (cycle - 1) % kBetween < kTogether;
    if (together) run(late, cycle), expectTwins(one, late, scenario, cycle);
    if (cycle <= kFirst || (together && cycle > kBetween)) run(fresh, cycle), expectTwins(one, fresh, scenario, cycle);
    if (cycle == kFirst) initial = fresh.saved();
    if (cycle % kBetween != 0) continue;
    INFO(scenario.name << ", saved after cycle " << cycle);
    note(nodesOf(one), seen);
    const std::string saved = one.saved();
    fresh.load(initial);
    for (World* w : {&late, &fresh}) {
      w->load(saved);
      checkEqual(one, *w);
      CHECK((w->saved() == saved));
      REQUIRE(w->hash() == one.hash());
    }
  }
  note(fresh, restored);
}

}  // namespace

TEST_CASE("The state of a running world is restored in another kernel, and both continue with equal hashes") {
  Seen seen;
  Restored restored;
  for (const Scenario& scenario : scenarios()) play(scenario, seen, restored);
  for (const auto& [name, words] : restored) {
    const auto known = kNotRestored.find(name);
    const std::size_t allowed = known == kNotRestored.end() ? 0 : known->second;
    std::vector<std::size_t> lost;
    for (std::size_t i = 0; i < words.length; ++i)
      if (!words.restored.contains(i)) lost.push_back(i);
    if (lost.size() > allowed)
      FAIL_CHECK(fmt::format(
          "{}: expected at most {} words of its saved state that loadState() does not restore, found {}: {}", name,
          allowed, lost.size(), fmt::join(lost, " ")));
  }
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
