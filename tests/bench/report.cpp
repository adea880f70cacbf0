#include "report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <span>

#include "bar_chart.h"
#include "machine.h"
#include "spark/error.h"
#include "worlds.h"

namespace spark::bench {

namespace fs = std::filesystem;

namespace {
constexpr std::array kColumns{"world",
                              "way",
                              "threads",
                              "solver",
                              "agents",
                              "bodies",
                              "awake",
                              "joints",
                              "contacts",
                              "cpuMicros",
                              "wallMicros",
                              "ratio",
                              "speedup",
                              "cyclesPerSecond",
                              "agentStepsPerSecond",
                              "cpuPerSimulatedSecond",
                              "peakMegabytes",
                              "perceptBytes",
                              "monitorFullBytes",
                              "monitorPartialBytes",
                              "collide",
                              "solve",
                              "input",
                              "act",
                              "prepare",
                              "physics",
                              "place",
                              "rule",
                              "sense",
                              "publish",
                              "hash"};
constexpr std::array kHistory{"world", "way", "threads", "solver", "cpuMicros", "wallMicros", "ratio", "peakMegabytes"};
constexpr std::array kParts{"collide", "solve", "input", "act",   "prepare",
                            "physics", "place", "rule",  "sense", "publish"};

std::string cell(const Json& row, const char* column) {
  const auto it = row.find(column);
  if (it == row.end()) return "";
  if (it->is_number_float()) return fmt::format("{:.6g}", it->get<double>());
  return it->is_string() ? it->get<std::string>() : it->dump();
}

std::string line(const Json& row, std::span<const char* const> columns) {
  std::string out;
  for (const char* c : columns) out += (out.empty() ? "" : ",") + cell(row, c);
  return out + "\n";
}

std::string head(std::span<const char* const> columns) { return fmt::format("{}\n", fmt::join(columns, ",")); }

double number(const Json& row, const char* name) { return row.value(name, 0.0); }

/// A number; "" if the row does not have it.
std::string shown(const Json& row, const char* name, const char* format) {
  return row.contains(name) ? fmt::format(fmt::runtime(format), number(row, name)) : "";
}

/// Model name of the processor, as a file name.
std::string processorAsName() {
  std::string out;
  for (const char c : test::processor())
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}
}  // namespace

void printHead() {
  fmt::print("{:<26} {:<5} {:>7} {:>10} {:>10} {:>7} {:>8} {:>10} {:>12} {:>9} {:>8}\n", "world", "way", "threads",
             "CPU us", "wall us", "x raw", "speedup", "cycles/s", "agent steps/s", "CPU s/s", "peak MB");
}

void printRows(const World& world, const Json& rows) {
  for (const Json& r : rows) {
    const bool raw = r["way"] == "raw";
    fmt::print("{:<26} {:<5} {:>7} {:>10.1f} {:>10.1f} {:>7} {:>8} {:>10.0f} {:>12.0f} {:>9.4f} {:>8}\n",
               raw ? world.title : "", r["way"].get<std::string>(), r["threads"].get<int>(), number(r, "cpuMicros"),
               number(r, "wallMicros"), shown(r, "ratio", "{:.3f}"), shown(r, "speedup", "{:.2f}"),
               number(r, "cyclesPerSecond"), number(r, "agentStepsPerSecond"), number(r, "cpuPerSimulatedSecond"),
               shown(r, "peakMegabytes", "{:.1f}"));
    std::string parts;
    for (const char* p : kParts)
      if (r.contains(p)) parts += fmt::format(" {} {:.1f}", p, number(r, p));
    if (raw)
      parts += fmt::format("; {} bodies ({:.0f} awake), {} joints, {:.0f} contacts, {}", r["bodies"].get<int>(),
                           number(r, "awake"), r["joints"].get<int>(), number(r, "contacts"),
                           r["solver"].get<std::string>());
    if (r.contains("monitorFullBytes"))
      parts += fmt::format("; bytes: percept {:.0f}, monitor full {:.0f}, partial {:.0f}", number(r, "perceptBytes"),
                           number(r, "monitorFullBytes"), number(r, "monitorPartialBytes"));
    if (r.contains("hash")) parts += "; hash " + r["hash"].get<std::string>();
    fmt::print("{:>32}:{}\n", "us", parts);
  }
  std::fflush(stdout);
}

void writeCsv(const Json& rows, const fs::path& file) {
  std::ofstream out(file);
  out << head(kColumns);
  for (const Json& r : rows) out << line(r, kColumns);
  if (!out) throw Error(fmt::format("cannot write {}", file.string()));
}

void writeChart(const Json& rows, const fs::path& file) {
  std::vector<test::BarGroup> groups;
  for (const World& world : worlds()) {
    test::BarGroup group{world.title + ", one cycle", {}};
    for (const Json& r : rows) {
      if (r["world"] != world.name || r["threads"] != 1 || r["way"] == "tcp") continue;
      const bool raw = r["way"] == "raw";
      if (raw && !group.bars.empty()) continue;  // of another solver of the host
      group.bars.push_back({raw ? "ODE alone" : fmt::format("Spark, {} solver", r["solver"].get<std::string>()),
                            number(r, "cpuMicros"),
                            raw ? fmt::format("{:.0f} us", number(r, "cpuMicros"))
                                : fmt::format("{:.0f} us, {:.2f} x", number(r, "cpuMicros"), number(r, "ratio")),
                            raw});
    }
    if (!group.bars.empty()) groups.push_back(std::move(group));
  }
  std::ofstream out(file);
  out << test::barChart("CPU time of a cycle: physics alone, and the whole host", groups,
                        fmt::format("The host also parses actions, writes percepts and serves a monitor. {}; {}.",
                                    test::machine(), test::commitAndDate(SPARK_SOURCES)));
  if (!out) throw Error(fmt::format("cannot write {}", file.string()));
}

fs::path appendHistory(const Json& rows, const fs::path& folder) {
  const fs::path file = folder / (processorAsName() + ".csv");
  const bool fresh = !fs::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "date,commit," << head(kHistory);
  const std::string stamp = fmt::format("{:%Y-%m-%d},{},", fmt::gmtime(std::time(nullptr)), test::commit(folder));
  for (const Json& r : rows) out << stamp << line(r, kHistory);
  if (!out) throw Error(fmt::format("cannot write {}", file.string()));
  return file;
}

}  // namespace spark::bench
