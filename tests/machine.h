#pragma once
/// \file
/// Where and of what a figure was measured.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace spark::test {

/// Model name of the processor, "unknown" where the system does not say it.
inline std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string text; std::getline(info, text);)
    if (text.starts_with("model name")) return text.substr(text.find(':') + 2);
  return "unknown";
}

/// The processor and its number of cores.
inline std::string machine() { return fmt::format("{}, {} cores", processor(), std::thread::hardware_concurrency()); }

/// The commit that `folder` is of; "" outside of a repository.
inline std::string commit(const std::filesystem::path& folder) {
  const std::string command = fmt::format("git -C '{}' rev-parse --short HEAD 2>/dev/null", folder.string());
  FILE* out = popen(command.c_str(), "r");
  char text[64] = "";
  if (!out || !std::fgets(text, sizeof text, out)) text[0] = 0;
  if (out) pclose(out);
  const std::string found(text);
  return found.substr(0, found.find('\n'));
}

/// "commit 1ccb3f4, 2026-11-25".
inline std::string commitAndDate(const std::filesystem::path& folder) {
  const std::string found = commit(folder);
  return fmt::format("{}{:%Y-%m-%d}", found.empty() ? "" : fmt::format("commit {}, ", found),
                     fmt::gmtime(std::time(nullptr)));
}

}  // namespace spark::test
