#include "team.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <map>
#include <vector>

#include "agent_connection.h"

namespace spark::agent {

namespace {
namespace asio = boost::asio;
namespace fs = std::filesystem;

/// A player and its connection.
class Participant {
 public:
  Participant(asio::io_context& io, Language& language, std::unique_ptr<Player> player,
              const TeamProgram::Options& options)
      : player_(std::move(player)), connection_(io, language, options.framing) {
    connection_.setListens(player_->listens());
    if (options.socket.empty())
      connection_.connect(options.host, options.port, options.patience);
    else
      connection_.connectTo(options.socket, options.patience);
  }
  void start() {
    Predicates first;
    player_->start(first);
    connection_.start(
        first,
        [this](const Predicates& percepts, Predicates& actions) {
          player_->think(percepts, actions);
          actions.open("syn").close();
        },
        [this](const std::string& why) { why_ = why; });
  }
  const Player& player() const { return *player_; }
  const std::string& why() const { return why_; }

 private:
  std::unique_ptr<Player> player_;
  AgentConnection connection_;
  std::string why_;
};

std::vector<fs::path> pluginFolders() {
  const fs::path bin = fs::canonical("/proc/self/exe").parent_path();
  return {bin / ".." / "plugins", bin / SPARK_PLUGIN_FOLDER};
}
}  // namespace

TeamProgram::TeamProgram(std::string name, const std::string& description, int most)
    : io_(std::make_unique<asio::io_context>(1)),
      name_(std::move(name)),
      app_(std::make_unique<CLI::App>(description, name_)) {
  options_.players = most;
  app_->add_option("--host", options_.host, "The server")->capture_default_str();
  app_->add_option("--port", options_.port, "Its agent port")->check(CLI::Range(1, 65535))->capture_default_str();
  app_->add_option("--socket", options_.socket, "Its Unix socket, in place of host and port");
  app_->add_option("--framing", options_.framing, "How it separates messages")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Framing>{{"length", Framing::length}, {"line", Framing::line}}));
  app_->add_option("--team", options_.team, "Name of the team")->capture_default_str();
  auto* const players = app_->add_option("--players", options_.players, "Players; number 1 keeps the goal")
                            ->check(CLI::Range(1, most))
                            ->capture_default_str();
  app_->add_option("--number", options_.number, "Play with the player of this number alone")
      ->check(CLI::Range(1, most))
      ->excludes(players);
  app_->add_option("--parser", options_.parser,
                   "Class of the server's parser: SexpParser, JsonParser, or one of a plugin")
      ->capture_default_str();
  app_->add_option("--patience", options_.patience, "Wait so long for a server [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app_->add_flag("--reverse", options_.reverse, "Connect the last player first");
  app_->add_flag("--quiet", options_.quiet, "Do not print the result");
}

TeamProgram::~TeamProgram() = default;

void TeamProgram::addText(const std::string& option, std::string& value, const std::string& description) {
  app_->add_option(option, value, description)->capture_default_str();
}

void TeamProgram::addNumber(const std::string& option, int& value, int least, int most,
                            const std::string& description) {
  auto* const added = app_->add_option(option, value, description)->check(CLI::Range(least, most));
  if (value >= least) added->capture_default_str();
}

int TeamProgram::run(int argc, char** argv, const std::function<std::unique_ptr<Player>(int unum)>& make) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app_->exit(e) == 0 ? 0 : 2;
  }
  try {
    return play(make) ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", name_, e.what());
    return 1;
  }
}

/// Plays until the server ends the match. True when every player got a team.
bool TeamProgram::play(const std::function<std::unique_ptr<Player>(int unum)>& make) {
  const auto language = makeLanguage(options_.parser, pluginFolders());
  std::vector<std::unique_ptr<Participant>> team;
  const int first = std::max(options_.number, 1), last = options_.number > 0 ? options_.number : options_.players;
  for (int i = first; i <= last; ++i)
    team.push_back(
        std::make_unique<Participant>(*io_, *language, make(options_.reverse ? last + first - i : i), options_));
  for (const auto& p : team) p->start();
  io_->run();
  bool all = true;
  for (const auto& p : team) {
    if (p->player().placed()) continue;
    fmt::print(stderr, "{} got no place in the match: {}\n", p->player().name(), p->why());
    all = false;
  }
  if (!options_.quiet) fmt::print(stderr, "{}\n", team.front()->player().result());
  return all;
}

}  // namespace spark::agent
