#pragma once
/// \file
/// What tests share: a kernel that finds the built plugins and logs into a string, and the reference data if it is there.

#include <cstdlib>
#include <filesystem>
#include <string>

#include "spark/kernel.h"

namespace spark::test {

/// The plugins of this build: <build>/plugins, next to the tests' own folder.
inline std::filesystem::path pluginFolder() { return std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "plugins"; }
/// The programs of this build.
inline std::filesystem::path binFolder() { return std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "bin"; }
/// The reference data, empty where it is not present: call `skipWithoutReference()` first thing in a program that needs it.
inline std::filesystem::path referenceFolder() {
  const char* dir = std::getenv("SPARK_REFERENCE_DIR");
  return dir && *dir && std::filesystem::is_directory(dir) ? std::filesystem::path(dir) : std::filesystem::path();
}

/// A kernel with the built plugins scanned; what it logs stands in `text`.
struct House {
  std::string text;
  Kernel kernel;
  explicit House(bool scan = true) {
    kernel.log().setSink([this](Level, std::string_view line) { text.append(line).append("\n"); });
    if (scan) kernel.plugins().scan(pluginFolder());
  }
  ~House() { kernel.log().setSink({}); }
};

}  // namespace spark::test
