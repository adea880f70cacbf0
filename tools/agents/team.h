#pragma once
/// \file
/// A team in one process: command line, connections, and the loop that runs until the server ends the match.

#include <functional>
#include <memory>
#include <string>

#include "agent_connection.h"
#include "spark/predicates.h"

namespace CLI {
class App;
}
namespace boost::asio {
class io_context;
}

namespace spark::agent {

/// One player of a team. Turns percepts into actions.
class Player {
 public:
  virtual ~Player() = default;
  /// Appends the first message. Called once, after the connection is made.
  virtual void start(Predicates& actions) = 0;
  /// Appends the answer to a sense message; the caller adds (syn). `percepts` are empty unless listens().
  virtual void think(const Predicates& percepts, Predicates& actions) = 0;
  /// False: messages of the server need not be parsed.
  virtual bool listens() const { return true; }
  /// True once the player has a team.
  virtual bool placed() const = 0;
  /// Team and number, for error messages.
  virtual std::string name() const = 0;
  /// The result of the match in one line. Printed for the first player of a team.
  virtual std::string result() const = 0;
};

/// A program that plays with a team. Exit codes: 0 the server ended the match; 1 it could not be reached, or a player
/// got no team; 2 the command line is wrong.
class TeamProgram {
 public:
  /// The command line options of all teams.
  struct Options {
    std::string host = "127.0.0.1", socket, team = "Spark", parser = "SexpParser";
    Framing framing = Framing::length;
    int port = 3100, players = 11, number = 0;  ///< number 0: all players, else this one alone
    double patience = 10;
    bool reverse = false, quiet = false;
  };
  /// `most`: maximum number of players.
  TeamProgram(std::string name, const std::string& description, int most = 11);
  ~TeamProgram();
  /// Adds an option. `value` is the default and receives the value; it must outlive run().
  void addText(const std::string& option, std::string& value, const std::string& description);
  /// Adds an integer option with range [least, most]. `value` may be outside: it then means that the option is not
  /// given.
  void addNumber(const std::string& option, int& value, int least, int most, const std::string& description);
  /// The options; defaults before run().
  const Options& options() const { return options_; }
  /// The event loop of the match, for further I/O of a program.
  boost::asio::io_context& io() { return *io_; }
  /// Parses the command line and plays. `make` creates a player by its number, from 1. Returns the exit code.
  int run(int argc, char** argv, const std::function<std::unique_ptr<Player>(int unum)>& make);

 private:
  bool play(const std::function<std::unique_ptr<Player>(int unum)>& make);
  std::unique_ptr<boost::asio::io_context> io_;
  std::string name_;
  std::unique_ptr<CLI::App> app_;
  Options options_;
};

}  // namespace spark::agent
