#pragma once
/// \file
/// Files of fixture plugins, and functions to read and change them.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "spark/error.h"
#include "test_support.h"

namespace spark::test {

namespace fs = std::filesystem;

inline fs::path fixtures(const char* folder) { return pluginFolder().parent_path() / "tests" / folder; }
inline fs::path bad(const std::string& name) { return fixtures("bad-plugins") / (name + ".so"); }
inline fs::path good(const std::string& name) { return fixtures("fixture-plugins") / (name + ".so"); }

inline std::string bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Writes into an existing file in place, like cp: a process that has it open sees the change.
inline void overwrite(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes;
}

/// The bytes of a plugin with its version string replaced by one of the same length.
inline std::string withVersion(std::string bytes, const std::string& old, const std::string& now) {
  const std::size_t at = bytes.find(old + '\0');
  REQUIRE(at != std::string::npos);
  return bytes.replace(at, now.size(), now);
}

inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing was refused";
}

}  // namespace spark::test
