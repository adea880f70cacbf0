#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common_options.h"
#include "crash_report.h"
#include "export.h"
#include "hang_watch.h"
#include "host.h"
#include "mcap.h"
#include "output.h"
#include "program.h"
#include "recorded_run.h"
#include "spark/error.h"

// Reads recordings of sparkhost --record. Exit codes: 0: done; 1: the simulation differs from the recording; 2: an
// error in the command line, or in the recording. stdout gets one JSON line; with --play those of sparkhost.

namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string file, logLevel = "warning";
  bool verify = false, play = false;
  double from = -1;  ///< s; -1: at the beginning
  double speed = 1;
  int monitorPort = 3200, webPort = 3280;
  sparkreplay::Export out;
};

std::optional<int> read(int argc, char** argv, Arguments& out) {
  CLI::App app{"Reads a recording of sparkhost --record.", "sparkreplay"};
  app.add_option("file", out.file, "The recording")->required()->type_name("FILE");
  app.add_flag("--verify", out.verify,
               "Simulate again from the recorded inputs; compare the recorded hashes and states");
  auto* play = app.add_flag("--play", out.play, "Play the match to monitors and to the page in the browser")
                   ->excludes("--verify");
  app.add_option("--from", out.from,
                 "Begin at this time [s]; --verify and --export: at the newest recorded state up to it")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--speed", out.speed, "With --play: 1: as it was; 2: twice as fast; -1: backwards")
      ->needs(play)
      ->check(CLI::Range(-100.0, 100.0))
      ->capture_default_str();
  const CLI::Range port(0, 65535, "");
  app.add_option("--monitor-port", out.monitorPort, "With --play: port for monitors; 0: a free one")
      ->needs(play)
      ->check(port)
      ->capture_default_str();
  app.add_option("--web-port", out.webPort, "With --play: port of the page; 0: a free one")
      ->needs(play)
      ->check(port)
      ->capture_default_str();
  auto* exported = app.add_option("--export", out.out.out,
                                  "Write a file: .mcap: the part of the recording; .csv: a table of properties; "
                                  "otherwise a monitor log, which viewers play")
                       ->type_name("FILE")
                       ->excludes("--verify")
                       ->excludes(play);
  app.add_option("--to", out.out.to, "With --export: the end [s]")->type_name("SECONDS")->needs(exported);
  app.add_option("--property", out.out.properties, "With --export FILE.csv: a column; may be given several times")
      ->type_name("/PATH.PROPERTY")
      ->needs(exported)
      ->allow_extra_args(false);
  sparkhost::addForce(app, out.out.force)->needs(exported);
  sparkhost::addCommonOptions(app, out.out.pluginPaths, out.out.scenePaths, out.logLevel,
                              "Minimum level of log lines on stderr");
  app.footer(
      "stdout: one JSON line; without --verify, --play and --export it tells what the recording holds. Exit code 0: "
      "done; 1: the simulation differs from the recording; 2: the command line or the recording is wrong. While a "
      "match "
      "is played, monitors may send (p) pause, (time 30), (speed 2), (l) the other direction; sparkctl sets time, "
      "speed, "
      "paused and backward of /sys/server/monitor/player.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  sparkhost::makeAbsolute(out.out.pluginPaths);
  sparkhost::makeAbsolute(out.out.scenePaths);
  return std::nullopt;
}

Json describe(const std::string& file, const spark::mcap::Reader& recording) {
  Json files = Json::array();
  for (const auto& a : recording.attachments()) files.push_back(a.name);
  return {{"seconds", static_cast<double>(recording.end()) * 1e-9},
          {"chunks", recording.chunks().size()},
          {"arguments", sparkhost::recordedArguments(file, recording)},
          {"files", std::move(files)},
          {"lacks", recording.lacks()}};
}

/// Simulates the recorded run again. Returns the line for stdout, and whether it is the same.
std::pair<Json, bool> verify(const Arguments& arguments, const std::string& file) {
  sparkhost::RecordedRun recorded(file);
  sparkhost::Options own;
  own.logLevel = arguments.logLevel;
  own.pluginPaths = arguments.out.pluginPaths, own.scenePaths = arguments.out.scenePaths;
  own.replay = true;
  const sparkhost::Options options = recorded.options(own);
  sparkhost::Host host(options);
  sparkhost::HangWatch::install(host.kernel());  // the command line may set its properties
  host.build();
  spark::Leaf& tape = host.play(file);
  sparkhost::watchSignals(host.kernel());
  if (arguments.from > 0) {
    const spark::Value at(arguments.from);
    spark::callMethod(tape, "seek", std::span(&at, 1));
  }
  host.run();
  if (host.kernel().stopRequested()) throw spark::Error("interrupted before the end of the recording");
  const auto property = [&tape](const char* name) { return spark::getProperty(tape, name); };
  Json line{{"cycles", property("cycles").toInteger()},
            {"hashes", property("compared").toInteger()},
            {"states", property("states").toInteger()}};
  const std::int64_t at = property("differsAt").toInteger();
  if (at < 0)
    line["differs"] = nullptr;
  else
    line["differs"] = {{"cycle", at}, {"what", property("difference").toString()}};
  line["lacks"] = recorded.files().lacks();
  const spark::Value lacks = property("lacks");
  for (const spark::Value& v : lacks.toList()) line["lacks"].push_back(v.toString());
  return {line, at < 0};
}

/// Plays the match, as the config logplayer.lua does.
int play(const Arguments& arguments, const std::string& file) {
  std::vector<std::string> words{"sparkreplay", "--config", "logplayer.lua", "--log-level", arguments.logLevel};
  for (const std::string& set : {fmt::format("file={}", file), fmt::format("speed={}", arguments.speed),
                                 fmt::format("from={}", arguments.from)}) {
    words.emplace_back("--set");
    words.push_back(set);
  }
  for (const auto& [name, number] :
       {std::pair("--monitor-port", arguments.monitorPort), std::pair("--web-port", arguments.webPort)}) {
    words.emplace_back(name);
    words.push_back(std::to_string(number));
  }
  std::vector<char*> line;
  line.reserve(words.size() + 1);
  for (std::string& word : words) line.push_back(word.data());
  line.push_back(nullptr);
  return sparkhost::runProgram(static_cast<int>(words.size()), line.data());
}

void print(const Json& line) {
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!sparkhost::printOut(text + '\n'))
    throw spark::Error(
        fmt::format("cannot write to stdout ({}); this line is lost there: {}", std::strerror(errno), text));
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (const auto code = read(argc, argv, arguments)) return *code;
  sparkhost::reserveStdout();
  const std::string file = std::filesystem::absolute(arguments.file);
  if (arguments.play) return play(arguments, file);
  arguments.from = std::max(arguments.from, 0.0);
  if (!arguments.out.out.empty()) {
    sparkreplay::Export what = arguments.out;
    what.file = file, what.from = arguments.from, what.logLevel = arguments.logLevel;
    print(Json{{"file", what.out}, {"written", sparkreplay::write(what)}});
    return 0;
  }
  const spark::mcap::Reader recording(file);
  const auto [line, same] = arguments.verify ? verify(arguments, file) : std::pair(describe(file, recording), true);
  print(line);
  return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    sparkhost::installCrashReport("sparkreplay");
    sparkhost::survivePoorOutputs();
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "sparkreplay: %s\n", e.what());
    return 2;
  }
}
