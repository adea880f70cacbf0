#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "spark/predicates.h"
#include "test_support.h"

// The beginnings of recorded sessions, replayed against the default league with its own robots and with the original
// scene files. In every cycle the agents get the same percepts in the same order, and the host logs no warning.

using namespace spark;
using namespace spark::test;
using Json = nlohmann::json;

namespace {
constexpr int kCycles = 20;

/// The messages of a recording per cycle and agent.
struct Session {
  std::map<int, std::vector<std::pair<std::string, std::string>>> sent;
  std::map<int, std::map<std::string, std::string>> answered;
  std::vector<std::string> agents;
};

Session load(const std::filesystem::path& file) {
  Session s;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const Json row = Json::parse(line);
    const int cycle = row["cycle"];
    const std::string dir = row["dir"], from = dir.substr(0, dir.find('>')), to = dir.substr(dir.find('>') + 1);
    if (cycle > kCycles) break;
    if (from.starts_with("agent")) {
      s.sent[cycle].emplace_back(from, row["msg"]);
      if (std::find(s.agents.begin(), s.agents.end(), from) == s.agents.end()) s.agents.push_back(from);
    } else if (to.starts_with("agent")) {
      s.answered[cycle].emplace(to, row["msg"]);
    }
  }
  return s;
}

/// Names of the percepts in order: "time GS GYR:torso HJ:hj1 ...". The foot pressure (FRP) is skipped: it is sent only
/// while the foot touches something, and robots that are created inside each other separate differently each time.
std::string order(const std::string& message) {
  Predicates p;
  readSexp(message, p);
  std::string out;
  for (const Element e : p) {
    if (e.head() == "FRP") continue;
    out += std::string(e.head());
    if (const Element n = e.named("n")) out += ":" + std::string(n.at(1).text());
    out += " ";
  }
  return out;
}

/// The number that the host assigns to the agent in this message, 0 if there is none.
std::int64_t numberGiven(const std::string& message) {
  Predicates p;
  readSexp(message, p);
  for (const Element e : p)
    if (const Element u = e.named("unum"); u && e.head() == "GS") return u.at(1).integer();
  return 0;
}

/// `scenes`: a folder of scene files that take precedence over the league's own; empty for none.
void replay(const std::filesystem::path& file, const std::filesystem::path& scenes) {
  const Session session = load(file);
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
  command = joined(command, withoutLimits());
  command.insert(command.end(), {"--set", "/sys/server/gamecontrol.joinBudget=1e9"});
  if (!scenes.empty()) command.insert(command.end(), {"--scene-path", scenes.string()});
  Process host(command);
  const auto port = Json::parse(host.line())["agentPort"].get<unsigned short>();
  host.halt();  // all connect and name their robots in one cycle, as recorded
  std::map<std::string, std::unique_ptr<Client>> clients;
  for (const std::string& name : session.agents) clients[name] = std::make_unique<Client>(port);
  const auto send = [&](int cycle) {
    if (const auto at = session.sent.find(cycle); at != session.sent.end())
      for (const auto& [name, message] : at->second) clients[name]->send(message);
  };
  // The host waits for an agent from the message that names its robot, so its number comes in the message in which it
  // was recorded. With several agents, one may join a cycle before another and receive additional messages while that
  // one joins.
  const bool alone = session.agents.size() == 1;
  std::map<std::string, std::vector<std::pair<int, std::int64_t>>> given, recorded;
  const auto note = [alone](auto& numbers, int cycle, const std::string& message) {
    if (const std::int64_t n = numberGiven(message)) numbers.emplace_back(alone ? cycle : 0, n);
  };
  send(0);
  host.signal(SIGCONT);
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (const auto& [name, message] : session.answered.at(cycle)) {
      CAPTURE(file.filename(), cycle, name);
      const std::string answer = clients[name]->receive();
      REQUIRE(order(answer) == order(message));
      note(given[name], cycle, answer);
      note(recorded[name], cycle, message);
    }
    send(cycle + 1);
  }
  REQUIRE(given == recorded);
  host.signal(15);
  host.line();
  REQUIRE(host.wait() == 0);
  REQUIRE(host.errors() == "");
}
}  // namespace

TEST_CASE("The beginnings of recorded sessions replay without an error") {
  const auto reference = referenceFolder();
  if (reference.empty()) std::exit(77);
  for (const char* name :
       {"nao0-rest", "nao0-all-joints", "nao0-squat-after-beam", "nao3-legs", "four-agents", "ball-bounce-and-roll"}) {
    const auto file = reference / "captures" / "mainline" / (std::string(name) + ".jsonl");
    DYNAMIC_SECTION(name) { replay(file, {}); }
    DYNAMIC_SECTION(name << " with the original robots") { replay(file, reference / "scenes-reference"); }
  }
}
