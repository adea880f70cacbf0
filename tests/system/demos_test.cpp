#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// The demos that the papers show. Each runs as users run it, and does what its first lines say.

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {
std::vector<std::string> demo(const std::string& config, const std::vector<std::string>& more) {
  return joined({program("sparkhost"), "--config", config, "--rate", "max", "--agent-port", "0", "--monitor-port", "0",
                 "--web-port", "0", "--log-level", "warning"},
                more);
}

/// The result of a run of `seconds`, which logs no warning.
Json run(const std::string& config, int seconds, const std::vector<std::string>& more = {}) {
  const Finished end = runToEnd(demo(config, joined({"--duration", std::to_string(seconds)}, more)));
  CHECK(end.errors == "");
  REQUIRE(end.code == 0);
  Json result = Json::parse(end.out.substr(end.out.find('\n') + 1));
  CHECK(result["faults"] == 0);
  return result;
}

/// What `text`, a script that runs in the fourth cycle of a demo, prints.
std::string seen(const std::string& config, const std::string& text) {
  TemporaryFolder folder;
  const std::string script = "include \"" + config + "\"\non(\"publish\", function(self, event)\n" +
                             "if event.cycle ~= 4 then return end\n" + text + "\nend)\n";
  const Finished end = runToEnd(demo(folder.write("seen.lua", script), {"--duration", "0.2", "--log-level", "info"}));
  CAPTURE(end.errors);
  REQUIRE(end.code == 0);
  return end.errors;
}

/// An agent that clears rubble as those inside the host do: it pushes the first block to the right.
class Rescuer {
 public:
  Rescuer(unsigned short port, double lane) : client_(port), lane_(lane) { client_.send("(syn)"); }
  void turn() {
    const std::string percepts = client_.receive();
    double x = 0, y = 0;
    const std::size_t block = percepts.find("(block ");
    if (block == std::string::npos || std::sscanf(percepts.c_str() + block, "(block %lf %lf)", &x, &y) != 2) {
      client_.send("(syn)");
      return;
    }
    x -= 0.72, y += lane_;
    if (std::abs(x) > 0.25)
      x = std::abs(y - 1.5) < 0.2 ? x : 0, y -= 1.5;
    else
      x = std::abs(y) < 0.15 ? 1 : 2 * x;
    client_.send("(push " + std::to_string(x) + " " + std::to_string(2 * y) + ")(syn)");
  }
  Client& client() { return client_; }

 private:
  Client client_;
  double lane_;
};
}  // namespace

TEST_CASE("The demos of the papers have at most sixty lines") {
  for (const char* name : {"buggy", "listings", "legged-sphere", "hoap2", "rescue"}) {
    std::ifstream file(binFolder().parent_path() / "share/spark/lua" / (std::string(name) + ".lua"));
    int lines = 0;
    for (std::string line; std::getline(file, line);) ++lines;
    CAPTURE(name);
    CHECK(lines > 10);
    CHECK(lines <= 60);
  }
}

TEST_CASE("The listings of the paper load, and make the nodes that they print") {
  const std::string found = seen("listings.lua", R"(
    local function show(node, path)
      for _, child in ipairs(node:children()) do print("node " .. path .. child.class) show(child, path .. child.class .. "/") end
    end
    for _, name in ipairs{ "listing1", "listing2", "AgentAspect1" } do show(get("/usr/scene/" .. name), name .. "/") end
    local cube = get("/usr/scene/listing2"):children()[2].localPos
    print("cube", table.unpack(cube)))");
  CHECK_THAT(found, Contains("listing1/Box/DragController"));
  CHECK_THAT(found, Contains("listing2/Transform/RigidBody") && Contains("listing2/Transform/BoxCollider"));
  CHECK_THAT(found, Contains("cube 10.0 20.0 5.0"));
  int wheels = 0;
  const std::string wheel = "AgentAspect1/Transform/SphereCollider\n";
  for (std::size_t at = found.find(wheel); at != std::string::npos; at = found.find(wheel, at + 1)) ++wheels;
  CHECK(wheels == 4);
  CHECK_THAT(found, Contains("AgentAspect1/Transform/Transform/Hinge2Joint/Hinge2Effector"));
}

TEST_CASE("The buggy of Listing 3 drives in a circle, the same in every run") {
  const Json half = run("listings.lua", 12), whole = run("listings.lua", 60);
  const auto radius = [](const Json& result) {
    return std::hypot(result["status"]["x"].get<double>(), result["status"]["y"].get<double>());
  };
  CHECK(half["status"]["x"] < -2);  // it began at x = 5.5
  CHECK(radius(half) < 8);
  CHECK(radius(whole) < 8);
  CHECK(run("listings.lua", 60)["stateHash"] == whole["stateHash"]);
}

TEST_CASE("An agent over TCP reads the wheel of Listing 3 and drives it") {
  Process host(demo("listings.lua", {"--sync", "--set", "drivers=0"}));
  Client agent(Json::parse(host.line())["agentPort"].get<unsigned short>());
  agent.send("(syn)");
  std::string percepts;
  for (int cycle = 0; cycle < 500; ++cycle) {
    percepts = agent.receive();
    agent.send("(Hinge2Effector 180)(syn)");
  }
  host.signal(SIGTERM);
  const Json result = Json::parse(host.line());
  CHECK(host.wait() == 0);
  CHECK_THAT(percepts, Contains("(H2J (n Hinge2Perceptor) (ax 0 "));
  CHECK(result["status"]["x"] < 4);
}

TEST_CASE("The legged sphere walks in a circle, the same in every run") {
  const Json result = run("legged-sphere.lua", 30);
  CHECK(result["status"]["way"] > 10);      // m
  CHECK(result["status"]["height"] > 0.2);  // m: only its feet touch the ground
  CHECK(run("legged-sphere.lua", 30)["stateHash"] == result["stateHash"]);
  CHECK(run("legged-sphere.lua", 5, {"--set", "stride=0"})["status"]["way"] < 1);
}

TEST_CASE("The HOAP-2 has 25 joints and 6.5 kg, and is half a metre high") {
  const std::string found = seen("hoap2.lua", R"(
    local joints, mass, top = 0, 0, 0
    local function count(node)
      if node.class == "HingeJoint" then joints = joints + 1 end
      if node.class == "RigidBody" then mass = mass + node.mass end
      if node.class == "SphereCollider" then top = math.max(top, node.parent.worldTransform[15] + node.radius) end
      for _, child in ipairs(node:children()) do count(child) end
    end
    count(get("/usr/scene/AgentAspect1"))
    print(string.format("%d joints, %.2f kg, %.2f m", joints, mass, top)))");
  CHECK_THAT(found, Contains("25 joints, 6.50 kg, 0.50 m"));
}

TEST_CASE("The HOAP-2 walks for a minute without falling, the same in every run") {
  const Json result = run("hoap2.lua", 60), status = result["status"];
  CHECK(status["height"] > 0.33);  // m, of its torso, which begins at 0.365
  const double way = std::hypot(status["x"].get<double>() - 1, status["y"].get<double>());
  CHECK(way > 0.5);  // m, across its circle
  CHECK(run("hoap2.lua", 60)["stateHash"] == result["stateHash"]);
  const Json steps = run("hoap2.lua", 20, {"--set", "stride=0", "--set", "turn=0"})["status"];
  CHECK(steps["height"] > 0.33);
  CHECK(steps["x"] == Approx(1).margin(0.15));
}

TEST_CASE("No robot clears rubble alone, two clear some of it, and four free all victims, the same in every run") {
  CHECK(run("rescue.lua", 60, {"--set", "robots=1"})["score"] == Json({0, 3}));
  CHECK(run("rescue.lua", 60, {"--set", "robots=2"})["score"] == Json({2, 1}));
  const Json result = run("rescue.lua", 60);
  CHECK(result["score"] == Json({3, 0}));
  CHECK(result["playMode"] == "Over");
  CHECK(result["teams"] == Json({"Rescued", "Buried"}));
  CHECK(run("rescue.lua", 60)["stateHash"] == result["stateHash"]);
}

TEST_CASE("Agents over TCP and one inside clear rubble together") {
  Process host(demo("rescue.lua", {"--sync", "--set", "robots=1"}));
  const auto port = Json::parse(host.line())["agentPort"].get<unsigned short>();
  Rescuer second(port, -0.15), third(port, 0.45);
  second.client().send("(push fast)(syn)");  // a mistake
  for (int cycle = 0; cycle < 1250; ++cycle) second.turn(), third.turn();
  host.signal(SIGTERM);
  const Json result = Json::parse(host.line());
  CHECK(host.wait() == 0);
  CHECK_THAT(host.errors(), Contains("push: expected (push x y), two numbers from -1 to 1"));
  CHECK(result["score"][0] == 3);
}
