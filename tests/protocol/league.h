#pragma once
/// \file
/// The 3D league in process, cycle by cycle, without sockets.

#include <memory>
#include <string>
#include <vector>

#include "api/agents.h"
#include "fake_scene.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// The league without its network: agents and monitors are fake connections.
class League : public TestHost {
 public:
  /// `field`: its scene file; empty: the one of the config. `scenes`: a folder that holds rsg/... and takes precedence;
  /// empty: only the project's scenes. `settings`: options in the format of --set.
  explicit League(const std::string& field = {}, const std::filesystem::path& scenes = {},
                  const std::vector<std::pair<std::string, Value>>& settings = {}) {
    const auto share = pluginFolder().parent_path() / "share" / "spark";
    scripts(kernel).addFolder(share / "lua");
    const std::string paths = scenes.empty() ? "" : "'" + scenes.string() + "'";
    scripts(kernel).run(fmt::format("host = {{ share = '{}', scenePaths = {{ {} }} }}", share.string(), paths), "test");
    for (const char* port : {"agents", "monitors"})
      scripts(kernel).addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
    if (!field.empty()) scripts(kernel).addOverride("scene", field);
    for (const char* noise : {"Soccer.BeamNoiseXY", "Soccer.BeamNoiseAngle"}) scripts(kernel).addOverride(noise, 0);
    for (const auto& [key, value] : settings) scripts(kernel).addOverride(key, value);
    scripts(kernel).runConfig("soccer.lua");
    setProperty(at("/sys/server/simulation"), "rate", "max");
  }
  Leaf& at(std::string_view path) { return kernel.root().require<Leaf>(path); }
  void run(int cycles = 1) { callMethod(at("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles}); }
  FakeConnection& connect(const char* server, const char* port) {
    connections_.push_back(
        std::make_unique<FakeConnection>(kernel.root().require<Node>(port), connections_.size() + 1));
    kernel.root().require<IConnectionConsumer>(server).connected(*connections_.back());
    return *connections_.back();
  }
  FakeConnection& connectAgent() { return connect("/sys/server/gamecontrol", "/sys/server/net/agents"); }
  FakeConnection& connectMonitor() { return connect("/sys/server/monitor", "/sys/server/net/monitors"); }
  void fromAgent(FakeConnection& agent, std::string_view message) {
    kernel.root().require<IConnectionConsumer>("/sys/server/gamecontrol").received(agent, message);
  }
  void fromMonitor(FakeConnection& monitor, std::string_view message) {
    kernel.root().require<IConnectionConsumer>("/sys/server/monitor").received(monitor, message);
  }

 private:
  std::vector<std::unique_ptr<FakeConnection>> connections_;
};

}  // namespace spark::test
