#include "recording.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "test_support.h"

namespace spark::test {

using Json = nlohmann::json;

const std::string& Recording::answer(const std::string& agent, int cycle) const {
  static const std::string kNone;
  const auto messages = answered.find(agent);
  if (messages == answered.end()) return kNone;
  const auto at = messages->second.find(cycle);
  return at == messages->second.end() ? kNone : at->second;
}

Recording readRecording(const std::filesystem::path& file) {
  std::stringstream in;
  if (file.extension() == ".gz")
    in << runToEnd({"/bin/gzip", "-dc", file.string()}).out;
  else
    in << std::ifstream(file).rdbuf();
  Recording r;
  for (std::string line; std::getline(in, line);) {
    const Json row = Json::parse(line);
    const std::string dir = row["dir"];
    const std::size_t arrow = dir.find('>');
    if (dir == "ball") r.ball.push_back(row["msg"]);
    if (arrow == std::string::npos) continue;
    const std::string from = dir.substr(0, arrow), to = dir.substr(arrow + 1);
    const int cycle = row["cycle"];
    if (from.starts_with("agent")) {
      r.sent[cycle].push_back({from, row["msg"]});
      if (std::find(r.agents.begin(), r.agents.end(), from) == r.agents.end()) r.agents.push_back(from);
    } else if (from == "monitor") {
      r.commands[cycle].push_back(row["msg"]);
    } else if (to == "monitor") {
      r.frames.push_back(row["msg"]);
    } else if (to.starts_with("agent")) {
      r.answered[to].emplace(cycle, row["msg"]);
      r.cycles = std::max(r.cycles, cycle + 1);
    }
  }
  return r;
}

LockstepHost::LockstepHost(const std::vector<std::string>& settings) {
  std::vector<std::string> command{(binFolder() / "sparkhost").string(),
                                   "--config",
                                   "soccer.lua",
                                   "--sync",
                                   "--rate",
                                   "max",
                                   "--agent-port",
                                   "0",
                                   "--monitor-port",
                                   "0",
                                   "--log-level",
                                   "warning"};
  // The host waits for every answer, however slow the test is.
  command = joined(command, withoutLimits());
  command.insert(command.end(), {"--set", "/sys/server/gamecontrol.joinBudget=1e9"});
  for (const std::string& s : settings) command.insert(command.end(), {"--set", s});
  process_ = std::make_unique<Process>(command);
  const Json ports = Json::parse(process_->line());
  agentPort = ports["agentPort"];
  monitorPort = ports["monitorPort"];
}

void LockstepHost::halt(bool on) {
  if (on)
    process_->halt();
  else
    process_->signal(SIGCONT);
}

std::string LockstepHost::end() {
  process_->signal(15);
  process_->line();
  process_->wait();
  return process_->errors();
}

std::string replay(const Recording& recording, const std::vector<std::string>& settings,
                   const std::function<void(int, const std::string&, const std::string&)>& each) {
  LockstepHost host(settings);
  host.halt(true);  // all connect and name their robots in one cycle, as recorded
  std::map<std::string, std::unique_ptr<Client>> clients;
  for (const std::string& name : recording.agents) clients[name] = std::make_unique<Client>(host.agentPort);
  Client monitor(host.monitorPort);
  const auto send = [&](int cycle) {
    if (const auto at = recording.commands.find(cycle); at != recording.commands.end())
      for (const std::string& command : at->second) monitor.send(command);
    if (const auto at = recording.sent.find(cycle); at != recording.sent.end())
      for (const auto& [name, message] : at->second)
        if (clients.contains(name)) clients[name]->send(message);
  };
  send(0);
  host.halt(false);
  for (int cycle = 0; cycle < recording.cycles; ++cycle) {
    for (const std::string& name : recording.agents) {
      if (!clients.contains(name)) continue;
      std::string answer;
      try {
        answer = clients[name]->receive();
      } catch (const boost::system::system_error&) {
        clients.erase(name);
      }
      each(cycle, name, answer);
    }
    while (monitor.pending()) monitor.receive();
    send(cycle + 1);
  }
  clients.clear();
  return host.end();
}

}  // namespace spark::test
