#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// People copy the first example of a README: it has to be a config that runs as it stands.

using namespace spark::test;
namespace fs = std::filesystem;

namespace {
/// The first Lua block of a file, "" when there is none.
std::string exampleOf(const fs::path& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}}, fence = "```lua\n";
  const auto begin = text.find(fence);
  return begin == text.npos ? "" : text.substr(begin + fence.size(), text.find("\n```", begin) + 1 - begin - fence.size());
}
}  // namespace

TEST_CASE("The first example of every plugin's README, and of the scripts', is a config that builds a house") {
  TemporaryFolder folder;
  std::vector<fs::path> readmes{fs::path(SPARK_SOURCES) / "lua" / "README.md"};
  for (const auto& plugin : fs::directory_iterator(fs::path(SPARK_SOURCES) / "plugins"))
    if (fs::exists(plugin.path() / "README.md")) readmes.push_back(plugin.path() / "README.md");
  REQUIRE(readmes.size() > 10);
  for (const fs::path& readme : readmes) {
    const std::string example = exampleOf(readme);
    INFO(readme.string() << "\n" << example);
    CHECK_FALSE(example.empty());
    const auto config = folder.write(readme.parent_path().filename().string() + ".lua", example);
    const Finished checked = runToEnd({(binFolder() / "sparkhost").string(), "--config", config, "--check"});
    INFO(checked.errors);
    CHECK(checked.code == 0);
  }
}
