#pragma once
/// \file
/// Options that sparkhost and sparkbatch have in common.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <filesystem>
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

/// Makes names of folders absolute.
inline void makeAbsolute(std::vector<std::string>& folders) {
  for (std::string& f : folders) f = std::filesystem::absolute(f).lexically_normal().string();
}

/// Adds --force. Parsing writes into `force`, which must outlive `app`.
inline CLI::Option* addForce(CLI::App& app, bool& force) {
  return app.add_flag("--force", force, "Replace files that exist; otherwise they are refused");
}

/// Adds --plugin-path, --scene-path (folders, which must exist if `exist`) and --log-level, whose help is `logHelp`.
/// Parsing writes into the other arguments, which must outlive `app`.
inline void addCommonOptions(CLI::App& app, std::vector<std::string>& pluginPaths, std::vector<std::string>& scenePaths,
                             std::string& logLevel, const std::string& logHelp, bool exist = true) {
  const auto folders = [&app, exist](const char* name, std::vector<std::string>& to, const char* what) {
    auto* const option = app.add_option(name, to, what)
                             ->type_name("DIR")
                             ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
                             ->allow_extra_args(false);
    if (exist) option->check(CLI::ExistingDirectory);
  };
  folders("--plugin-path", pluginPaths, "Folder with plugins, before Spark's own");
  folders("--scene-path", scenePaths, "Folder that holds rsg/..., before Spark's own scenes");
  app.add_option("--log-level", logLevel, logHelp)
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
}

}  // namespace sparkhost
