#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// Users copy the first example of a README, so it must run unchanged. The programs that a README starts must exist.

using namespace spark::test;
namespace fs = std::filesystem;

namespace {
/// The first group of every match.
std::set<std::string> matches(const std::string& text, const char* pattern) {
  std::set<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.insert((*it)[1]);
  return found;
}

/// The first Lua block of a file, "" if there is none.
std::string exampleOf(const fs::path& file) {
  const std::string text = textOf(file), fence = "```lua\n";
  const auto begin = text.find(fence);
  return begin == text.npos ? ""
                            : text.substr(begin + fence.size(), text.find("\n```", begin) + 1 - begin - fence.size());
}
}  // namespace

TEST_CASE("The first example in the README of every plugin and of the scripts is a valid config") {
  TemporaryFolder folder;
  std::vector<fs::path> readmes{fs::path(SPARK_SOURCES) / "lua" / "README.md"};
  for (const auto& plugin : fs::directory_iterator(fs::path(SPARK_SOURCES) / "plugins"))
    if (fs::exists(plugin.path() / "README.md")) readmes.push_back(plugin.path() / "README.md");
  REQUIRE(readmes.size() > 10);
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());  // some examples write files
  for (const fs::path& readme : readmes) {
    const std::string example = exampleOf(readme);
    INFO(readme.string() << "\n" << example);
    CHECK_FALSE(example.empty());
    const auto config = folder.write(readme.parent_path().filename().string() + ".lua", example);
    const Finished checked = runToEnd({(binFolder() / "sparkhost").string(), "--config", config, "--check"});
    INFO(checked.errors);
    CHECK(checked.code == 0);
  }
  fs::current_path(before);
}

TEST_CASE(
    "The target that tools/play builds makes every program that the README starts and every file that is installed") {
  const fs::path build = binFolder().parent_path();
  std::string listed;
  for (const char* tool : {"query", "inputs"}) {  // the inputs of the target, and their own inputs
    const Finished f = runToEnd({"ninja", "-C", build.string(), "-t", tool, "programs"});
    INFO(f.errors);
    REQUIRE(f.code == 0);
    listed += f.out;
  }
  const auto made = matches(listed, " *([^\n]+)\n");

  auto started = matches(textOf(fs::path(SPARK_SOURCES) / "README.md"), "build/release/(bin/[a-z0-9-]+)");
  started.merge(matches(textOf(fs::path(SPARK_SOURCES) / "docs" / "using.md"), "build/release/(bin/[a-z0-9-]+)"));
  REQUIRE(started.size() >= 5);
  for (const std::string& program : started) {
    INFO(program);
    CHECK(made.count(program) == 1);
  }

  std::size_t installed = 0;
  for (const auto& file : fs::recursive_directory_iterator(build)) {
    if (file.path().filename() != "cmake_install.cmake") continue;
    for (const std::string& product :
         matches(textOf(file.path()),
                 "TYPE (?:EXECUTABLE|MODULE|SHARED_LIBRARY|STATIC_LIBRARY) (?:OPTIONAL )?FILES \"([^\"]+)\"")) {
      INFO(product);
      CHECK(made.count(fs::relative(product, build).string()) == 1);
      ++installed;
    }
  }
  REQUIRE(installed > 25);
  REQUIRE(textOf(fs::path(SPARK_SOURCES) / "tools" / "play").find("build release programs") != std::string::npos);
}

TEST_CASE("The host accepts every option on the page for users of spark.rb") {
  const std::string page = textOf(fs::path(SPARK_SOURCES) / "docs" / "spark-rb.md");
  std::istringstream lines(page);
  std::set<std::string> settings;
  for (std::string line; std::getline(lines, line);) {
    const auto column = line.starts_with("|") ? line.find("| `--") : line.npos;
    if (column != line.npos) settings.insert(line.substr(column + 3, line.find('`', column + 3) - column - 3));
  }
  REQUIRE(settings.size() > 40);
  TemporaryFolder folder;
  for (const std::string& setting : settings) {
    std::vector<std::string> command{(binFolder() / "sparkhost").string(), "--check"};
    if (setting.find("--config") == setting.npos) command.insert(command.end(), {"--config", "soccer.lua"});
    std::string unquoted = setting;  // as the shell does
    std::erase(unquoted, '"');
    std::istringstream words(unquoted);
    for (std::string word; words >> word;) command.push_back(word == "FOLDER" ? folder.path().string() : word);
    const Finished f = runToEnd(command);
    INFO(setting << "\n" << f.errors);
    CHECK(f.code == 0);
  }
}
