/// sparkcomm runs agents on this machine for a simulator on another one.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>

#include "comm_server.h"
#include "spark/output_file.h"

namespace {
spark::spades::CommServer* running = nullptr;

std::string nameOfMachine() {
  std::array<char, 256> name = {};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unnamed";
}
}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): options that are set up wrongly end the program
int main(int argc, char** argv) {
  spark::spades::CommServer::Options options;
  options.name = nameOfMachine();
  CLI::App app("A communication server: runs agents on this machine for sparkhost on another one", "sparkcomm");
  app.add_option("--host", options.host, "The simulator's machine")->capture_default_str();
  app.add_option("--port", options.port, "Its port for communication servers")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  app.add_option("--database", options.database, "The agent database: which programs are agents")->required();
  app.add_option("--logs", options.logs, "Folder for what agents print; it is dropped without");
  bool force = false;
  app.add_flag("--force", force, "Replace files of --logs that exist");
  app.add_option("--token", options.token, "What the simulator wants to hear");
  app.add_option("--name", options.name, "How the simulator names this server")->capture_default_str();
  app.add_option("--most", options.most, "Most agents that it runs at a time")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--patience", options.patience, "How long the simulator may be away [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.footer(
      "Exit code 0: the simulation is over; 1: the simulator refused or was away; 2: the command line is wrong.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  spark::outputs::setReplace(force);
  try {
    spark::spades::CommServer server(options);
    running = &server;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { running->stop(); });
    return server.run() ? 0 : 1;
  } catch (const std::exception& e) {
    std::fputs(fmt::format("sparkcomm: {}\n", e.what()).c_str(), stderr);
    return 1;
  }
}
