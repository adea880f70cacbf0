/// Worlds without clients have the committed state hash after a number of cycles (hashes.txt in this folder).
///
/// The first row is a hash of sines, powers and similar functions. If it differs, the C library returns other digits
/// than on the machine that wrote the file, and the worlds differ for that reason. For processors with FMA, glibc has
/// variants of these functions with other last digits. They are switched off here, so the rows are valid on every
/// x86-64 machine with the same version of glibc.

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "spark/script_server.h"
#include "spark/state.h"
#include "test_support.h"

using namespace spark;

namespace {

constexpr const char* kFile = SPARK_SOURCES "/tests/golden/hashes.txt";

/// glibc reads the variable before main, so the program sets it and executes itself again.
const bool restarted = [] {
  const std::string name = "GLIBC_TUNABLES", wanted = "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2";
  if (const char* set = std::getenv(name.c_str()); set && set == wanted) return true;
  setenv(name.c_str(), wanted.c_str(), 1);
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(in), {}};
  std::vector<char*> arguments;
  for (std::size_t i = 0; i < all.size(); i += std::strlen(&all[i]) + 1)
    arguments.push_back(const_cast<char*>(&all[i]));
  arguments.push_back(nullptr);
  execv("/proc/self/exe", arguments.data());
  return false;
}();

std::uint64_t mathHash() {
  StateWriter out(false);
  for (int i = 1; i <= 1000; ++i) {
    const double x = 0.0137 * i;
    for (const double y : {std::sin(x), std::cos(x), std::tan(x), std::atan2(x, 3 - x), std::acos(x / 14), std::exp(x),
                           std::log(x), std::pow(x, 1.7)})
      out.write(y);
  }
  return out.hash();
}

/// The state hash of a config after `cycles`.
std::uint64_t worldHash(const std::string& config, const std::vector<std::pair<std::string, Value>>& settings,
                        int cycles) {
  test::TestHost host;
  ScriptServer& lua = scripts(host.kernel);
  lua.addFolder(SPARK_SOURCES "/lua");
  lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = {}, alone = true }", "golden");
  for (const auto& [key, value] : settings) lua.addOverride(key, value);
  lua.runConfig(config);
  Leaf& simulation = host.kernel.root().require<Leaf>("/sys/server/simulation");
  setProperty(simulation, "rate", "max");
  if (Leaf* net = host.kernel.root().find("/sys/server/net")) setProperty(*net, "open", false);
  callMethod(simulation, "runCycles", std::vector<Value>{cycles});
  return stateHash(host.kernel.root());
}

struct Row {
  const char* name;
  int cycles;
  std::uint64_t hash;
};

std::vector<Row> measured() {
  constexpr int kBoxes = 500, kSpheres = 3000, kHumanoids = 400;
  const auto humanoids = [](std::vector<std::pair<std::string, Value>> more) {
    more.insert(
        more.end(),
        {{"team", "Red Blue"}, {"players", 2}, {"Soccer.AutomaticKickOff", true}, {"Soccer.WaitBeforeKickOff", 1}});
    return worldHash("soccer.lua", more, kHumanoids);
  };
  return {{"math", 0, mathHash()},
          {"boxes", kBoxes, worldHash("boxes.lua", {}, kBoxes)},
          {"soccer-sphere", kSpheres,
           worldHash("soccer-sphere.lua", {{"team", "Red Blue"}, {"Soccer.RuleHalfTime", 20}}, kSpheres)},
          {"soccer", kHumanoids, humanoids({})},
          {"soccer-without-exact-replay", kHumanoids, humanoids({{"exactReplay", false}})},
          {"soccer-articulated", kHumanoids, humanoids({{"solver", "articulated"}})}};
}

std::string lineOf(const Row& row) { return fmt::format("{} {} {:016x}", row.name, row.cycles, row.hash); }

void write(const std::vector<Row>& rows) {
  std::ofstream out(kFile);
  out << "# world, cycles, state hash. Written by: SPARK_RENEW=1 build/release/tests/test-golden\n";
  for (const Row& row : rows) out << lineOf(row) << "\n";
}

}  // namespace

TEST_CASE("Worlds have the committed state hash") {
  REQUIRE(restarted);
  const std::vector<Row> rows = measured();
  if (std::getenv("SPARK_RENEW")) write(rows);
  std::vector<std::string> committed;
  std::ifstream in(kFile);
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("#")) committed.push_back(line);
  REQUIRE(committed.size() == rows.size());
  INFO(
      "If the change is meant to alter the course of matches: run SPARK_RENEW=1 build/release/tests/test-golden, and "
      "commit tests/golden/hashes.txt.");
  INFO("If `math` differs, the C library is a different one.");
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(lineOf(rows[i]) == committed[i]);
}
