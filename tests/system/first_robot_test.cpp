#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// The program of docs/first-robot.md, as a reader copies it.

using namespace spark::test;
using Catch::Contains;

TEST_CASE("The robot of docs/first-robot.md joins, sees the ball, and drives") {
  const std::string page = textOf(SPARK_SOURCES "/docs/first-robot.md"), fence = "```python first_robot.py\n";
  const auto begin = page.find(fence) + fence.size();
  TemporaryFolder folder;
  const std::string program = folder.write("first_robot.py", page.substr(begin, page.find("\n```", begin) + 1 - begin));

  Process host(joined({(binFolder() / "sparkhost").string(), "--config", "soccer-sphere.lua", "--sync", "--rate", "max",
                       "--expect", "1", "--agent-port", "0", "--monitor-port", "0", "--set", "web=false"},
                      withoutLimits()));
  const int port = nlohmann::json::parse(host.line())["agentPort"];
  const Finished robot = runToEnd({"python3", program, std::to_string(port), "100"});
  CAPTURE(robot.out, robot.errors, host.errors());
  CHECK(robot.code == 0);
  CHECK_THAT(robot.out, Contains("the ball is 37.0 m away, at 90 degrees") && Contains("the ball is 3.") &&
                            Contains("the ball is 2."));  // it has beamed and driven
  CHECK_THAT(host.errors(), !Contains("warning"));
  host.signal(SIGTERM);
  CHECK(host.wait() == 0);
}
