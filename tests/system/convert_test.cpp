#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// sparkhost --convert, as users call it.

using namespace spark::test;
using Catch::Contains;

namespace {
Finished convert(const std::string& in, const std::string& out, const std::vector<std::string>& more = {}) {
  return runToEnd(joined({program("sparkhost"), "--convert", in, out, "--force", "--log-level", "warning"}, more));
}
const std::string kRobots = SPARK_SOURCES "/scenes/robots/";
}  // namespace

TEST_CASE("sparkhost converts scene files of each language, and loads the results") {
  TemporaryFolder folder;
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {kRobots + "arm.urdf", {}},
      {kRobots + "rover.wbt", {}},
      {kRobots + "k1.xml", {}},
      {"rsg/agent/buggy/buggy.rsg", {}},
      {"rsg/agent/sphere.rsg", {"--config", "soccer-sphere.lua"}},
      {"rsg/agent/nao/nao.rsg", {"--config", "soccer.lua"}},
      {"rsg/agent/naov4/nao.rsg", {"--config", "soccer-spl.lua"}},
  };
  for (const auto& [in, more] : cases) {
    INFO(in);
    const std::string out = folder.file("out.rsg");
    const Finished end = convert(in, out, more);
    INFO(end.errors);
    CHECK(end.code == 0);
    CHECK(end.out.empty());
    REQUIRE(std::filesystem::exists(out));
    // A converted file is converted to itself, as far as digits go: here its nodes are counted.
    const auto nodes = [](const std::string& file) {
      std::ifstream text(file);
      std::string line;
      int n = 0;
      while (std::getline(text, line)) n += line.find("(nd ") != std::string::npos;
      return n;
    };
    const std::string again = folder.file("again.rsg");
    CHECK(convert(out, again, more).code == 0);
    CHECK(nodes(again) == nodes(out));
    CHECK(nodes(out) > 5);
    std::filesystem::remove(out);
  }
}

TEST_CASE("sparkhost says what it cannot convert, and leaves no file") {
  TemporaryFolder folder;
  const std::string out = folder.file("out.rsg");
  const auto fails = [&](const std::string& in, const std::string& message) {
    INFO(in);
    const Finished end = convert(in, out);
    CHECK(end.code == 2);
    CHECK_THAT(end.errors, Contains(message));
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
    std::filesystem::remove(in);
  };
  fails(folder.write("bad.urdf", "<robot name='r'/>"), "bad.urdf:1:1: expected a <link>, found none");
  fails(folder.write("bad.rsg",
                     "(RSG 0 1)((nd Transform (nd RigidBody)(nd HingeJoint (attach ../RigidBody)(setAnchor 0 "
                     "0 1)(setAxis 0))(sel RigidBody (setLocalPose 0 0 0 1 0 0 0 0 -1 0 1 0))(setName t)))"),
        "HingeJoint (HingeJoint): cannot be written: its axis 0 is at 1.57");
  CHECK_THAT(convert("rsg/none.rsg", out).errors, Contains("there is no resource 'rsg/none.rsg'"));
  CHECK(runToEnd({program("sparkhost"), "--convert", "one.rsg"}).code == 2);
}

TEST_CASE("what a converted model sets in the world is named") {
  TemporaryFolder folder;
  const std::string in = folder.write("m.xml",
                                      "<mujoco model='m'><option gravity='0 0 -3'/><worldbody><body><freejoint/><geom "
                                      "size='.1'/></body></worldbody></mujoco>");
  const Finished end = convert(in, folder.file("out.rsg"));
  CHECK(end.code == 0);
  CHECK_THAT(end.errors, Contains("/usr/scene/world.gravity = {0.0, 0.0, -3.0}, which is the world's"));
}
