#include "recorded_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host.h"
#include "spark/error.h"
#include "spark/output_file.h"

namespace sparkhost {

using namespace spark;
namespace fs = std::filesystem;

std::vector<std::string> recordedArguments(const std::string& file, const spark::mcap::Reader& recording) {
  const auto about = recording.metadataOf("spark");
  const auto found = about.find("arguments");
  const auto list = found == about.end() ? nlohmann::json() : nlohmann::json::parse(found->second, nullptr, false);
  if (!list.is_array() || list.empty())
    throw spark::Error(fmt::format("{} is no recording of sparkhost: it does not say how it was started", file));
  std::vector<std::string> out;
  for (const auto& word : list)
    if (word.is_string()) out.push_back(word.get<std::string>());
  return out;
}

RecordedRun::RecordedRun(const std::string& file)
    : file_(file),
      recording_(file),
      arguments_(recordedArguments(file, recording_)),
      files_(recording_, Host::installedShare()) {
  outputs::keep(file);
}

namespace {
/// Options of configs that name files, or a folder, which a run writes.
bool isWritten(const std::string& key) { return key == "monitorLog" || key == "logFile" || key == "agentLogs"; }

/// Settings of what records the run: they are those of one run.
bool isOfTape(const std::string& key) { return key.starts_with("/sys/host/tape."); }

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}
}  // namespace

// A recording is data. It may come from anybody, so nothing that it names is run or written: no plugin, no program and
// no file but in its own temporary folder, unless this program's own command line names it.
Options RecordedRun::options(const Options& own) const {
  std::vector<std::string> words = arguments_;
  words.insert(words.begin(), "sparkhost");
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  Options out;
  if (std::string problem; readOptions(static_cast<int>(argv.size()), argv.data(), out, &problem))
    throw Error(fmt::format("{}: its command line is of another version: {}", file_, problem));
  out.convert.clear();
  out.describe.clear();
  out.listPlugins = false;
  if (out.config.empty()) throw Error(fmt::format("{}: its command line names no config", file_));
  if (const fs::path config(out.config); config.is_absolute()) out.config = files_.scripts() / config.filename();

  outputs::confine(files_.share());
  for (const std::string& file : {own.record, own.hashes})
    if (!file.empty()) outputs::permit(file);
  for (const auto& [key, value] : own.overrides)
    if (value.isString() && !value.toString().empty()) outputs::permit(value.toString());

  for (const std::string& folder : out.pluginPaths)
    if (std::find(own.pluginPaths.begin(), own.pluginPaths.end(), folder) == own.pluginPaths.end())
      out.notes.push_back(
          fmt::format("the recorded run had plugins of {0}. Plugins that a recording names are not "
                      "loaded; if you trust them, say --plugin-path {0}",
                      folder));
  out.pluginPaths = own.pluginPaths;
  for (const std::string& folder : out.scenePaths)
    if (!fs::is_directory(folder))
      out.notes.push_back(
          fmt::format("the folder of scenes {} is not there: files that the recorded run did not read "
                      "are missing",
                      folder));
  out.share = files_.share();
  out.files = files_.files();
  out.moreScenePaths = own.scenePaths;

  // The files of the first run stay as they are.
  std::erase_if(out.overrides, [](const auto& set) { return isOfTape(set.first); });
  for (auto& [key, value] : out.overrides)
    if (isWritten(key) && value.isString() && !value.toString().empty()) value = (files_.share() / key).string();
  out.fromSwitches = out.switches.size();
  out.fromOverrides = out.overrides.size();
  out.switches.insert(out.switches.end(), own.switches.begin(), own.switches.end());
  out.overrides.insert(out.overrides.end(), own.overrides.begin(), own.overrides.end());
  append(out.arguments, own.arguments);
  out.logLevel = own.logLevel;
  out.check = own.check, out.histogram = own.histogram, out.alone = own.alone, out.replay = own.replay;
  out.hashes = own.hashes, out.hashEvery = own.hashEvery, out.record = own.record, out.force = own.force;
  out.from = own.from, out.at = own.at, out.branch = own.seed, out.state = own.state;
  return out;
}

}  // namespace sparkhost
