#pragma once
/// \file
/// A team in one process: options, connections, and the loop in which its players play until the server ends the match.

#include <functional>
#include <memory>
#include <string>

#include "spark/predicates.h"

namespace CLI {
class App;
}
namespace boost::asio {
class io_context;
}

namespace spark::agent {

/// One player of a team: percepts in, actions out.
class Player {
 public:
  virtual ~Player() = default;
  /// The first message, to be sent once when connected.
  virtual void start(Predicates& actions) = 0;
  /// Appends the answer to a sense message; (syn) is added to it. `percepts` are empty for a player that does not
  /// listen.
  virtual void think(const Predicates& percepts, Predicates& actions) = 0;
  /// False: what the server says need not be read.
  virtual bool listens() const { return true; }
  /// The server has told him his side.
  virtual bool placed() const = 0;
  virtual std::string name() const = 0;
  /// How it went, in one line, for the first player of a team.
  virtual std::string result() const = 0;
};

/// A program that plays with a team. Exit codes: 0 the server closed the match; 1 it could not be reached or a player
/// was turned away before he had a team; 2 the command line is wrong.
class TeamProgram {
 public:
  /// What all teams have on their command line.
  struct Options {
    std::string host = "127.0.0.1", team = "Spark", parser = "SexpParser";
    int port = 3100, players = 11;
    double patience = 10;
    bool reverse = false, quiet = false;
  };
  /// `most`: players that one process can have.
  TeamProgram(std::string name, const std::string& description, int most = 11);
  ~TeamProgram();
  /// Options of its own; `value` is the default and takes what the command line says.
  void addText(const std::string& option, std::string& value, const std::string& description);
  /// A whole number in [least, most]; `value` as it is when the option is not there.
  void addNumber(const std::string& option, int& value, int least, int most, const std::string& description);
  const Options& options() const { return options_; }
  /// The loop that the match runs in, for what else a program does.
  boost::asio::io_context& io() { return *io_; }
  /// Reads the command line and plays; `make` makes a player by his number, from 1. Returns the exit code.
  int run(int argc, char** argv, const std::function<std::unique_ptr<Player>(int unum)>& make);

 private:
  bool play(const std::function<std::unique_ptr<Player>(int unum)>& make);
  std::unique_ptr<boost::asio::io_context> io_;
  std::string name_;
  std::unique_ptr<CLI::App> app_;
  Options options_;
};

}  // namespace spark::agent
