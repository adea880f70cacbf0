#include "program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "convert.h"
#include "crash_report.h"
#include "describe.h"
#include "hang_watch.h"
#include "hash_log.h"
#include "host.h"
#include "output.h"
#include "recorded_run.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "spark/printable.h"
#include "state_at.h"
#include "status_line.h"

// Exit codes: 0: success; 1: the run failed, or stdout could not be written; 2: an error in the command line, the
// config, a plugin or a scene. stdout gets JSON lines (or the text of --list-plugins and --describe), everything else
// goes to stderr.

namespace {

spark::Kernel* stopOnSignal = nullptr;

volatile std::sig_atomic_t isLoading = 0;  // configs, scenes and meshes are read

extern "C" void onSignal(int) {
  stopOnSignal->requestStop();
  // A config stops at its next line; what it has called, such as the reader of a large file, does not ask.
  if (isLoading) ::alarm(1);
}

extern "C" void onAlarm(int) {
  if (!isLoading) return;
  constexpr std::string_view kText = "sparkhost: stopped by a signal while loading\n";
  if (::write(STDERR_FILENO, kText.data(), kText.size()) < 0) ::_exit(2);
  ::_exit(2);
}

/// While it exists a signal that ends the run ends it also where nothing asks for it, after a second. There is no run
/// yet, and so no result.
struct Loading {
  Loading() {
    std::signal(SIGALRM, onAlarm);
    isLoading = 1;
  }
  ~Loading() {
    isLoading = 0;
    ::alarm(0);
  }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;
};

}  // namespace

void sparkhost::watchSignals(spark::Kernel& kernel) {
  stopOnSignal = &kernel;
  struct sigaction action = {}, before = {};
  action.sa_handler = onSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, &before);
  if (before.sa_handler == SIG_IGN) sigaction(SIGHUP, &before, nullptr);
}

namespace {

/// Prints a line to stdout. On error prints a message to stderr and returns false; the run continues.
bool printLine(const std::string& line) {
  if (sparkhost::printOut(line + '\n')) return true;
  sparkhost::printError(
      fmt::format("sparkhost: cannot write to stdout ({}); this line is lost there: {}\n", std::strerror(errno), line));
  return false;
}

/// The program ends with this code.
struct Exit {
  int code;
};

/// Calls `step`; on an exception prints it to stderr and throws Exit with `code`.
template <class F>
void orExit(int code, F step) {
  try {
    step();
  } catch (const std::exception& e) {
    sparkhost::printError(fmt::format("sparkhost: {}\n", spark::printable(e.what())));  // it may quote another host
    throw Exit{code};
  }
}

void printDescriptions(spark::Kernel& kernel, const sparkhost::Options& options) {
  std::string text;
  if (options.listPlugins) text += sparkhost::pluginList(kernel);
  if (!options.describe.empty()) text += sparkhost::classDescription(kernel, options.describe);
  if (!sparkhost::printOut(text)) throw spark::Error(fmt::format("cannot write to stdout: {}", std::strerror(errno)));
}

/// Throws if errors were logged: a run would continue after them, but --check fails.
void checkLog(spark::Kernel& kernel) {
  if (const auto n = kernel.log().errors(); n > 0)
    throw spark::Error(fmt::format("the check failed: {} in the log above (--log-level error shows them alone).",
                                   n == 1 ? "1 error" : fmt::format("{} errors", n)));
}

/// Runs the simulation and prints both lines; false if the last one could not be written.
bool runSimulation(sparkhost::Host& host, const std::string& firstLine, bool histogram) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  sparkhost::StatusLine::install(host.kernel(), terminal);
  printLine(firstLine);
  const std::string lastLine = host.run();
  if (terminal) sparkhost::printError("\n");
  if (histogram) sparkhost::printError(host.histogram());
  return printLine(lastLine);
}

int run(int argc, char** argv) {
  using namespace sparkhost;
  installCrashReport("sparkhost");
  survivePoorOutputs();
  Options options;
  if (const auto code = readOptions(argc, argv, options)) return *code;
  reserveStdout();
  std::optional<RecordedRun> recorded;
  std::optional<Host> host;
  std::string firstLine;
  orExit(2, [&] {
    refuseSameFile(options.record, options.from, "what the run goes on from");
    refuseSameFile(options.hashes, options.from, "what the run goes on from");
    refuseSameFile(options.record, options.hashes, "the file of the hashes");
    spark::outputs::setReplace(options.force);
    if (!options.from.empty()) options = recorded.emplace(options.from).options(options);
    if (!options.convert.empty()) return convert(options, options.convert[0], options.convert[1]);
    if (!options.record.empty()) spark::outputs::check(options.record, "the recording");
    if (!options.hashes.empty()) spark::outputs::check(options.hashes, "the hashes");
    if (recorded && std::isfinite(options.at)) options.state = stateAt(*recorded, options);
    std::optional<spark::outputs::Trial> trial;
    if (options.check) trial.emplace();
    host.emplace(options);
    if (options.config.empty()) return printDescriptions(host->kernel(), options);
    watchSignals(host->kernel());
    HangWatch::install(host->kernel());
    {
      const Loading loading;
      host->build();
      if (!options.from.empty()) host->goOn();
    }
    if (options.check) checkLog(host->kernel());
    if (!options.hashes.empty()) HashLog::install(host->kernel(), options.hashes, options.hashEvery);
    if (!options.record.empty()) host->record(options.record);
    if (options.check) return;
    try {
      firstLine = host->open();
    } catch (...) {
      host->discardRecording();
      throw;
    }
  });
  bool written = true;
  if (!firstLine.empty()) orExit(1, [&] { written = runSimulation(*host, firstLine, options.histogram); });
  return written ? 0 : 1;
}

}  // namespace

void sparkhost::refuseSameFile(const std::string& written, const std::string& other, const char* what) {
  namespace fs = std::filesystem;
  if (written.empty() || other.empty()) return;
  std::error_code failed;
  const bool same = fs::exists(written, failed) && fs::exists(other, failed)
                        ? fs::equivalent(written, other, failed)
                        : fs::absolute(written).lexically_normal() == fs::absolute(other).lexically_normal();
  if (same) throw spark::Error(fmt::format("cannot write {}: it is {}; take another name", written, what));
}

int sparkhost::runProgram(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Exit& exit) {
    return exit.code;
  }
}
