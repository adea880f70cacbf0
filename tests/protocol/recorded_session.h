#pragma once
/// \file
/// A recorded lockstep session, and a simulation that replays it in process: same cycles, same messages, no network, no
/// timing.

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "league.h"

namespace spark::test {

/// The contents of a recording (`captures/*/*.jsonl`).
struct Recording {
  std::vector<std::string> agents;                                       ///< their names, in order of connection
  std::map<int, std::vector<std::pair<std::size_t, std::string>>> sent;  ///< by cycle: agent's index, message
  std::map<int, std::vector<std::string>> commands;                      ///< by cycle: the commands of the monitor
  std::vector<std::string> frames;  ///< the monitor's messages, from its first one on
  int start = 0;                    ///< number of simulation steps before the first answer
  int cycles = 0;                   ///< number of messages to the first agent

  explicit Recording(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw Error("there is no recording " + file.string());
    for (std::string line; std::getline(in, line);) {
      const auto row = nlohmann::json::parse(line);
      read(row["cycle"], row["dir"], row["msg"]);
    }
  }

 private:
  void read(int cycle, const std::string& dir, const std::string& message) {
    const std::size_t arrow = dir.find('>');
    const std::string from = dir.substr(0, arrow), to = dir.substr(arrow + 1);
    if (from == "monitor") commands[cycle].push_back(message);
    if (from.starts_with("agent")) sent[cycle].emplace_back(indexOf(from), message);
    if (to == "monitor") frames.push_back(message);
    if (!to.starts_with("agent") || indexOf(to) != 0) return;
    if (cycle == 0) start = static_cast<int>(std::lround(std::stod(message.substr(message.find("(now ") + 5)) / 0.02));
    cycles = cycle + 1;
  }
  std::size_t indexOf(const std::string& name) {
    for (std::size_t i = 0; i < agents.size(); ++i)
      if (agents[i] == name) return i;
    agents.push_back(name);
    return agents.size() - 1;
  }
};

/// Replays a recording in a league. Every agent sends its recorded messages, whatever the answers are.
class Replay {
 public:
  Replay(League& league, const Recording& recording) : league_(league), recording_(recording) {}

  std::vector<std::string> frames;  ///< the monitor's messages

  /// `cycles`: the number of answers to the first agent.
  void play(int cycles) {
    const bool early =
        recording_.frames.front().find("(nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1)))") == std::string::npos;
    league_.run(recording_.start - 3);
    if (early) watch();
    for (std::size_t i = 0; i < recording_.agents.size(); ++i) agents_.push_back(&league_.connectAgent());
    send(0);
    if (!early) league_.run(), watch();
    while (cycle_ < cycles) step();
  }

 private:
  void watch() {
    monitor_ = &league_.connectMonitor();
    frames.push_back(monitor_->read());
  }
  void step() {
    league_.run();
    if (std::string frame = monitor_->read(); !frame.empty()) frames.push_back(std::move(frame));
    bool answered = false;
    for (FakeConnection* agent : agents_) answered |= !agent->read().empty() && agent == agents_.front();
    if (answered) send(++cycle_);
  }
  void send(int cycle) {
    if (const auto c = recording_.commands.find(cycle); c != recording_.commands.end())
      for (const std::string& command : c->second) league_.fromMonitor(*monitor_, command);
    if (const auto s = recording_.sent.find(cycle); s != recording_.sent.end())
      for (const auto& [agent, message] : s->second) league_.fromAgent(*agents_[agent], message);
  }

  League& league_;
  const Recording& recording_;
  std::vector<FakeConnection*> agents_;
  FakeConnection* monitor_ = nullptr;
  int cycle_ = 0;
};

}  // namespace spark::test
