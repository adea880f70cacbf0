#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "absence.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {
std::vector<std::string> host(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), program("sparkhost"));
  return arguments;
}

/// A config with only a run loop and a control socket.
const char* kSmall = R"(
include "house.lua"
files()
simulation()
control()
answer = option{ name = "answer", default = 42, doc = "What to do?" }
)";
/// kSmall with agents and monitors.
const char* kServing = R"(
include "house.lua"
files() scene() simulation()
agents{} monitors{} control()
)";
}  // namespace

TEST_CASE("--check loads and wires everything, executes no step, and prints nothing to stdout") {
  TemporaryFolder folder;
  const Finished good = runToEnd(host({"--config", folder.write("good.lua", kSmall), "--check"}));
  REQUIRE(good.code == 0);
  REQUIRE(good.out.empty());
  const Finished bad = runToEnd(
      host({"--config", folder.write("bad.lua", std::string(kSmall) + "new('Simulatoin', '/sys/x')\n"), "--check"}));
  REQUIRE(bad.code == 2);
  REQUIRE_THAT(bad.errors, Contains("bad.lua:7") && Contains("'Simulation'"));
}

TEST_CASE("--check fails for errors that a run only logs: missing scene files and misspelt methods") {
  TemporaryFolder folder;
  folder.write("rsg/whole.rsg", "(RSG 0 1)\n((nd Transform (setName a) (setLocalPos 0 0 1)))\n");
  folder.write("rsg/wheel.rsg", "(RSG 0 1)\n((nd Transform\n  (importScene rsg/weel.rsg)))\n");
  folder.write("rsg/method.rsg", "(RSG 0 1)\n((nd Transform\n  (setLocalPso 0 0 1)))\n");
  const auto check = [&](const std::string& name, const std::string& more) {
    const std::string config =
        folder.write(name + ".lua", "include \"house.lua\"\nfiles() scene() simulation()\n" + more);
    return runToEnd(host({"--config", config, "--scene-path", folder.path().string(), "--check"}));
  };
  const auto scene = [](const std::string& file) { return "get(\"/usr/scene\"):importScene(\"" + file + "\")\n"; };
  const Finished whole = check("whole", scene("rsg/whole.rsg"));
  CAPTURE(whole.errors);
  CHECK(whole.code == 0);
  const Finished wheel = check("wheel", scene("rsg/wheel.rsg"));
  CHECK(wheel.code == 2);
  CHECK_THAT(wheel.errors, Contains("wheel.lua:3") && Contains("rsg/wheel.rsg:3") && Contains("rsg/weel.rsg"));
  const Finished loose =
      check("loose", "get(\"/sys/server/scene/rsg\").looseImports = true\n" + scene("rsg/wheel.rsg"));
  CHECK(loose.code == 2);
  CHECK_THAT(loose.errors,
             Contains("rsg/wheel.rsg:3") && Contains("rsg/weel.rsg") && Contains("the check failed: 1 error"));
  const Finished method = check("method", scene("rsg/method.rsg"));
  CHECK(method.code == 2);
  CHECK_THAT(method.errors,
             Contains("rsg/method.rsg:3:4") && Contains("'setLocalPos'") && Contains("the check failed: 1 error"));
  const Finished gone = check("gone", scene("rsg/gone.rsg"));
  CHECK(gone.code == 2);
  CHECK_THAT(gone.errors, Contains("rsg/gone.rsg") && Contains("gone.lua:3"));
  const Finished config = check("config", "new(\"Transform\", \"/usr/scene/a\"):setLocalPso(0, 0, 1)\n");
  CHECK(config.code == 2);
  CHECK_THAT(config.errors, Contains("config.lua:3") && Contains("'setLocalPos'"));
  const Finished quiet = runToEnd(host({"--config", (folder.path() / "wheel.lua").string(), "--scene-path",
                                        folder.path().string(), "--check", "--log-level", "off"}));
  CHECK(quiet.code == 2);
}

TEST_CASE("A missing config is an error that lists the folders searched") {
  const Finished f = runToEnd(host({"--config", "no-such-config.lua"}));
  REQUIRE(f.code == 2);
  REQUIRE_THAT(f.errors, Contains("no-such-config.lua") && Contains("share/spark/lua"));
}

TEST_CASE("--set accepts options and properties, and an unknown name is an error with the nearest name") {
  TemporaryFolder folder;
  const std::string config = folder.write("small.lua", kSmall);
  REQUIRE(
      runToEnd(host({"--config", config, "--check", "--set", "answer=43", "--set", "/sys/server/simulation.step=0.01"}))
          .code == 0);
  const Finished unknown = runToEnd(host({"--config", config, "--check", "--set", "anwser=43"}));
  REQUIRE(unknown.code == 2);
  REQUIRE_THAT(unknown.errors, Contains("anwser") && Contains("'answer'"));
  const Finished range = runToEnd(host({"--config", config, "--check", "--set", "/sys/server/simulation.step=-3"}));
  REQUIRE(range.code == 2);
  REQUIRE_THAT(range.errors, Contains("step") && Contains("-3"));
  REQUIRE(runToEnd(host({"--config", config, "--check", "--set", "answer"})).code == 2);
}

TEST_CASE("A flag for a feature that the config lacks is an error that names the flag") {
  const auto error = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--config", "boxes.lua", "--check"});
    const Finished f = runToEnd(host(arguments));
    REQUIRE(f.code == 2);
    return f.errors;
  };
  CHECK_THAT(error({"--monitor-port", "3200"}),
             Contains("--monitor-port 3200: config 'boxes.lua' has no port for monitors: add monitors{} of "
                      "house.lua; or omit --monitor-port."));
  CHECK_THAT(error({"--agent-port", "0"}),
             Contains("--agent-port 0: config 'boxes.lua' has no agents and no port for them"));
  CHECK_THAT(error({"--expect", "2"}), Contains("--expect 2: config 'boxes.lua' has no agents and no port for them"));
  CHECK_THAT(error({"--set", "web=false", "--web-port", "0"}),
             Contains("--web-port 0: config 'boxes.lua' has no page for browsers"));
  const Finished f = runToEnd(
      host({"--config", "soccer-sphere.lua", "--check", "--set", "agentSocket=agents.sock", "--agent-port", "3100"}));
  CHECK(f.code == 2);
  CHECK_THAT(f.errors, Contains("--agent-port 3100: /sys/server/net/agents is a UnixPort, which has no property "
                                "'port'; omit --agent-port."));
  REQUIRE(runToEnd(host({"--config", "boxes.lua", "--check", "--web-port", "0", "--rate", "max", "--sync"})).code == 0);
}

TEST_CASE("A seed that is not a number or exceeds 64 bits is refused") {
  TemporaryFolder folder;
  const std::string config = folder.write("small.lua", kSmall);
  for (const char* seed : {"-1", "18446744073709551616", "99999999999999999999", "1.5", "0x", "many", "1 "}) {
    const Finished f = runToEnd(host({"--config", config, "--check", "--seed", seed}));
    INFO(f.errors);
    REQUIRE(f.code == 2);
    REQUIRE_THAT(f.errors + f.out,
                 Contains("--seed: expected a whole number from 0 to 18446744073709551615 (64 bits), found '" +
                          std::string(seed) + "'"));
  }
  for (const char* seed : {"0", "18446744073709551615"})
    REQUIRE(runToEnd(host({"--config", config, "--check", "--seed", seed})).code == 0);
}

TEST_CASE("A wrong command line ends with exit code 2 and an explanation") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"--config", "x.lua", "--rate", "fast"},
                                             {"--config", "x.lua", "--agent-port", "70000"},
                                             {"--config", "x.lua", "--dance"},
                                             {"--config", "x.lua", "--plugin-path", "/no/such/folder"}}) {
    const Finished f = runToEnd(host(arguments));
    REQUIRE(f.code == 2);
    REQUIRE(f.out.empty());
    REQUIRE_FALSE(f.errors.empty());
  }
}

TEST_CASE("stdout holds only the ports in its first line and the result in its last") {
  TemporaryFolder folder;
  Process p(host({"--config", folder.write("serving.lua", kServing), "--agent-port", "0", "--monitor-port", "0",
                  "--rate", "max", "--duration", "2"}));
  const Json ports = Json::parse(p.line());
  REQUIRE(ports["agentPort"].get<int>() > 0);
  REQUIRE(ports["monitorPort"].get<int>() > 0);
  REQUIRE(ports["agentPort"] != ports["monitorPort"]);
  const Json result = Json::parse(p.line());
  REQUIRE(result["cycles"] == 100);
  REQUIRE(result["simSeconds"] == 2.0);
  REQUIRE(result["realTimeFactor"].get<double>() > 0);
  REQUIRE_FALSE(result.contains("score"));  // nothing reports one
  REQUIRE(result["agentsSeen"] == 0);
  REQUIRE(result["messagesDropped"] == 0);
  REQUIRE(result["stateHash"].get<std::string>().size() == 16);
  REQUIRE(p.rest().empty());
  REQUIRE(p.wait() == 0);
}

TEST_CASE("--histogram prints the delays and durations of cycles to stderr") {
  TemporaryFolder folder;
  const std::string config = folder.write("small.lua", kSmall);
  const Finished f = runToEnd(host({"--config", config, "--rate", "max", "--duration", "0.1", "--histogram"}));
  REQUIRE(f.code == 0);
  REQUIRE_THAT(f.errors, Contains("99.9 %") && Contains("long         5"));
  const Finished without = runToEnd(host({"--config", config, "--rate", "max", "--duration", "0.1"}));
  REQUIRE(lacks(without.errors, "99.9 %", f.errors));
}

TEST_CASE("SIGINT and SIGTERM end a run with its result") {
  TemporaryFolder folder;
  for (const int number : {SIGINT, SIGTERM}) {
    Process p(host({"--config", folder.write("small.lua", kSmall)}));
    p.line();
    p.signal(number);
    REQUIRE(Json::parse(p.line())["cycles"].get<int>() >= 0);
    REQUIRE(p.wait() == 0);
  }
}

TEST_CASE("A host that waits for agents ends on a signal") {
  TemporaryFolder folder;
  Process p(host({"--config", folder.write("serving.lua", kServing), "--agent-port", "0", "--monitor-port", "0",
                  "--sync", "--expect", "5"}));
  p.line();
  p.signal(SIGTERM);
  REQUIRE(Json::parse(p.line())["cycles"] == 0);
  REQUIRE(p.wait() == 0);
}

TEST_CASE("A port in use is an error that names the port") {
  TemporaryFolder folder;
  const std::string config = folder.write("serving.lua", kServing);
  Process first(host({"--config", config, "--agent-port", "0", "--monitor-port", "0"}));
  const Json ports = Json::parse(first.line());
  const std::string taken = std::to_string(ports["agentPort"].get<int>());
  const Finished second = runToEnd(host({"--config", config, "--agent-port", taken, "--monitor-port", "0"}));
  REQUIRE(second.code == 2);
  REQUIRE_THAT(second.errors, Contains(taken));
}

TEST_CASE("--list-plugins and --describe print the available plugins and classes") {
  const Finished list = runToEnd(host({"--list-plugins"}));
  REQUIRE(list.code == 0);
  REQUIRE_THAT(list.out, Contains("simulation 1.0") && Contains("ControlServer"));
  const Finished described = runToEnd(host({"--describe", "Simulation"}));
  REQUIRE(described.code == 0);
  REQUIRE_THAT(described.out, Contains("number [s]") && Contains("default 0.02") &&
                                  Contains("runCycles(count: integer)") && Contains("plugin: simulation"));
  const Finished unknown = runToEnd(host({"--describe", "Simulatoin"}));
  REQUIRE(unknown.code == 2);
  REQUIRE_THAT(unknown.errors, Contains("'Simulation'"));
  REQUIRE_THAT(runToEnd(host({"--version"})).out, Contains("sparkhost"));
}

TEST_CASE("Broken plugins in a folder are reported, and the host starts") {
  TemporaryFolder folder;
  folder.write("broken/broken.so", "this is no library");
  const Finished f = runToEnd(host({"--config", folder.write("small.lua", kSmall), "--check", "--plugin-path",
                                    (folder.path() / "broken").string()}));
  REQUIRE(f.code == 0);
  REQUIRE_THAT(f.errors, Contains("broken.so"));
}

/// Runs sparkctl on a running instance.
static auto controlOf(const Process& p) {
  return
      [pid = p.pid()](const std::vector<std::string>& arguments) { return runToEnd(joined(sparkctl(pid), arguments)); };
}

TEST_CASE("sparkctl shows and changes a running simulation") {
  TemporaryFolder folder;
  Process p(
      host({"--config", folder.write("small.lua", std::string(kSmall) + "new(\"Node\", \"/usr/thing/inner\")\n")}));
  p.line();
  const auto ctl = controlOf(p);
  REQUIRE_THAT(ctl({"tree", "/sys"}).out, Contains("simulation  (Simulation)") && Contains("run loop"));
  REQUIRE_THAT(ctl({"tree", "/sys/server/simulation", "--links"}).out,
               Contains("an IInputSource among the children of the Node at /sys/server: /sys/server/control"));
  REQUIRE_THAT(ctl({"get", "/sys/server/simulation.step"}).out,
               Contains("step = 0.02 s") && Contains("Simulated time of one cycle."));
  REQUIRE_THAT(ctl({"plugins"}).out, Contains("* control"));
  REQUIRE_THAT(ctl({"ask", "weather"}).errors,
               Contains("expected tree, get,") && Contains("or percepts, found 'weather'"));
  REQUIRE_THAT(ctl({"ask", "joints"}).errors, Contains("lacks a text \"path\""));
  REQUIRE(Json::parse(ctl({"ask", "joints", "/sys/server"}).out) == Json{{"joints", Json::array()}});
  REQUIRE(ctl({"set", "/sys/server/simulation.step", "0.01"}).code == 0);
  REQUIRE_THAT(ctl({"get", "/sys/server/simulation.step"}).out, Contains("0.01 s"));
  REQUIRE(ctl({"set", "/sys/server/simulation.step", "soon"}).code == 1);
  REQUIRE(ctl({"set", "/usr/thing/inner.name", "007"}).code == 0);  // text remains text
  REQUIRE_THAT(ctl({"get", "/usr/thing/007.name"}).out, Contains("name = 007"));
  REQUIRE(ctl({"call", "/usr/thing/007.setName", "1e3"}).code == 0);
  REQUIRE_THAT(ctl({"tree", "/usr"}).out, Contains("─ 1e3\n"));
  REQUIRE(ctl({"get", "/nowhere"}).code == 1);
  REQUIRE(ctl({"call", "/sys/server/simulation.stop"}).code == 0);
  REQUIRE(Json::parse(p.line())["cycles"].get<int>() > 0);
  REQUIRE(p.wait() == 0);
}

TEST_CASE("sparkctl switches offside off and on in a running match") {
  Process p(host({"--config", "soccer.lua", "--set", "team=Red Blue", "--set", "players=2", "--set", "offside=true"}));
  p.line();
  const auto ctl = controlOf(p);
  const std::string rule = "/sys/server/gamecontrol/OffsideAspect.enabled";
  CHECK_THAT(ctl({"get", rule}).out, Contains("enabled = true"));
  CHECK(ctl({"set", rule, "false"}).code == 0);
  CHECK_THAT(ctl({"get", rule}).out, Contains("enabled = false"));
  CHECK(ctl({"set", rule, "true"}).code == 0);
  CHECK_THAT(ctl({"get", rule}).out, Contains("enabled = true"));
  CHECK(ctl({"call", "/sys/server/simulation.stop"}).code == 0);
  CHECK(p.wait() == 0);
}

TEST_CASE("sparkctl loads and unloads plugins of a running simulation") {
  TemporaryFolder folder;
  Process p(host({"--config", folder.write("small.lua", kSmall)}));
  p.line();
  const auto ctl = controlOf(p);
  CHECK(ctl({"get", "/classes/DrawingServer"}).code == 1);
  for (int i = 0; i < 2; ++i) {
    CHECK(ctl({"load", "drawing"}).code == 0);
    CHECK(ctl({"get", "/classes/DrawingServer"}).code == 0);
    CHECK(ctl({"unload", "drawing"}).code == 0);
    CHECK(ctl({"get", "/classes/DrawingServer"}).code == 1);
  }
  CHECK(ctl({"load", "drawing"}).code == 0);
  CHECK(ctl({"call", "/plugins/drawing.unload"}).code == 0);
  CHECK(ctl({"get", "/classes/DrawingServer"}).code == 1);
  const Finished used = ctl({"unload", "simulation"});
  CHECK(used.code == 1);
  CHECK_THAT(used.errors, Contains("cannot unload plugin 'simulation' while its objects live") &&
                              Contains("/sys/server/simulation"));
  const Finished typo = ctl({"load", "drawin"});
  CHECK(typo.code == 1);
  CHECK_THAT(typo.errors, Contains("there is no plugin 'drawin'") && Contains("'drawing'"));
  p.signal(SIGTERM);
  p.line();
  CHECK(p.wait() == 0);
}

TEST_CASE("sparkctl changes the level of the log and reads the last messages, and a file gets them, too") {
  TemporaryFolder folder;
  const std::string config = folder.write("small.lua", std::string(kSmall) + "print 'said by the config'\n"),
                    file = (folder.path() / "log.txt").string();
  Process p(host({"--config", config, "--log-level", "error", "--set", "logLines=50", "--set", "logFile=" + file}));
  p.line();
  const auto ctl = controlOf(p);
  CHECK_THAT(ctl({"get", "/sys/server/log.level"}).out, Contains("error"));
  CHECK(ctl({"set", "/sys/server/log.level", "debug"}).code == 0);
  CHECK_THAT(ctl({"get", "/sys/server/log.level"}).out, Contains("debug"));
  const Finished typo = ctl({"set", "/sys/server/log.level", "debg"});
  CHECK(typo.code == 1);
  CHECK_THAT(typo.errors, Contains("expected one of 'trace', 'debug', 'info', 'warning', 'error', 'off'"));
  CHECK_THAT(ctl({"call", "/sys/server/log/memory.tail", "1000"}).out, Contains("said by the config"));
  CHECK(ctl({"set", "/sys/server/log/file.level", "off"}).code == 0);
  p.signal(SIGTERM);
  p.line();
  CHECK(p.wait() == 0);
  CHECK_THAT(textOf(file), Contains("said by the config"));
}

TEST_CASE("sparkctl refuses to rename or remove the servers of a running simulation") {
  TemporaryFolder folder;
  Process p(host({"--config", folder.write("serving.lua", kServing), "--agent-port", "0", "--monitor-port", "0"}));
  p.line();
  const auto refused = [ctl = controlOf(p)](const std::vector<std::string>& arguments) {
    const Finished f = ctl(arguments);
    CAPTURE(arguments.back(), f.out);
    CHECK(f.code == 1);
    return f.errors;
  };
  for (const char* path : {"/sys", "/sys/server", "/sys/server/gamecontrol", "/sys/server/simulation",
                           "/sys/server/net", "/usr", "/usr/scene"})
    CHECK_THAT(refused({"set", std::string(path) + ".name", "x"}),
               Contains(std::string("cannot name ") + path + " 'x' now"));
  for (const char* call : {"/sys/server/gamecontrol.unlinkLeaf", "/sys/server.unlinkChildren",
                           "/sys/server/simulation.unlinkLeaf", "/sys.unlinkChildren"})
    CHECK_THAT(refused({"call", call}), Contains("cannot remove") && Contains("servers stay until its end"));
  p.signal(SIGTERM);
  CHECK(Json::parse(p.line())["cycles"].get<int>() > 0);
  CHECK(p.wait() == 0);
}

TEST_CASE("sparkctl --wait waits for a simulation that starts later") {
  TemporaryFolder folder;  // with the sockets of no other simulation
  for (const char* name : {"XDG_RUNTIME_DIR", "TMPDIR"}) setenv(name, folder.path().c_str(), 1);
  const std::string config = folder.write("small.lua", "include \"house.lua\"\nfiles() simulation() control()\n");
  Process early({program("sparkctl"), "--wait", "1800", "get", "/sys/server/simulation.step"});
  Process host({program("sparkhost"), "--config", config, "--log-level", "error"});
  for (const char* name : {"XDG_RUNTIME_DIR", "TMPDIR"}) unsetenv(name);
  CHECK_THAT(early.line(), Contains("step = 0.02"));
  CHECK(early.wait() == 0);
  host.line();
  host.signal(SIGTERM);
  CHECK(host.wait() == 0);
}

TEST_CASE("sparkctl --pid means that process alone, not one whose number ends or begins with the same digits") {
  TemporaryFolder folder;
  Process p(host({"--config", folder.write("small.lua", kSmall)}));
  p.line();
  const std::string pid = std::to_string(p.pid());
  const auto step = [](const std::string& which) {
    return runToEnd({program("sparkctl"), "--pid", which, "get", "/sys/server/simulation.step"});
  };
  CHECK(step(pid).code == 0);
  for (const int number : {p.pid() % 10, p.pid() % 100, p.pid() % 1000, p.pid() / 10}) {
    if (number == 0 || number == p.pid()) continue;
    const std::string other = std::to_string(number);
    CAPTURE(pid, other);
    CHECK_THAT(step(other).errors, Contains("has no simulation"));
  }
}

TEST_CASE("sparkctl reports that there is no instance to connect to") {
  TemporaryFolder folder;
  setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
  const Finished f = runToEnd({program("sparkctl"), "--pid", "1", "tree"});
  unsetenv("XDG_RUNTIME_DIR");
  REQUIRE(f.code == 1);
  REQUIRE_THAT(f.errors, Contains("no simulation"));
}
