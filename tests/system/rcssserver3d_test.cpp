#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// The name that pkill and killall compare with.
std::string processName(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

unsigned short portOf(const Json& ports, const char* name) { return ports[name].get<unsigned short>(); }
}  // namespace

TEST_CASE("rcssserver3d and simspark use the given agent and monitor ports and can be killed by name") {
  for (const std::string name : {"rcssserver3d", "simspark"}) {
    CAPTURE(name);
    Process server({program(name), "--agent-port=0", "--server-port", "0"});
    const Json ports = Json::parse(server.line());
    REQUIRE(processName(server.pid()) == name);
    Client monitor(portOf(ports, "monitorPort"));
    REQUIRE_THAT(monitor.receive(), Contains("(FieldLength 30)"));
    Client agent(portOf(ports, "agentPort"));
    agent.send("(scene rsg/agent/nao/nao.rsg)");
    REQUIRE_THAT(agent.receive(), Contains("(GS ") && Contains("(HJ (n hj1)"));
    server.signal(SIGTERM);
    REQUIRE(server.wait() == 0);
  }
}

TEST_CASE("SIGTERM ends a server that waits for a silent agent") {
  Process server({program("rcssserver3d"), "--agent-port", "0", "--server-port", "0", "--", "--sync", "--rate", "max"});
  const Json ports = Json::parse(server.line());
  Client agent(portOf(ports, "agentPort"));
  agent.send("(scene rsg/agent/nao/nao.rsg)(syn)");
  agent.receive();
  server.signal(SIGTERM);
  REQUIRE(server.wait() == 0);
}

TEST_CASE("Two servers with different port options run side by side") {
  Process first({program("rcssserver3d"), "--agent-port", "0", "--server-port", "0"});
  const Json ports = Json::parse(first.line());
  const std::string taken = std::to_string(portOf(ports, "agentPort"));
  Process second({program("simspark"), "--agent-port", "0", "--server-port", "0"});
  REQUIRE(Json::parse(second.line())["agentPort"] != ports["agentPort"]);
  const Finished third = runToEnd({program("rcssserver3d"), "--agent-port", taken, "--server-port", "0"});
  REQUIRE(third.code != 0);
  REQUIRE_THAT(third.errors, Contains(taken));
}

TEST_CASE("A Lua start-up script replaces the config, and a Ruby script is reported") {
  TemporaryFolder folder;
  const std::string own = folder.write("own.lua", "include \"soccer.lua\"\nprint(\"own config\")\n");
  Process lua({program("rcssserver3d"), "--agent-port=0", "--server-port=0", "--script-path", own,
               "--init-script-prefix", "/usr/share/spark"});
  lua.line();
  lua.waitForError("own config");
  Process ruby({program("rcssserver3d"), "--agent-port=0", "--server-port=0", "--script-path", "rcssserver3d.rb"});
  ruby.waitForError("rcssserver3d.rb is a Ruby script");
  REQUIRE(Json::parse(ruby.line())["agentPort"] > 0);
}

TEST_CASE("An unknown option or argument is named and ends the program") {
  for (const char* wrong : {"--no-such-option", "surplus"}) {
    const Finished f = runToEnd({program("rcssserver3d"), wrong});
    REQUIRE(f.code == 2);
    REQUIRE_THAT(f.errors, Contains(wrong) && Contains("--help"));
  }
  const Finished port = runToEnd({program("simspark"), "--agent-port", "many"});
  REQUIRE(port.code == 2);
  REQUIRE_THAT(port.errors, Contains("--agent-port"));
  const Finished help = runToEnd({program("simspark"), "--help"});
  REQUIRE(help.code == 0);
  for (const char* option : {"--agent-port", "--server-port", "--script-path", "--init-script-prefix", "--rvdraw-host"})
    REQUIRE_THAT(help.out, Contains(option));
}
