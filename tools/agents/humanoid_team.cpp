#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <vector>

#include "agent_connection.h"
#include "humanoid/player.h"
#include "spark/error.h"

// A team of Naos in one process: one connection and one brain a player, all in one thread. Exit codes: 0 the server closed the match; 1 it
// could not be reached or a player was turned away before he had a team; 2 the command line is wrong.

namespace {
namespace asio = boost::asio;
using humanoid::HumanoidPlayer;
using spark::Predicates;
using spark::agent::AgentConnection;
using spark::agent::Language;

struct Options {
  std::string host = "127.0.0.1", team = "Spark";
  int port = 3100, players = 11, type = -1;
  double patience = 10;
  bool quiet = false;
};

/// A player and his connection.
class Participant {
 public:
  Participant(asio::io_context& io, Language& language, const Options& options, int unum)
      : player_(options.team, unum, options.type >= 0 ? options.type : humanoid::robotType(unum)), connection_(io, language) {
    connection_.connect(options.host, options.port, options.patience);
  }
  void start() {
    Predicates first;
    player_.start(first);
    first.open("syn").close();
    connection_.start(
        first,
        [this](const Predicates& percepts, Predicates& actions) {
          player_.think(percepts, actions);
          actions.open("syn").close();
        },
        [this](const std::string& why) { why_ = why; });
  }
  const HumanoidPlayer& player() const { return player_; }
  const std::string& why() const { return why_; }

 private:
  HumanoidPlayer player_;
  AgentConnection connection_;
  std::string why_;
};

void printResult(const std::string& team, const HumanoidPlayer& player) {
  const humanoid::Percepts& p = player.percepts();
  const bool right = p.side == "right";
  fmt::print(stderr, "{} ({}): {}:{} after {:.2f} s, {}\n", team, p.side, right ? p.scoreRight : p.scoreLeft,
             right ? p.scoreLeft : p.scoreRight, p.gameTime, p.playMode);
}

/// Plays until the server ends the match; true when every player was in a team.
bool play(const Options& options) {
  asio::io_context io(1);
  const auto language = spark::agent::makeLanguage("SexpParser", {});
  std::vector<std::unique_ptr<Participant>> team;
  for (int unum = 1; unum <= options.players; ++unum) team.push_back(std::make_unique<Participant>(io, *language, options, unum));
  for (const auto& p : team) p->start();
  io.run();
  bool all = true;
  for (const auto& p : team) {
    if (!p->player().percepts().side.empty()) continue;
    fmt::print(stderr, "{} {} got no place in the match: {}\n", options.team, p->player().unum(), p->why());
    all = false;
  }
  if (!options.quiet) printResult(options.team, team.front()->player());
  return all;
}
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"A team of Naos that plays soccer against a server.", "humanoid-team"};
  Options options;
  app.add_option("--host", options.host, "The server")->capture_default_str();
  app.add_option("--port", options.port, "Its agent port")->check(CLI::Range(1, 65535))->capture_default_str();
  app.add_option("--team", options.team, "Name of the team")->capture_default_str();
  app.add_option("--players", options.players, "Players, number 1 keeps the goal")->check(CLI::Range(1, 11))->capture_default_str();
  app.add_option("--type", options.type, "Robot type of all players, 0..4; else mixed within the league's limits")->check(CLI::Range(0, 4));
  app.add_option("--patience", options.patience, "Wait so long for a server [s]")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_flag("--quiet", options.quiet, "Do not print the result");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    return play(options) ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "humanoid-team: {}\n", e.what());
    return 1;
  }
}
