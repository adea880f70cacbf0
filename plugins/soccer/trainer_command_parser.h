#pragma once

#include "api/monitor.h"
#include "match_lookup.h"

namespace spark {

/// Executes the trainer commands of soccer. A child of the monitor server. Malformed commands have no effect; the
/// returned text says why.
class TrainerCommandParser : public Node, public ITrainer {
  SPARK_CLASS(TrainerCommandParser, Node)
 public:
  static void describe(Description<TrainerCommandParser>& d) {
    d.doc("Executes trainer commands: playMode, kickOff, dropBall, ball, agent, select, kill, repos, time, score.");
    d.property("commands", &TrainerCommandParser::commands).doc("Names of the commands that it executes.");
    d.implements<ITrainer>();
  }
  bool command(const Element& command, std::string& why) override;

 private:
  using Player = soccer::Player;
  using Run = std::string (TrainerCommandParser::*)(const Element&);
  static const std::vector<std::pair<std::string_view, Run>>& table();
  std::vector<std::string> commands() const;
  // Each executes a command and returns "", or the reason why it has no effect.
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
  /// The player that (unum n)(team t) of a command name; nullptr if there is none.
  const Player* namedPlayer(const Element& c);
  /// The first selected player; nullptr if there is none.
  const Player* selectedPlayer();

  MatchLookup match_;
};

}  // namespace spark
