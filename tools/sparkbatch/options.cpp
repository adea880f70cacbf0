#include "options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "common_options.h"

namespace sparkbatch {

namespace {
constexpr int kUsageError = 2;

/// Splits `KEY=TEXT`. Throws CLI::ValidationError.
std::pair<std::string, std::string> splitSetting(const char* option, const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == 0 || at == std::string::npos)
    throw CLI::ValidationError(option, fmt::format("expected KEY={}, found '{}'",
                                                   std::string_view(option) == "--set" ? "VALUE" : "A,B,...", text));
  return {text.substr(0, at), text.substr(at + 1)};
}

/// `/path.property` or `NAME=/path.property`.
Report readReport(const std::string& text) {
  Report r;
  const std::size_t at = text.find('=');
  const std::string where = at == std::string::npos ? text : text.substr(at + 1);
  r.column = text.substr(0, at);
  const std::size_t dot = where.rfind('.');
  if (r.column.empty() || where.empty() || where.front() != '/' || dot == std::string::npos || dot < where.rfind('/') ||
      dot + 1 == where.size())
    throw CLI::ValidationError("--report",
                               fmt::format("expected /path.property or NAME=/path.property, found '{}'", text));
  r.path = where.substr(0, dot);
  r.property = where.substr(dot + 1);
  return r;
}

void checkResults(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension();
  if (extension != ".csv" && extension != ".jsonl")
    throw CLI::ValidationError(
        "--results",
        fmt::format("expected a file that ends in .csv or .jsonl (a JSON object a line), found '{}'", file));
}
}  // namespace

std::optional<int> readOptions(int argc, char** argv, bool print, Options& out) {
  CLI::App app{
      "Runs many worlds of one Spark config: seeds, sweeps of settings; over threads, and over machines when mpirun "
      "starts it.",
      "sparkbatch"};
  std::vector<std::string> settings, sweep, reports;
  app.set_version_flag("--version", "sparkbatch " SPARK_VERSION);
  app.add_option("--config", out.config, "Lua config, looked up in the working folder, then in the installed share")
      ->type_name("FILE");
  auto* from = app.add_option("--from", out.from,
                              "Runs branch from a snapshot (sparkctl snapshot), or from the last state of a recording, "
                              "with its config and files; --set, --sweep and seeds count from there on")
                   ->type_name("FILE")
                   ->check(CLI::ExistingFile)
                   ->excludes("--config");
  app.add_option(
         "--at", out.at,
         "With --from a recording: branch at this simulated time [s], which is simulated from the last state before")
      ->type_name("SECONDS")
      ->needs(from);
  app.add_option("--results", out.results, "The table, one row a run: .csv or .jsonl")->type_name("FILE")->required();
  app.add_option("--runs", out.seeds, "Runs of each combination, each with a seed of its own (default 1)")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", out.seed, "Seed of the first; the others count up (default 1)")
      ->type_name("N")
      ->check(sparkhost::checkSeed);
  app.add_option(
         "--duration", out.duration,
         "A run ends at this simulated time [s], counted from the start also with --from; 0: when the config ends it")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--set", settings, "As for sparkhost, the same in every run; {run} and {seed} in V become the run's")
      ->type_name("K=V")
      ->allow_extra_args(false);
  app.add_option("--sweep", sweep, "Runs every value of K, in every combination with other sweeps")
      ->type_name("K=A,B,...")
      ->allow_extra_args(false);
  app.add_option("--report", reports, "A column with this property at the run's end")
      ->type_name("[NAME=]/PATH.PROPERTY")
      ->allow_extra_args(false);
  app.add_option("--threads", out.threads, "Worlds at a time in this process (default: its processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  app.add_flag("--resume", out.resume, "Continues an existing table: executes only runs without a row");
  app.add_flag("--retry", out.retry, "With --resume: removes rows with an error and executes their runs again")
      ->needs("--resume");
  sparkhost::addForce(app, out.force)->excludes("--resume");
  sparkhost::addCommonOptions(app, out.pluginPaths, out.scenePaths, out.logLevel,
                              "Minimum level of log lines of worlds on stderr");
  app.footer(
      "stdout: one JSON line at the end. Exit code 0: every run has a row; 1: some rows are errors; 2: nothing "
      "was run; 3: it was interrupted.");
  try {
    app.parse(argc, argv);
    if (out.config.empty() && out.from.empty()) throw CLI::RequiredError("--config");
    checkResults(out.results);
    if (out.seed + static_cast<std::uint64_t>(out.seeds - 1) < out.seed)
      throw CLI::ValidationError(
          "--seed", fmt::format("expected seeds of 64 bits; {} runs from {} on go beyond", out.seeds, out.seed));
    for (const std::string& s : settings) out.settings.push_back(splitSetting("--set", s));
    for (const std::string& s : sweep) {
      const auto [key, values] = splitSetting("--sweep", s);
      for (const Parameter& p : out.sweep)
        if (p.key == key)
          throw CLI::ValidationError(
              "--sweep", fmt::format("expected each KEY once, found '{}' twice: say all of its values at once", key));
      out.sweep.push_back({key, splitValues(values)});
    }
    for (const std::string& r : reports) out.reports.push_back(readReport(r));
  } catch (const CLI::ParseError& e) {
    std::ostringstream nowhere;
    return (print ? app.exit(e) : app.exit(e, nowhere, nowhere)) == 0 ? 0 : kUsageError;
  }
  sparkhost::makeAbsolute(out.pluginPaths);
  sparkhost::makeAbsolute(out.scenePaths);
  if (!out.from.empty())
    for (std::string* file : {&out.from, &out.results}) *file = std::filesystem::absolute(*file).string();
  return std::nullopt;
}

}  // namespace sparkbatch
