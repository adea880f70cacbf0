#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// What a plugin author does: installs Spark, builds a plugin with the installed headers and find_package(Spark), drops it into a folder.
// The installed tree is moved in between, because it may be. What a team does: links its agent with the installed client library.

using namespace spark::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
Finished must(const std::vector<std::string>& command) {
  Finished f = runToEnd(command);
  CAPTURE(command.front(), f.out, f.errors);
  REQUIRE(f.code == 0);
  return f;
}
}  // namespace

TEST_CASE("A plugin built outside of the tree is found, described and used") {
  TemporaryFolder folder;
  const fs::path build = binFolder().parent_path(), first = folder.path() / "first", prefix = folder.path() / "moved",
                 work = folder.path() / "work";
  must({"cmake", "--install", build.string(), "--prefix", first.string()});
  fs::rename(first, prefix);

  fs::copy(SPARK_FIXTURES "/drop-in", work, fs::copy_options::recursive);
  must({"cmake", "-S", work.string(), "-B", (work / "build").string(), "-DCMAKE_PREFIX_PATH=" + prefix.string(),
        "-DCMAKE_BUILD_TYPE=Debug"});
  must({"cmake", "--build", (work / "build").string()});
  const fs::path plugins = folder.path() / "plugins";
  fs::create_directory(plugins);
  fs::copy(work / "build" / "metronome.so", plugins);

  const std::string host = (prefix / "bin" / "sparkhost").string();
  REQUIRE_THAT(must({host, "--list-plugins", "--plugin-path", plugins.string()}).out, Contains("metronome 0.1") && Contains("Metronome"));
  const Finished described = must({host, "--describe", "Metronome", "--plugin-path", plugins.string()});
  REQUIRE_THAT(described.out,
               Contains("beats") && Contains("integer") && Contains("Cycles between two beats.") && Contains("handles: rule"));

  const Finished run =
      must({host, "--config", (work / "metronome.lua").string(), "--plugin-path", plugins.string(), "--rate", "max", "--duration", "1"});
  REQUIRE_THAT(run.errors, Contains("beat 5") && !Contains("beat 6"));
  REQUIRE_THAT(run.out, Contains("\"cycles\":50"));
  REQUIRE_THAT(runToEnd({host, "--config", (work / "metronome.lua").string()}).errors, Contains("there is no plugin 'metronome'"));
}

TEST_CASE("An agent built outside of the tree with the client library alone plays, and needs no other package") {
  TemporaryFolder folder;
  const fs::path build = binFolder().parent_path(), first = folder.path() / "first", prefix = folder.path() / "moved", work = folder.path() / "work";
  must({"cmake", "--install", build.string(), "--prefix", first.string()});
  fs::rename(first, prefix);
  fs::copy(SPARK_FIXTURES "/client", work, fs::copy_options::recursive);
  must({"cmake", "-S", work.string(), "-B", (work / "build").string(), "-DCMAKE_PREFIX_PATH=" + prefix.string(), "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
        "-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON"});
  must({"cmake", "--build", (work / "build").string()});

  Process host({(prefix / "bin" / "sparkhost").string(), "--config", "training.lua", "--expect", "1", "--agent-port", "0", "--monitor-port", "0", "--set",
                "web=false"},
               120);
  const auto ports = nlohmann::json::parse(host.line());
  const Finished played = must({(work / "build" / "client").string(), "127.0.0.1", std::to_string(ports["agentPort"].get<int>()),
                                std::to_string(ports["monitorPort"].get<int>())});
  CHECK_THAT(played.out, Contains("0.98 s, head at") && Contains("the server closed the connection"));
  CHECK_THAT(played.out, !Contains("head at 0.0 degrees"));
  CHECK(nlohmann::json::parse(host.line())["agentsSeen"] == 1);
  CHECK(host.wait() == 0);
}
