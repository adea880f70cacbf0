#pragma once

#include "api/command_check.h"
#include "api/monitor.h"
#include "match_lookup.h"

namespace spark {

/// Executes the trainer commands of soccer. A child of the monitor server. Malformed commands have no effect; the
/// returned text says why. docs/referee.md describes them all; a test compares it with table().
class TrainerCommandParser : public Node, public ITrainer, public ICommandCheck {
  SPARK_CLASS(TrainerCommandParser, Node)
 public:
  static void describe(Description<TrainerCommandParser>& d) {
    d.doc("Executes trainer commands: playMode, kickOff, dropBall, ball, agent, select, kill, repos, time, score.");
    d.property("commands", &TrainerCommandParser::commands).doc("Names of the commands that it executes.");
    d.implements<ITrainer>();
    d.implements<ICommandCheck>();
  }
  bool command(const Element& command, std::string& why) override;
  std::string check(const Element& command) override;

 private:
  using Player = soccer::Player;
  using Run = std::string (TrainerCommandParser::*)(const Element&);
  struct Command {
    std::string_view name, usage;
    Run run;
  };
  static const std::vector<Command>& table();
  static const Command* find(const Element& command);
  /// Runs the command; changes nothing unless `acts_`. Returns "", or why it has no effect.
  std::string run(const Command& command, const Element& c);
  std::vector<std::string> commands() const;
  // Each executes a command, or only checks it, and returns "", or the reason why it has no effect.
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
  bool acts_ = true;  ///< false: commands are only checked
};

}  // namespace spark
