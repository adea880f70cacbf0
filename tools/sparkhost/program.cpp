#include "program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "describe.h"
#include "host.h"
#include "spark/error.h"
#include "status_line.h"

// Exit codes: 0 as asked; 1 the run itself failed; 2 the command line, the config, a plugin or a scene is wrong (stderr says how).
// stdout carries JSON lines (or the text of --list-plugins and --describe), everything else goes to stderr.

namespace {

spark::Kernel* stopOnSignal = nullptr;

extern "C" void onSignal(int) { stopOnSignal->requestStop(); }

/// The first SIGINT or SIGTERM ends the run cleanly, a second one as the system does.
void watchSignals(spark::Kernel& kernel) {
  stopOnSignal = &kernel;
  struct sigaction action = {};
  action.sa_handler = onSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

void printLine(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

/// Runs a step of the program; an error goes to stderr and ends it with `code`.
template <class F>
void orExit(int code, F step) {
  try {
    step();
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkhost: {}\n", e.what());
    std::exit(code);
  }
}

void printDescriptions(spark::Kernel& kernel, const sparkhost::Options& options) {
  if (options.listPlugins) fmt::print("{}", sparkhost::pluginList(kernel));
  if (!options.describe.empty()) fmt::print("{}", sparkhost::classDescription(kernel, options.describe));
}

/// What a run only logs, and goes on without, fails a check.
void checkLog(spark::Kernel& kernel) {
  if (const auto n = kernel.log().errors(); n > 0)
    throw spark::Error(fmt::format("the check failed: {} in the log above (--log-level error shows them alone).", n == 1 ? "1 error" : fmt::format("{} errors", n)));
}

void runHouse(sparkhost::Host& host, const std::string& firstLine, bool histogram) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  sparkhost::StatusLine::install(host.kernel(), terminal);
  printLine(firstLine);
  const std::string lastLine = host.run();
  if (terminal) fmt::print(stderr, "\n");
  if (histogram) fmt::print(stderr, "{}", host.histogram());
  printLine(lastLine);
}

}  // namespace

int sparkhost::runProgram(int argc, char** argv) {
  Options options;
  if (const auto code = readOptions(argc, argv, options)) return *code;
  std::optional<Host> host;
  std::string firstLine;
  orExit(2, [&] {
    host.emplace(options);
    if (options.config.empty()) return printDescriptions(host->kernel(), options);
    watchSignals(host->kernel());
    host->build();
    if (options.check) checkLog(host->kernel());
    if (!options.check) firstLine = host->open();
  });
  if (!firstLine.empty()) orExit(1, [&] { runHouse(*host, firstLine, options.histogram); });
  return 0;
}
