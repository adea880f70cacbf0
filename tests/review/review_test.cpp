#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "../system/process.h"
#include "test_support.h"

// Problems that users and reviewers found, one config each: cases/NAME.lua is run as a child process and must end with
// the result in its first lines. README.md lists the keys of these lines.

using namespace spark::test;
namespace fs = std::filesystem;

namespace {

/// The command line of a case and its expected result.
struct Case {
  std::string program = "sparkhost";
  std::vector<std::string> arguments{"--rate", "max", "--duration", "2"};
  int exit = 0;
  std::vector<std::string> expected;
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

void take(Case& c, const std::string& key, const std::string& value) {
  if (key == "expect")
    c.expected.push_back(value);
  else if (key == "exit")
    c.exit = std::stoi(value);
  else if (key == "args")
    c.arguments = words(value);
  else if (key == "program")
    c.program = value;
  else
    throw std::runtime_error("expected expect, exit, args or program, found '" + key + "'");
}

/// Reads the lines `-- key: value` at the start of a case; skips other comments between them.
Case readCase(const fs::path& file) {
  Case c;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && line.starts_with("-- ");) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos || line.find(' ', 3) < colon) continue;
    take(c, line.substr(3, colon - 3), line.substr(colon + 2));
  }
  return c;
}

std::vector<fs::path> allCases() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(SPARK_CASES))
    if (entry.path().extension() == ".lua") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("Every case of the review has the result that its first lines specify") {
  const std::vector<fs::path> cases = allCases();
  REQUIRE(cases.size() >= 25);
  for (const fs::path& file : cases) {
    DYNAMIC_SECTION(file.stem().string()) {
      const Case c = readCase(file);
      REQUIRE_FALSE(c.expected.empty());
      std::vector<std::string> command{(binFolder() / c.program).string(), "--config", file.string(), "--scene-path",
                                       SPARK_CASES "/scenes"};
      command.insert(command.end(), c.arguments.begin(), c.arguments.end());
      Process run(command);
      std::string said = run.rest();
      const int code = run.wait();
      said += run.errors();
      INFO(said);
      CHECK(code == c.exit);
      for (const std::string& text : c.expected) CHECK_THAT(said, Catch::Contains(text));
    }
  }
}
