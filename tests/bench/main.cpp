#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "measure.h"
#include "spark/error.h"
#include "tcp.h"

// spark-bench: what the host costs above its solver.
//
//   case        the house that is measured (house.cpp)
//   raw         plain ODE calls on the bodies, joints, geoms and contacts of an equal house (raw_world.h)
//   host        the same in process: run loop, agents, perceptors, rules, encoders
//   ratio       host / raw, median over alternating blocks: noise of the machine hits both alike
//   per agent   what an agent costs above raw ODE
//
// Over TCP agents run in threads of this program; what is counted is the CPU time of the host process.

using namespace spark;
using namespace spark::bench;

namespace {
void printText(const Case& c, const Result& r) {
  fmt::print("{:<26} {:>6} {:>6} {:>8.0f} {:>10.1f} {:>10.1f} {:>7.2f} ", c.title, r.bodies, r.joints, r.contacts, r.raw, r.host, r.ratio);
  if (r.agents > 0) fmt::print("{:>10.1f}", r.perAgent);
  fmt::print("\n    µs per phase:");
  for (const auto& [name, micros] : r.phases) fmt::print(" {} {:.1f}", name, micros);
  fmt::print("\n");
  std::fflush(stdout);
}

std::string json(const Case& c, const Result& r) {
  std::string phases;
  for (const auto& [name, micros] : r.phases) phases += fmt::format("{}\"{}\":{:.2f}", phases.empty() ? "" : ",", name, micros);
  return fmt::format(
      "{{\"case\":\"{}\",\"bodies\":{},\"joints\":{},\"agents\":{},\"contacts\":{:.0f},\"rawMicros\":{:.2f},\"hostMicros\":{:.2f},\"ratio\":{:.4f},\"perAgentMicros\":{:.2f},\"phases\":{{{}}}}}",
      c.name, r.bodies, r.joints, r.agents, r.contacts, r.raw, r.host, r.ratio, r.perAgent, phases);
}

struct Options {
  std::string only;
  int cycles = 0;
  bool json = false;
};

void runCase(const Case& c, const Options& options, std::vector<std::string>& rows) {
  if (c.needsReference && referenceScenes().empty()) {
    if (options.json) rows.push_back(fmt::format("{{\"case\":\"{}\",\"skipped\":\"SPARK_REFERENCE_DIR names no reference scenes\"}}", c.name));
    else fmt::print("{:<26} skipped: SPARK_REFERENCE_DIR names no reference scenes\n", c.title);
    return;
  }
  const Result r = measure(c, options.cycles > 0 ? options.cycles : c.cycles);
  if (options.json) rows.push_back(json(c, r));
  else printText(c, r);
}

void runTcp(const Options& options, std::vector<std::string>& rows) {
  const TcpResult r = measureTcp(22, options.cycles > 0 ? options.cycles : 1000);
  if (options.json)
    rows.push_back(fmt::format("{{\"case\":\"tcp\",\"agents\":{},\"cycles\":{},\"hostCpuMicros\":{:.2f},\"perAgentMicros\":{:.2f},\"wallMicros\":{:.2f}}}", r.agents, r.cycles, r.cpu, r.cpu / r.agents,
                               r.wall));
  else
    fmt::print("{:<26} host CPU {:.1f} µs per cycle, {:.1f} per agent; wall {:.1f} µs per cycle with the agents' own work\n", "22 sphere agents over TCP", r.cpu, r.cpu / r.agents, r.wall);
}
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What the host adds to the solver's own time."};
  Options options;
  std::vector<std::string> names{"tcp"};
  for (const Case& c : cases()) names.push_back(c.name);
  app.add_option("--only", options.only, "Measures one case alone")->check(CLI::IsMember(names));
  app.add_option("--cycles", options.cycles, "Cycles to measure in each case")->check(CLI::Range(1, 1000000));
  app.add_flag("--json", options.json, "Prints one JSON array instead of a table");
  CLI11_PARSE(app, argc, argv);
  std::vector<std::string> rows;
  try {
    if (!options.json) fmt::print("{:<26} {:>6} {:>6} {:>8} {:>10} {:>10} {:>7} {:>10}\n", "case", "bodies", "joints", "contacts", "raw µs", "host µs", "ratio", "µs/agent");
    for (const Case& c : cases())
      if (options.only.empty() || options.only == c.name) runCase(c, options, rows);
    if (options.only.empty() || options.only == "tcp") runTcp(options, rows);
  } catch (const std::exception& e) {
    fmt::print(stderr, "spark-bench: {}\n", e.what());
    return 1;
  }
  if (options.json) {
    fmt::print("[");
    for (std::size_t i = 0; i < rows.size(); ++i) fmt::print("{}{}", i ? ",\n " : "", rows[i]);
    fmt::print("]\n");
  }
  return 0;
}
