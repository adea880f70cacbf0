#include "worlds.h"

#include "api/monitor.h"
#include "spark/error.h"
#include "spark/script_server.h"

namespace spark::test {

void World::configure(const std::string& config, const Settings& settings) {
  prepare();
  for (const auto& [key, value] : settings) scripts(kernel).addOverride(key, value);
  scripts(kernel).runConfig(config);
  finish();
}

void World::configureByText(const std::string& text) {
  prepare();
  scripts(kernel).run(text, "world");
  finish();
}

void World::prepare() {
  scripts(kernel).addFolder(SPARK_SOURCES "/lua");
  scripts(kernel).run("host = { share = '" SPARK_SOURCES "', scenePaths = { '" SPARK_SOURCES
                      "/tests/scenarios/scenes' }, alone = true }",
                      "host");
}

void World::finish() {
  setProperty(at("/sys/server/simulation"), "rate", "max");
  if (Leaf* net = kernel.root().find("/sys/server/net")) setProperty(*net, "open", false);
  kernel.registerClass<ScriptedPlayer>();
}

ScriptedPlayer& World::join(const std::string& team, int unum, const std::string& robot) {
  auto made = kernel.classOf("ScriptedPlayer").create();
  auto& player = static_cast<ScriptedPlayer&>(*made);
  player.robot = robot;
  made->setName(team + std::to_string(unum));
  if (!kernel.root().find("/usr/agent")) kernel.create("Node", "/usr/agent");
  kernel.root().require<Node>("/usr/agent").add(std::move(made));
  players_.push_back(&player);
  cycles(5);
  player.next = fmt::format("(init (unum {})(teamname {}))", unum, team);
  cycles(4);
  return player;
}

void World::trainer(const std::string& commands) {
  Predicates p;
  readSexp(commands, p);
  for (const Element e : p) {
    std::string why = "unknown command";
    if (!kernel.root().require<ITrainer>("/sys/server/monitor/TrainerCommandParser").command(e, why) || !why.empty())
      throw Error(fmt::format("trainer: {}: {}", e.head(), why));
  }
}

void World::cycles(int count) { callMethod(at("/sys/server/simulation"), "runCycles", std::vector<Value>{count}); }

std::string World::saved() {
  StateWriter out(true);
  saveTree(kernel.root(), out);
  return out.bytes();
}

void World::load(const std::string& state) {
  StateReader in(state);
  loadTree(kernel.root(), in);
  if (!in.atEnd()) throw Error("the saved state is longer than the state of this world");
}

}  // namespace spark::test
