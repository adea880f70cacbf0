#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "absence.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// What a plugin author does: install Spark, build a plugin with the installed headers and find_package(Spark), and drop
// it into a folder. The installed tree is moved in between, because it is relocatable. What a team does: link its agent
// with the installed client library. The examples are extracted from the installed documentation.

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

/// The first code block of a language in a page, after `heading`.
std::string block(const fs::path& page, const std::string& language, const std::string& heading = "") {
  const std::string text = textOf(page), fence = "```" + language + "\n";
  const auto begin = text.find(fence, text.find(heading));
  INFO(page.string());
  REQUIRE(begin != text.npos);
  return text.substr(begin + fence.size(), text.find("\n```", begin) + 1 - begin - fence.size());
}

/// An installed Spark that was moved to another folder.
struct Installed {
  TemporaryFolder folder;
  fs::path prefix = folder.path() / "moved";
  Installed() {
    const fs::path first = folder.path() / "first";
    must({"cmake", "--install", binFolder().parent_path().string(), "--prefix", first.string()});
    fs::rename(first, prefix);
  }
  std::string program(const char* name) const { return (prefix / "bin" / name).string(); }
};
}  // namespace

TEST_CASE("A plugin built outside the tree is found, described and used") {
  const Installed spark;
  const fs::path prefix = spark.prefix, work = spark.folder.path() / "work";
  fs::copy(SPARK_FIXTURES "/drop-in", work, fs::copy_options::recursive);
  must({"cmake", "-S", work.string(), "-B", (work / "build").string(), "-DCMAKE_PREFIX_PATH=" + prefix.string(),
        "-DCMAKE_BUILD_TYPE=Debug"});
  must({"cmake", "--build", (work / "build").string()});
  const fs::path plugins = spark.folder.path() / "plugins";
  fs::create_directory(plugins);
  fs::copy(work / "build" / "metronome.so", plugins);

  const std::string host = spark.program("sparkhost");
  REQUIRE_THAT(must({host, "--list-plugins", "--plugin-path", plugins.string()}).out,
               Contains("metronome 0.1") && Contains("Metronome"));
  const Finished described = must({host, "--describe", "Metronome", "--plugin-path", plugins.string()});
  REQUIRE_THAT(described.out, Contains("beats") && Contains("integer") && Contains("Cycles between two beats.") &&
                                  Contains("handles: rule"));

  const auto beats = [&](const char* duration) {
    return must({host, "--config", (work / "metronome.lua").string(), "--plugin-path", plugins.string(), "--rate",
                 "max", "--duration", duration});
  };
  const Finished run = beats("1");
  REQUIRE_THAT(run.errors, Contains("beat 5"));
  REQUIRE(lacks(run.errors, "beat 6", beats("1.3").errors));
  REQUIRE_THAT(run.out, Contains("\"cycles\":50"));
  REQUIRE_THAT(runToEnd({host, "--config", (work / "metronome.lua").string()}).errors,
               Contains("there is no plugin 'metronome'"));
}

TEST_CASE("An agent built outside the tree needs only the client library to play") {
  const Installed spark;
  const fs::path prefix = spark.prefix, work = spark.folder.path() / "client";
  fs::copy(SPARK_FIXTURES "/client", work, fs::copy_options::recursive);
  must({"cmake", "-S", work.string(), "-B", (work / "build").string(), "-DCMAKE_PREFIX_PATH=" + prefix.string(),
        "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON",
        "-DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON"});
  must({"cmake", "--build", (work / "build").string()});

  Process host({(prefix / "bin" / "sparkhost").string(), "--config", "training.lua", "--expect", "1", "--agent-port",
                "0", "--monitor-port", "0", "--set", "web=false"});
  const auto ports = nlohmann::json::parse(host.line());
  const Finished played =
      must({(work / "build" / "client").string(), "127.0.0.1", std::to_string(ports["agentPort"].get<int>()),
            std::to_string(ports["monitorPort"].get<int>())});
  const std::string at = "0.98 s, head at ";
  REQUIRE_THAT(played.out, Contains(at) && Contains("the server closed the connection"));
  CHECK(std::stod(played.out.substr(played.out.find(at) + at.size())) != 0);
  CHECK(nlohmann::json::parse(host.line())["agentsSeen"] == 1);
  CHECK(host.wait() == 0);
}

TEST_CASE("The plugin and the copied sensor of the documentation build from the installed tree") {
  const Installed spark;
  const fs::path pages = spark.prefix / "share" / "doc" / "spark", guide = pages / "docs" / "plugin-guide.md";
  const TemporaryFolder& folder = spark.folder;
  folder.write("wind/CMakeLists.txt", block(guide, "cmake CMakeLists.txt", "## A plugin of your own"));
  folder.write("wind/wind.cpp", block(guide, "cpp wind.cpp", "## A plugin of your own"));
  folder.write("gyro/CMakeLists.txt", block(guide, "cmake", "## A copy of one of ours"));
  folder.write("gyro/my_sensors.cpp", block(guide, "cpp", "## A copy of one of ours"));
  // As the guide says: copy the file and rename the class.
  std::string header = textOf(pages / "plugins" / "sensors" / "gyro_rate_perceptor.h");
  for (std::size_t at = header.find("GyroRatePerceptor"); at != header.npos; at = header.find("GyroRatePerceptor", at))
    header.replace(at, 17, "MyGyro");
  folder.write("gyro/my_gyro.h", header);
  folder.write("CMakeLists.txt",
               "cmake_minimum_required(VERSION 3.25)\nproject(All "
               "CXX)\nadd_subdirectory(wind)\nadd_subdirectory(gyro)\n");

  const std::string build = folder.file("build");
  const Finished configured =
      must({"cmake", "-S", folder.path().string(), "-B", build, "-DCMAKE_PREFIX_PATH=" + spark.prefix.string(),
            "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror"});
  CHECK_THAT(configured.out, Contains("no build type was given, so it is Release"));
  CHECK_THAT(textOf(folder.path() / "build" / "CMakeCache.txt"), Contains("CMAKE_BUILD_TYPE:STRING=Release"));
  must({"cmake", "--build", build, "--parallel", "2"});

  const std::vector<std::string> look{spark.program("sparkhost"), "--plugin-path", build + "/wind", "--plugin-path",
                                      build + "/gyro"};
  const auto describe = [&](const char* name) {
    std::vector<std::string> command = look;
    command.insert(command.end(), {"--describe", name});
    return must(command).out;
  };
  CHECK_THAT(describe("Wind"), Contains("force") && Contains("N"));
  CHECK_THAT(describe("MyGyro"), Contains("plugin: my-sensors") && Contains("angular velocity"));
}

TEST_CASE("The pages that the installed documentation links to are installed") {
  const Installed spark;
  const fs::path pages = spark.prefix / "share" / "doc" / "spark";
  for (const char* page :
       {"README.md", "LICENSE", "CONTRIBUTING.md", "docs/README.md", "plugins/README.md", "docs/plugin-guide.md",
        "docs/first-robot.md", "docs/embedding.md", "docs/tutorial.md", "lua/README.md", "scenes/README.md",
        "plugins/sensors/README.md", "plugins/soccer/README.md", "tools/sparkbatch/README.md"})
    CHECK(fs::is_regular_file(pages / page));
  const auto installed = [&](const char* name) {
    return std::any_of(fs::recursive_directory_iterator(spark.prefix), fs::recursive_directory_iterator(),
                       [&](const fs::path& file) { return file.filename() == name; });
  };
  CHECK(installed("house.lua"));
  CHECK_FALSE(installed("node_modules"));
}
