#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "absence.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Catch::Contains;

namespace {
std::string plugins() { return (binFolder().parent_path() / "tests" / "crash-plugins").string(); }

/// Runs a host with the crashing plugin and a config that uses it.
struct Crashing {
  TemporaryFolder folder;
  std::vector<std::string> command(const std::string& config, std::vector<std::string> more = {}) const {
    const std::string text =
        "include \"house.lua\"\nfiles() scene() simulation()\nplugin \"gamecontrol\"\nplugin \"crashing\"\n";
    std::vector<std::string> out{(binFolder() / "sparkhost").string(), "--config",
                                 folder.write("crash.lua", text + config), "--plugin-path", plugins()};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  Finished run(const std::string& config, std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--rate", "max"});
    return runToEnd(command(config, std::move(more)));
  }
  std::string hook(const std::string& how) const {
    return "local h = new('CrashHook', '/usr/thing/h')\nh.how = '" + how + "'\nh.stopFile = '" + folder.file("go") +
           "'\n";
  }
  /// An agent inside the host; its robot has the crashing sensor.
  std::string agent(const std::string& how) const {
    folder.write("rsg/agent/robot.rsg", "(RSG 0 1)\n((nd TRF (nd CrashSensor (setName eye) (setHow " + how +
                                            ") (setStopFile " + folder.file("go") + "))))\n");
    return "agents{ port = 0 }\n"
           "new('ScriptBehavior', '/usr/agent/b'):on('start', function(self) self.actions = '(scene "
           "rsg/agent/robot.rsg)' end)\n";
  }
  std::vector<std::string> scenes() const {
    return {"--scene-path", folder.path().string(), "--agent-port", "0", "--duration", "2"};
  }
};
}  // namespace

TEST_CASE("A host that a sensor crashes names the sensor in its last line and ends by the signal") {
  const Crashing c;
  for (const char* threads : {"1", "3"}) {
    auto more = c.scenes();
    more.insert(more.end(), {"--set", std::string("/sys/server/simulation.threads=") + threads});
    const Finished f = c.run(c.agent("null"), more);
    CHECK(f.code == 128 + SIGSEGV);
    CHECK_THAT(f.errors, Contains("sparkhost: crashed by SIGSEGV at address 0x0 in sense of "
                                  "/usr/scene/AgentAspect1/TRF/eye "
                                  "(class CrashSensor of plugin crashing). A debugger (gdb) shows the line.\n") ||
                             Contains("sparkhost: crashed by SIGSEGV at address 0x0 in sense of "
                                      "/usr/scene/AgentAspect1/Transform/eye "
                                      "(class CrashSensor of plugin crashing). A debugger (gdb) shows the line.\n"));
  }
}

TEST_CASE("The crash message names the handler for every kind of crash") {
  const Crashing c;
  const std::vector<std::tuple<const char*, int, const char*>> ways{{"null", SIGSEGV, "SIGSEGV at address 0x0"},
                                                                    {"divide", SIGFPE, "SIGFPE"},
                                                                    {"abort", SIGABRT, "SIGABRT"},
                                                                    {"deep", SIGSEGV, "SIGSEGV at address 0x"}};
  for (const auto& [how, number, words] : ways) {
    CAPTURE(how);
    const Finished f = c.run(c.hook(how), {"--duration", "1"});
    CHECK(f.code == 128 + number);
    CHECK_THAT(f.errors, Contains(std::string("sparkhost: crashed by ") + words));
    CHECK_THAT(f.errors, Contains(" in prepare of /usr/thing/h (class CrashHook of plugin crashing)"));
  }
}

TEST_CASE("A crash at set-up is reported with the name of the property or the class of the constructor") {
  const Crashing c;
  const Finished set = c.run(c.hook("null") + "h.atOnce = true\n");
  CHECK(set.code == 128 + SIGSEGV);
  CHECK_THAT(set.errors, Contains(" in atOnce of /usr/thing/h (class CrashHook of plugin crashing)"));
  const Finished made = c.run("new('NullNode', '/usr/n')\n");
  CHECK(made.code == 128 + SIGSEGV);
  CHECK_THAT(made.errors, Contains(" in the constructor of class NullNode of plugin crashing."));
}

TEST_CASE("A signal sent from outside ends the host with the same message") {
  const Crashing c;
  Process p(c.command(""));
  p.line();
  p.signal(SIGSEGV);
  CHECK(p.wait() == 128 + SIGSEGV);
  CHECK_THAT(p.errors(), Contains("sparkhost: crashed by SIGSEGV"));
}

TEST_CASE("A constructor that calls kernel() or throws is an error that names the class") {
  const Crashing c;
  const Finished eager = c.run("new('EagerNode', '/usr/n')\n");
  CHECK(eager.code == 2);
  CHECK_THAT(eager.errors, Contains("crash.lua:5: the constructor of class EagerNode of plugin crashing failed") &&
                               Contains("kernel() is not there in a constructor") && Contains("onLink()"));
  const Finished throwing = c.run("new('ThrowingNode', '/usr/n')\n");
  CHECK(throwing.code == 2);
  CHECK_THAT(
      throwing.errors,
      Contains("crash.lua:5: the constructor of class ThrowingNode of plugin crashing failed\n  because: no hardware"));
}

TEST_CASE("A hook that throws in every cycle is logged once and counted") {
  const Crashing c;
  const Finished f = c.run(c.hook("throw"), {"--duration", "2"});
  CHECK(f.code == 0);
  const std::string words = "prepare of /usr/thing/h (class CrashHook of plugin crashing) failed: broken as ordered";
  REQUIRE_THAT(f.errors, Contains(words) && Contains("counted, not logged"));
  CHECK(f.errors.find(words) == f.errors.rfind(words));
  CHECK(nlohmann::json::parse(f.out.substr(f.out.find('\n') + 1))["faults"] == 100);
}

TEST_CASE("A failing sensor and a failing script are counted, too") {
  const Crashing c;
  const Finished sensor = c.run(c.agent("throw"), c.scenes());
  CHECK(sensor.code == 0);
  CHECK(nlohmann::json::parse(sensor.out.substr(sensor.out.find('\n') + 1))["faults"] == 1);
  const Finished script = c.run("on('rule', function() nosuch() end)\n", {"--duration", "1"});
  CHECK(script.code == 0);
  CHECK(nlohmann::json::parse(script.out.substr(script.out.find('\n') + 1))["faults"] == 50);
}

TEST_CASE("The watchdog names a hanging object once per report, while it hangs") {
  const Crashing c;
  for (const bool sensor : {true, false}) {
    auto more = sensor ? c.scenes() : std::vector<std::string>{"--duration", "2"};
    more.insert(more.end(), {"--rate", "max", "--set", "/sys/host/watchdog.after=0.5"});
    Process p(c.command(sensor ? c.agent("hang") : c.hook("hang"), more));
    p.line();
    const std::string words = sensor ? "/eye (class CrashSensor of plugin crashing)."
                                     : "it has been in prepare of /usr/thing/h (class CrashHook of plugin crashing).";
    p.waitForError(words);
    p.signal(SIGTERM);
    p.waitForError("It was asked to end; a second signal ends it at once.");
    std::ofstream(c.folder.file("go")) << "";
    p.waitForError("The simulation goes on after ");
    p.line();
    CHECK(p.wait() == 0);
    // The report is repeated on the stop request. On a slow machine other calls may be reported as hanging, too.
    const std::string said = p.errors();
    CHECK(said.find(words) != said.rfind(words));
    CHECK(said.find(words, said.find(words) + 1) == said.rfind(words));
    std::filesystem::remove(c.folder.file("go"));
  }
}

TEST_CASE("A disabled watchdog reports nothing") {
  const Crashing c;
  const auto watched = [&](const char* after) {
    return c.command(c.hook("hang") + "get('/sys/host/watchdog').after = " + after + "\n");
  };
  // Both hang, that without a watchdog for longer.
  Process without(watched("0"));
  without.line();
  Process with(watched("0.5"));
  with.line();
  const std::string words = "it has been in prepare of /usr/thing/h";
  with.waitForError(words);
  std::ofstream(c.folder.file("go")) << "";
  for (Process* p : {&without, &with}) {
    p->signal(SIGTERM);
    p->line();
    CHECK(p->wait() == 0);
  }
  CHECK(lacks(without.errors(), words, with.errors()));
}
