#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "agent_connection.h"
#include "player.h"
#include "spark/error.h"

// A team of spheres in one process: one connection and one brain a player. Exit codes: 0 the server closed the match; 1 it could not be
// reached or a player was turned away before he had a team; 2 the command line is wrong.

namespace {
namespace fs = std::filesystem;
namespace asio = boost::asio;
using spark::Predicates;
using spark::SpherePlayer;
using spark::agent::AgentConnection;
using spark::agent::Language;

struct Options {
  std::string host = "127.0.0.1", team = "Spark", parser = "SexpParser", robot = "rsg/agent/sphere.rsg";
  int port = 3100, players = 11;
  double patience = 10;
  bool reverse = false, quiet = false;
};

/// A player and his connection.
class Participant {
 public:
  Participant(asio::io_context& io, Language& language, const Options& options, int unum)
      : player_(options.team, unum), connection_(io, language) {
    player_.setScene(options.robot);
    connection_.connect(options.host, options.port, options.patience);
  }
  void start() {
    Predicates first;
    player_.start(first);
    connection_.start(
        first,
        [this](const Predicates& percepts, Predicates& actions) {
          player_.think(percepts, actions);
          actions.open("syn").close();
        },
        [this](const std::string& why) { why_ = why; });
  }
  const SpherePlayer& player() const { return player_; }
  const std::string& why() const { return why_; }

 private:
  SpherePlayer player_;
  AgentConnection connection_;
  std::string why_;
};

std::vector<fs::path> pluginFolders() {
  const fs::path bin = fs::canonical("/proc/self/exe").parent_path();
  return {bin / ".." / "plugins", bin / SPARK_PLUGIN_FOLDER};
}

/// Plays until the server ends the match; true when every player was in a team.
bool play(const Options& options) {
  asio::io_context io(1);
  const auto language = spark::agent::makeLanguage(options.parser, pluginFolders());
  std::vector<std::unique_ptr<Participant>> team;
  for (int i = 1; i <= options.players; ++i)
    team.push_back(std::make_unique<Participant>(io, *language, options, options.reverse ? options.players + 1 - i : i));
  for (const auto& p : team) p->start();
  io.run();
  bool all = true;
  for (const auto& p : team) {
    if (!p->player().side().empty()) continue;
    fmt::print(stderr, "{} {} got no place in the match: {}\n", options.team, p->player().unum(), p->why());
    all = false;
  }
  const SpherePlayer& first = team.front()->player();
  if (!options.quiet)
    fmt::print(stderr, "{} ({}): {}:{} after {:.2f} s\n", options.team, first.side(), first.ownScore(), first.otherScore(), first.time());
  return all;
}
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"A team of spheres that plays 2004-style soccer against a server.", "sphere-team"};
  Options options;
  app.add_option("--host", options.host, "The server")->capture_default_str();
  app.add_option("--port", options.port, "Its agent port")->check(CLI::Range(1, 65535))->capture_default_str();
  app.add_option("--team", options.team, "Name of the team")->capture_default_str();
  app.add_option("--players", options.players, "Players, number 1 keeps the goal")->check(CLI::Range(1, 11))->capture_default_str();
  app.add_option("--parser", options.parser, "Class of the server's parser: SexpParser, JsonParser, or one of a plugin")
      ->capture_default_str();
  app.add_option("--robot", options.robot, "Scene file of the robot")->capture_default_str();
  app.add_option("--patience", options.patience, "Wait so long for a server [s]")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_flag("--reverse", options.reverse, "Connect the last player first");
  app.add_flag("--quiet", options.quiet, "Do not print the result");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    return play(options) ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "sphere-team: {}\n", e.what());
    return 1;
  }
}
