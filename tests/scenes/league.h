#pragma once
/// \file
/// The simulation of a league without network and rules, from the same scripts as the configs.

#include "api/agents.h"
#include "spark/script_server.h"
#include "test_support.h"

namespace spark::test {

/// Spark's scenes; `scenes` is a folder with rsg/... that takes precedence.
struct League {
  TestHost host;
  Kernel& kernel = host.kernel;

  explicit League(const std::filesystem::path& scenes = {}, const std::string& variables = "") {
    scripts(kernel).addFolder(std::filesystem::path(SPARK_SOURCES) / "lua");
    std::string text = "host = { share = [[" SPARK_SOURCES "]], scenePaths = {";
    if (!scenes.empty()) text += "[[" + scenes.string() + "]]";
    text += R"(} }
include "house.lua"
include "materials.lua"
include "naotypes.lua"
include "soccer-house.lua"
files() scene() materials() physics("OdeEngine", { exactReplay = true })
simulation().rate = "max"
plugin "gamecontrol"
plugin "sensors"
plugin "effectors"
naoVariables()
soccerVariables{)" +
            variables + "}";
    scripts(kernel).run(text, "league");
  }
  Node& scene() { return kernel.root().require<Node>("/usr/scene"); }
  Node& agent(const std::string& name = "AgentAspect1") { return scene().create<Node>("AgentAspect", name); }
  void importLoosely(const std::string& file, Node& root, const List& arguments = {}) {
    kernel.root().require<ISceneServer>("/sys/server/scene").importScene(file, root, arguments);
  }
  /// Imports a file; throws if that logs a warning.
  void import(const std::string& file, Node& root, const List& arguments = {}) {
    host.text.clear();
    importLoosely(file, root, arguments);
    if (!host.text.empty()) throw Error(file + " was imported, but: " + host.text);
  }
  void run(int cycles) {
    callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
  }
};

}  // namespace spark::test
