#include "recorded_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host.h"
#include "spark/error.h"

namespace sparkhost {

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
    : folder_(fs::current_path()),
      file_(file),
      recording_(file),
      arguments_(recordedArguments(file, recording_)),
      files_(recording_, Host::installedShare()) {
  fs::current_path(files_.scripts());  // scripts are searched there before anywhere else
}

namespace {
/// Options of configs that name files which a run writes.
bool isWritten(const std::string& key) { return key == "monitorLog" || key == "logFile"; }
/// Options of configs that name files which are read, and are no part of a recording: programs are listed there.
bool isRead(const std::string& key) { return key == "agentDatabase"; }
}  // namespace

Options RecordedRun::options(const Options& own) const {
  std::vector<std::string> words = arguments_;
  words.insert(words.begin(), "sparkhost");
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  Options out;
  if (readOptions(static_cast<int>(argv.size()), argv.data(), out))
    throw spark::Error(fmt::format("{}: its command line is of another version", file_));
  out.share = files_.share();
  if (const fs::path config(out.config); config.is_absolute()) out.config = files_.scripts() / config.filename();
  out.fromSwitches = out.switches.size();
  out.fromOverrides = out.overrides.size();
  // The files of the first run stay as they are.
  for (auto& [key, value] : out.overrides)
    if (isWritten(key) && value.isString() && !value.toString().empty()) value = (files_.share() / key).string();
  for (auto& [key, value] : out.overrides)
    if (isRead(key) && value.isString() && !value.toString().empty()) value = (folder_ / value.toString()).string();
  out.switches.insert(out.switches.end(), own.switches.begin(), own.switches.end());
  out.overrides.insert(out.overrides.end(), own.overrides.begin(), own.overrides.end());
  for (std::size_t i = out.fromOverrides; i < out.overrides.size(); ++i)
    if (auto& [key, value] = out.overrides[i]; isWritten(key) && value.isString() && !value.toString().empty())
      value = (folder_ / value.toString()).string();
  out.arguments.insert(out.arguments.end(), own.arguments.begin(), own.arguments.end());
  out.pluginPaths.insert(out.pluginPaths.end(), own.pluginPaths.begin(), own.pluginPaths.end());
  out.scenePaths.insert(out.scenePaths.end(), own.scenePaths.begin(), own.scenePaths.end());
  out.logLevel = own.logLevel;
  out.check = own.check, out.histogram = own.histogram, out.alone = own.alone, out.replay = own.replay;
  out.hashes = own.hashes, out.hashEvery = own.hashEvery, out.record = own.record;
  out.from = own.from, out.at = own.at, out.branch = own.seed;
  return out;
}

}  // namespace sparkhost
