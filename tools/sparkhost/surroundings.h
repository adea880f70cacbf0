#pragma once
/// \file
/// What programs that run configs are told of where they run, on their command lines.

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

namespace sparkhost {

/// Checks the text of a seed, which CLI11 would cut to 64 bits without a word.
inline std::string seedProblem(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc() && end == text.data() + text.size()) return {};
  return "expected a whole number from 0 to 18446744073709551615 (64 bits), found '" + text + "'";
}

/// Adds --plugin-path, --scene-path (folders that must be there) and --log-level, which `shows` describes; the values
/// found are written to the others, which must live as long as `app`.
inline void addSurroundings(CLI::App& app, std::vector<std::string>& pluginPaths, std::vector<std::string>& scenePaths,
                            std::string& logLevel, const std::string& shows) {
  const auto folders = [&app](const char* name, std::vector<std::string>& to, const char* what) {
    app.add_option(name, to, what)->type_name("DIR")->allow_extra_args(false)->check(CLI::ExistingDirectory);
  };
  folders("--plugin-path", pluginPaths, "Folder with plugins, before Spark's own");
  folders("--scene-path", scenePaths, "Folder that holds rsg/..., before Spark's own scenes");
  app.add_option("--log-level", logLevel, shows)
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
}

}  // namespace sparkhost
