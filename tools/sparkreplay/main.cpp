#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "crash_report.h"
#include "hang_watch.h"
#include "host.h"
#include "mcap.h"
#include "recorded_files.h"
#include "spark/error.h"

// Reads recordings of sparkhost --record. Exit codes: 0: done; 1: the simulation differs from the recording; 2: an
// error in the command line, or in the recording. stdout gets one JSON line.

namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string file, logLevel = "warning";
  bool verify = false;
};

std::optional<int> read(int argc, char** argv, Arguments& out) {
  CLI::App app{"Reads a recording of sparkhost --record.", "sparkreplay"};
  app.add_option("file", out.file, "The recording")->required()->type_name("FILE");
  app.add_flag("--verify", out.verify,
               "Simulate again from the recorded inputs; compare the hash of each cycle and the recorded states");
  app.add_option("--log-level", out.logLevel, "Minimum level of log lines on stderr")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  app.footer(
      "stdout: one JSON line. Without --verify it tells what the recording holds. Exit code 0: done; 1: the "
      "simulation differs from the recording; 2: the command line or the recording is wrong.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

/// The command line of the recorded host.
std::vector<std::string> recordedArguments(const std::map<std::string, std::string>& about, const std::string& file) {
  const auto found = about.find("arguments");
  const auto list = found == about.end() ? nlohmann::json() : nlohmann::json::parse(found->second, nullptr, false);
  if (!list.is_array())
    throw spark::Error(fmt::format("{} is no recording of sparkhost: it does not say how it was started", file));
  std::vector<std::string> out;
  for (const auto& word : list)
    if (word.is_string()) out.push_back(word.get<std::string>());
  return out;
}

Json describe(const std::string& file, const spark::mcap::Reader& recording) {
  const auto about = recording.metadataOf("spark");
  Json files = Json::array();
  for (const auto& a : recording.attachments()) files.push_back(a.name);
  return {{"seconds", static_cast<double>(recording.end()) * 1e-9},
          {"chunks", recording.chunks().size()},
          {"arguments", recordedArguments(about, file)},
          {"files", std::move(files)},
          {"lacks", recording.lacks()}};
}

/// Simulates the recorded run again. Returns the line for stdout, and whether it is the same.
std::pair<Json, bool> verify(const std::string& file, const spark::mcap::Reader& recording,
                             const std::string& logLevel) {
  std::vector<std::string> words = recordedArguments(recording.metadataOf("spark"), file);
  words.insert(words.begin(), "sparkhost");
  const sparkreplay::RecordedFiles files(recording);
  std::filesystem::current_path(files.scripts());  // scripts are searched there before anywhere else
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  sparkhost::Options options;
  if (sparkhost::readOptions(static_cast<int>(argv.size()), argv.data(), options))
    throw spark::Error(fmt::format("{}: its command line is of another version", file));
  options.logLevel = logLevel;
  options.share = files.share();
  if (const std::filesystem::path config(options.config); config.is_absolute())
    options.config = files.scripts() / config.filename();
  sparkhost::Host host(options);
  sparkhost::HangWatch::install(host.kernel());  // the command line may set its properties
  host.build();
  spark::Leaf& tape = host.play(file);
  host.run();
  const auto property = [&tape](const char* name) { return spark::getProperty(tape, name); };
  Json line{{"cycles", property("compared").toInteger()}, {"states", property("states").toInteger()}};
  const std::int64_t at = property("differsAt").toInteger();
  if (at < 0)
    line["differs"] = nullptr;
  else
    line["differs"] = {{"cycle", at}, {"what", property("difference").toString()}};
  line["lacks"] = files.lacks();
  const spark::Value lacks = property("lacks");
  for (const spark::Value& v : lacks.toList()) line["lacks"].push_back(v.toString());
  return {line, at < 0};
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (const auto code = read(argc, argv, arguments)) return *code;
  const std::string file = std::filesystem::absolute(arguments.file);
  const spark::mcap::Reader recording(file);
  const auto [line, same] =
      arguments.verify ? verify(file, recording, arguments.logLevel) : std::pair(describe(file, recording), true);
  fmt::print("{}\n", line.dump(-1, ' ', false, Json::error_handler_t::replace));
  return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    sparkhost::installCrashReport("sparkreplay");
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "sparkreplay: %s\n", e.what());
    return 2;
  }
}
