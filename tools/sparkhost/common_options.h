#pragma once
/// \file
/// Options that sparkhost and sparkbatch have in common.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

namespace sparkhost {

/// Validator of a seed: "" or what is wrong. Without it CLI11 would silently truncate large numbers to 64 bits.
inline std::string checkSeed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc() && end == text.data() + text.size()) return {};
  return fmt::format("expected a whole number from 0 to 18446744073709551615 (64 bits), found '{}'", text);
}

/// Adds --plugin-path, --scene-path (existing folders) and --log-level, whose help is `logHelp`. Parsing writes into
/// the other arguments, which must outlive `app`.
inline void addCommonOptions(CLI::App& app, std::vector<std::string>& pluginPaths, std::vector<std::string>& scenePaths,
                             std::string& logLevel, const std::string& logHelp) {
  const auto folders = [&app](const char* name, std::vector<std::string>& to, const char* what) {
    app.add_option(name, to, what)
        ->type_name("DIR")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false)
        ->check(CLI::ExistingDirectory);
  };
  folders("--plugin-path", pluginPaths, "Folder with plugins, before Spark's own");
  folders("--scene-path", scenePaths, "Folder that holds rsg/..., before Spark's own scenes");
  app.add_option("--log-level", logLevel, logHelp)
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
}

}  // namespace sparkhost
