#include <fmt/format.h>
#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "loading.h"
#include "measure.h"
#include "micro.h"
#include "realtime.h"
#include "report.h"
#include "validate.h"

// sparkbench measures what the host adds to the solver's own time in the standard worlds (README.md).

using namespace spark;
using namespace spark::bench;

namespace {
struct Options {
  std::vector<std::string> only;
  std::vector<std::string> ways{"host", "tcp"};
  int cycles = 0, threads = 1;
  double realtime = 0;
  std::vector<std::string> solvers{"dense"};
  std::string csv, history, chart;
  bool json = false, validate = false, micro = false, loading = false;
};

std::vector<World> wanted(const Options& options) {
  std::vector<World> out;
  for (const World& w : worlds())
    if (options.only.empty() || std::find(options.only.begin(), options.only.end(), w.name) != options.only.end())
      out.push_back(w);
  return out;
}

bool wants(const Options& o, const char* way) { return std::find(o.ways.begin(), o.ways.end(), way) != o.ways.end(); }

/// All rows of a world, with the row of raw ODE only once.
Json measureWorld(const Setup& setup, const Options& options) {
  const int cycles = options.cycles > 0 ? options.cycles : setup.world.cycles;
  Json rows = Json::array();
  for (const Way way : {Way::host, Way::tcp}) {
    if (!wants(options, nameOf(way)) || (way == Way::tcp && setup.world.agents() == 0)) continue;
    for (Json& r : measure(setup, way, cycles))
      if (rows.empty() || r["way"] != "raw") rows.push_back(std::move(r));
  }
  return rows;
}

void readOptions(CLI::App& app, Options& o) {
  std::vector<std::string> names;
  for (const World& w : worlds()) names.push_back(w.name);
  app.add_option("--only", o.only, "Worlds to measure, e.g. moving22,rest22")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--way", o.ways, "How: host (in process), tcp (agents over TCP in lockstep)")
      ->delimiter(',')
      ->check(CLI::IsMember({"host", "tcp"}));
  app.add_option("--cycles", o.cycles, "Cycles to measure in each world")->check(CLI::Range(1, 1000000));
  app.add_option("--threads", o.threads, "Also measures with this number of host threads")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--solver", o.solvers, "The host's solvers; raw ODE is dWorldStep with each")
      ->delimiter(',')
      ->check(CLI::IsMember({"dense", "articulated"}))
      ->capture_default_str();
  app.add_option("--csv", o.csv, "Writes all rows to a file")->type_name("FILE");
  app.add_option("--chart", o.chart, "Draws the CPU time of a cycle, raw ODE and host, as SVG")->type_name("FILE");
  app.add_option("--history", o.history,
                 "Appends the main figures to this machine's file in a folder, e.g. tests/bench/history")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
  app.add_flag("--json", o.json, "Prints a JSON array of rows instead of a table");
  app.add_flag("--validate-hash", o.validate,
               "Instead: checks that a world has the same state hash measured, unmeasured, repeated, and with threads");
  app.add_flag("--loading", o.loading, "Instead: the cost of a robot that joins or leaves, in a match of 22 robots");
  app.add_flag("--micro", o.micro, "Instead: micro-benchmarks of small parts");
  app.add_option("--realtime", o.realtime,
                 "Instead: runs in real time over TCP for this time, and shows how late and how long the cycles were")
      ->type_name("SECONDS")
      ->check(CLI::Range(1.0, 3600.0));
}

void print(const World& world, const Json& rows, const Options& o) {
  if (!o.json) printRows(world, rows);
}

int run(const Options& o) {
  if (o.micro) return runMicro(o.json), 0;
  if (o.loading) return runLoading(o.json), 0;
  Json all = Json::array();
  bool good = true;
  if (!o.json && o.realtime <= 0 && !o.validate) printHead();
  for (const World& world : wanted(o))
    for (const std::string& solver : o.solvers) {
      const Setup setup{world, solver, o.threads};
      Json rows;
      if (o.realtime > 0) {
        rows = realtime(setup, o.realtime, !o.json);
      } else if (o.validate) {
        rows = validate(setup, o.cycles > 0 ? o.cycles : 40, !o.json);
        for (const Json& r : rows) good = good && r["same"].get<bool>();
      } else {
        rows = measureWorld(setup, o);
        print(world, rows, o);
      }
      all.insert(all.end(), rows.begin(), rows.end());
    }
  if (o.json) fmt::print("{}\n", all.dump(1));
  if (!o.csv.empty()) writeCsv(all, o.csv);
  if (!o.chart.empty()) writeChart(all, o.chart);
  if (!o.history.empty()) fmt::print(stderr, "appended to {}\n", appendHistory(all, o.history).string());
  return good ? 0 : 1;
}
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures what the host adds to the solver's own time.", "sparkbench"};
  Options options;
  readOptions(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkbench: {}\n", e.what());
    return 1;
  }
}
