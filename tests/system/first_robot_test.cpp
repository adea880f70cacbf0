#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "absence.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// The program of docs/first-robot.md, as a reader copies it.

using namespace spark::test;
using Catch::Contains;

namespace {

/// A program of the page, written into a folder.
std::string programOf(const TemporaryFolder& folder, const std::string& name) {
  const std::string page = textOf(SPARK_SOURCES "/docs/first-robot.md"), fence = "```python " + name + "\n";
  const auto begin = page.find(fence) + fence.size();
  return folder.write(name, page.substr(begin, page.find("\n```", begin) + 1 - begin));
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by);
}

/// Runs a program with a host that expects one agent, and ends both.
struct Run {
  Finished robot;
  std::string log;
  Run(const std::string& program, const std::string& cycles, const std::vector<std::string>& host) {
    Process process(joined({(binFolder() / "sparkhost").string(), "--sync", "--rate", "max", "--expect", "1",
                            "--agent-port", "0", "--set", "web=false"},
                           joined(host, withoutLimits())));
    const int port = nlohmann::json::parse(process.line())["agentPort"];
    robot = runToEnd({"python3", program, std::to_string(port), cycles});
    process.signal(SIGTERM);
    CHECK(process.wait() == 0);
    log = process.errors();
  }
};

/// Runs the arm's program with another file of its robot in it.
Run drive(const TemporaryFolder& folder, const std::string& file, const std::vector<std::string>& host) {
  const std::string text = replaced(textOf(programOf(folder, "arm.py")), "rsg/robots/arm.urdf", file);
  return Run(folder.write("one.py", text), "150", host);
}

/// The log of a host whose agent asks for another robot than that of the config.
const std::string& logWithWarning() {
  static const std::string log = drive(TemporaryFolder(), "rsg/robots/other.urdf", {"--config", "urdf.lua"}).log;
  return log;
}

}  // namespace

TEST_CASE("The robot of docs/first-robot.md joins, sees the ball, and drives") {
  TemporaryFolder folder;
  const Run run(programOf(folder, "first_robot.py"), "100", {"--config", "soccer-sphere.lua", "--monitor-port", "0"});
  CAPTURE(run.robot.out, run.robot.errors, run.log);
  CHECK(run.robot.code == 0);
  CHECK_THAT(run.robot.out, Contains("the ball is 37.0 m away, at 90 degrees") && Contains("the ball is 3.") &&
                                Contains("the ball is 2."));  // it has beamed and driven
  CHECK(lacks(run.log, "warning", logWithWarning()));
}

TEST_CASE("The arm of docs/first-robot.md is driven in lockstep, from a file of each language") {
  TemporaryFolder folder;
  const std::string program = programOf(folder, "arm.py");
  SECTION("the robot of the config") {
    const Run one = drive(folder, "rsg/robots/arm.urdf", {"--config", "urdf.lua"});
    CAPTURE(one.robot.out, one.robot.errors, one.log);
    CHECK(one.robot.code == 0);
    CHECK_THAT(one.robot.out, Contains("degrees\nthe elbow is at 45.") || Contains("degrees\nthe elbow is at 44."));
    CHECK(lacks(one.log, "warning", logWithWarning()));
    const Run again = drive(folder, "rsg/robots/arm.urdf", {"--config", "urdf.lua"});
    CHECK(again.robot.out == one.robot.out);
    // Another file than that of the config is refused, with a line in the log.
    CHECK_THAT(logWithWarning(), Contains("scene: expected (scene rsg/robots/arm.urdf), the robot of this simulation"));
  }
  SECTION("a robot that the agent chooses") {
    for (const char* config : {"urdf.lua", "mjcf.lua", "webots.lua"}) {
      const Run chosen =
          drive(folder, "rsg/robots/arm.urdf", {"--config", config, "--set", "model=", "--set", "stiffness=0"});
      CAPTURE(config, chosen.robot.out, chosen.robot.errors, chosen.log);
      CHECK(chosen.robot.code == 0);
      CHECK_THAT(chosen.robot.out, Contains("the elbow is at 45.") || Contains("the elbow is at 44."));
      CHECK(lacks(chosen.log, "warning", logWithWarning()));
    }
  }
  SECTION("the robots of the other configs, by an agent that only waits for its turns") {
    struct Case {
      std::string config, file, joint;
    };
    for (const auto& [config, file, joint] :
         {Case{"mjcf.lua", "rsg/robots/t1.xml", "q_hj1"}, {"webots.lua", "rsg/robots/rover.wbt", "mast_angle"}}) {
      std::string text = replaced(replaced(textOf(program), "rsg/robots/arm.urdf", file), "(elbow 45 0 200 5 0)", "");
      text = replaced(text, "angles[\"elbow\"]", "angles[\"" + joint + "\"]");
      const Run run(folder.write("two.py", text), "60", {"--config", config});
      CAPTURE(config, run.robot.out, run.robot.errors, run.log);
      CHECK(run.robot.code == 0);
      CHECK_THAT(run.robot.out, Contains("the elbow is at "));
      CHECK(lacks(run.log, "warning", logWithWarning()));
    }
  }
}
