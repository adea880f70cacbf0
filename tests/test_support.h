#pragma once
/// \file
/// Shared by all tests: a kernel that finds the built plugins and logs into a string, and the folder of the reference
/// data.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "patience.h"
#include "spark/kernel.h"

namespace spark::test {

/// The plugins of this build: <build>/plugins, next to the tests' own folder.
inline std::filesystem::path pluginFolder() {
  return std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "plugins";
}
/// The programs of this build.
inline std::filesystem::path binFolder() {
  return std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "bin";
}
/// A program of this build, for a command line.
inline std::string program(const std::string& name) { return (binFolder() / name).string(); }
/// The folder of the reference data. Empty if SPARK_REFERENCE_DIR is not set; a test that needs the data then exits
/// with 77. If the variable names a folder without recorded sessions, the program ends with exit code 1: a test that
/// was meant to run must not count as skipped.
inline std::filesystem::path referenceFolder() {
  const char* dir = std::getenv("SPARK_REFERENCE_DIR");
  if (!dir || !*dir) return {};
  if (!std::filesystem::is_directory(std::filesystem::path(dir) / "captures")) {
    std::fprintf(stderr,
                 "SPARK_REFERENCE_DIR is '%s', where there is no folder captures/. Name the folder that holds it, or "
                 "unset the variable.\n",
                 dir);
    std::exit(1);
  }
  return dir;
}

/// True while a plugin's file is mapped. Plugins run from private copies, which have the file's name.
inline bool isMapped(const std::filesystem::path& file) {
  const std::string copy = "/memfd:" + file.filename().string() + " (deleted)";
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.ends_with(copy) || line.ends_with(file.string())) return true;
  return false;
}

/// A kernel that has loaded the built plugins: other kernels of the program share them. To load them takes most of the
/// time of a short world, and the address sanitizer frees nothing of what it notes about the globals of a library.
inline std::unique_ptr<Kernel> loadPlugins() {
  auto kernel = std::make_unique<Kernel>();
  kernel->log().setSink([](Level, std::string_view) {});
  kernel->plugins().scan(pluginFolder());
  return kernel;
}
/// The one that lasts as long as the program.
inline std::unique_ptr<Kernel>& loadedPlugins() {
  static std::unique_ptr<Kernel> kernel = loadPlugins();
  return kernel;
}
/// While it lives, plugins are unloaded as in a program with one kernel.
struct PluginsUnloaded {
  PluginsUnloaded() { loadedPlugins().reset(); }
  ~PluginsUnloaded() { loadedPlugins() = loadPlugins(); }
  PluginsUnloaded(const PluginsUnloaded&) = delete;
  PluginsUnloaded& operator=(const PluginsUnloaded&) = delete;
};

/// A kernel that has scanned the built plugins and logs into `text`.
struct TestHost {
  std::string text;
  Kernel kernel;
  explicit TestHost(bool scan = true) {
    kernel.log().setSink([this](Level, std::string_view line) { text.append(line).append("\n"); });
    if (!scan) return;
    loadedPlugins();
    kernel.plugins().scan(pluginFolder());
  }
  ~TestHost() { kernel.log().setSink({}); }
};

}  // namespace spark::test
