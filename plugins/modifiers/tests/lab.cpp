#include "lab.h"

#include "spark/error.h"
#include "spark/script_server.h"

namespace spark::test {

Lab::Lab(const std::string& robot, int agents, int threads) {
  folder_.write("rsg/agent/robot.rsg", "(RSG 0 1)\n(" + robot + "\n)\n");
  scripts(kernel).setGlobal("folder", folder_.path().string());
  scripts(kernel).run(R"lua(
      for _, name in ipairs { "files", "scene", "scene-rsg", "simulation", "gamecontrol", "sensors", "modifiers" } do
        plugin(name)
      end
      new("FileServer", "/sys/server/file")
      new("DirectoryFileSystem", "/sys/server/file/lab").path = folder
      new("SceneServer", "/sys/server/scene")
      new("RsgImporter", "/sys/server/scene/rsg")
      new("Scene", "/usr/scene")
      new("Simulation", "/sys/server/simulation").rate = "max"
      new("GameControl", "/sys/server/gamecontrol"))lua",
                      "lab");
  kernel.registerClass<CycleSensor>();
  kernel.registerClass<Recorder>();
  kernel.registerClass<Speaker>();
  kernel.jobs().setThreads(threads);
  for (int i = 0; i < agents; ++i)
    speakers.push_back(&kernel.create<Speaker>("Speaker", fmt::format("/usr/agent/{}", i)));
  control = kernel.root().find<IGameControl>();
  run(3);
  if (control->agentsSeen() != agents) throw Error("The robots could not be loaded:\n" + text);
}

void Lab::run(int cycles) {
  callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
}

Leaf& Lab::part(std::string_view path, int agent) {
  return kernel.root().require<Leaf>(fmt::format("/usr/scene/AgentAspect{}/{}", agent, path));
}

std::string Lab::sense(int agent) {
  run(1);
  return sensed(agent);
}

std::string Lab::sensed(int agent, int decimals) const {
  std::string out;
  const Predicates* p = control->percepts(*control->agents().at(static_cast<std::size_t>(agent) - 1));
  if (p) writeSexp(*p, decimals, out);
  return out;
}

std::string Lab::act(const std::string& actions, const char* name) {
  speakers[0]->next = actions;
  auto& recorder = static_cast<Recorder&>(part(name));
  recorder.done.clear();
  run(1);
  std::string out;
  writeSexp(recorder.done, 2, out);
  return out;
}

std::string Lab::save() {
  StateWriter out(true);
  saveTree(kernel.root(), out);
  return out.bytes();
}

void Lab::load(const std::string& state) {
  StateReader in(state);
  loadTree(kernel.root(), in);
}

}  // namespace spark::test
