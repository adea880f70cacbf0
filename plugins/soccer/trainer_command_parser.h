#pragma once

#include "api/monitor.h"
#include "match_lookup.h"

namespace spark {

/// Takes the trainers' commands that concern soccer (protocol section 4.5). Below the monitor server.
class TrainerCommandParser : public Node, public ITrainer {
  SPARK_CLASS(TrainerCommandParser, Node)
 public:
  static void describe(Description<TrainerCommandParser>& d) {
    d.doc("Executes trainers' commands: playMode, kickOff, dropBall, ball, agent, select, kill, repos, time, score.");
    d.property("commands", &TrainerCommandParser::commands).doc("Names of the commands that it takes.");
    d.implements<ITrainer>();
  }
  bool command(const Element& command, std::string& why) override;

 private:
  using Player = soccer::Player;
  using Run = std::string (TrainerCommandParser::*)(const Element&);
  static const std::vector<std::pair<std::string_view, Run>>& table();
  std::vector<std::string> commands() const;
  std::string playMode(const Element& c);
  std::string kickOff(const Element& c);
  std::string dropBall(const Element& c);
  std::string ball(const Element& c);
  std::string agent(const Element& c);
  std::string select(const Element& c);
  std::string kill(const Element& c);
  std::string repos(const Element& c);
  std::string time(const Element& c);
  std::string score(const Element& c);
  const Player* named(const Element& c);
  const Player* selected();

  MatchLookup match_;
};

}  // namespace spark
