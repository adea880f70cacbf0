#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "control_connection.h"
#include "print.h"
#include "spark/printable.h"

// Exit codes: 0: done; 1: no simulation was found, it returned an error, or stdout cannot be written; 2: the command
// line is wrong.

using namespace sparkctl;

namespace {
/// A node, or a property or method of it.
struct Target {
  std::string path, member;
};

/// Splits `/sys/server/simulation.step` at the last dot after the last slash.
Target split(const std::string& text, bool needsMember) {
  const std::size_t slash = text.rfind('/');
  const std::size_t dot = text.rfind('.');
  if (dot != std::string::npos && (slash == std::string::npos || dot > slash) && dot + 1 < text.size())
    return {text.substr(0, dot), text.substr(dot + 1)};
  if (needsMember)
    throw std::runtime_error(fmt::format("expected PATH.NAME, such as /sys/server/simulation.step, found '{}'", text));
  return {text, ""};
}

/// The control sockets of running simulations, or of process `pid` if it is above 0.
std::vector<std::string> sockets(int pid, std::vector<std::string>& skipped) {
  skipped.clear();
  std::vector<std::string> all = findSockets(skipped);
  if (pid > 0)
    std::erase_if(all, [&](const std::string& s) { return s.find(fmt::format("/{}.sock", pid)) == std::string::npos; });
  return all;
}

/// The socket that the options select, for which it waits up to `patience` seconds; throws if there is not exactly one.
std::string chooseSocket(const std::string& socket, int pid, double patience) {
  if (!socket.empty()) return socket;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(patience);
  std::vector<std::string> skipped, all = sockets(pid, skipped);
  while (all.empty() && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    all = sockets(pid, skipped);
  }
  for (const std::string& why : skipped) fmt::print(stderr, "sparkctl: {}: skipped\n", why);
  if (all.empty())
    throw std::runtime_error(pid > 0 ? fmt::format("process {} has no simulation with a control socket", pid)
                                     : "no simulation with a control socket is running (plugin \"control\")");
  if (all.size() == 1) return all.front();
  throw std::runtime_error(
      fmt::format("several simulations are running; choose one with --socket:\n  {}", fmt::join(all, "\n  ")));
}

/// Names and values are of others: agents, teams, hosts that are mounted.
void print(const std::string& text) {
  if (std::fputs(spark::printable(text).c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw std::runtime_error(fmt::format("cannot write to stdout: {}", std::strerror(errno)));
}

void get(ControlConnection& simulation, const std::string& what) {
  const Target t = split(what, false);
  Json request{{"do", "get"}, {"path", t.path}};
  if (!t.member.empty()) request["property"] = t.member;
  const Json answer = simulation.ask(request);
  if (t.member.empty()) print(fmt::format("{}  ({})\n", answer.value("path", ""), answer.value("class", "")));
  for (const Json& p : answer["properties"]) print(propertyText(p));
}

void set(ControlConnection& simulation, const std::string& what, const std::string& value) {
  const Target t = split(what, true);
  const Json answer = simulation.ask({{"do", "set"}, {"path", t.path}, {"property", t.member}, {"value", value}});
  for (const Json& p : answer["properties"]) print(propertyText(p));
}

void call(ControlConnection& simulation, const std::string& what, const std::vector<std::string>& arguments) {
  const Target t = split(what, true);
  const std::string result =
      simulation.ask({{"do", "call"}, {"path", t.path}, {"method", t.member}, {"arguments", arguments}})
          .value("text", "");
  if (!result.empty()) print(result + "\n");
}

/// Hides the minus of numbers from the parser, which takes -.5 and -inf for options.
constexpr char kMinus = '\1';

std::vector<std::string> withHiddenMinus(int argc, char** argv) {
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; --i) {  // the parser takes them from the back
    std::string& word = words.emplace_back(argv[i]);
    if (word.size() < 2 || word[0] != '-') continue;
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (*end == 0) word[0] = kMinus;
  }
  return words;
}

void showMinus(std::string& word) {
  if (!word.empty() && word[0] == kMinus) word[0] = '-';
}

constexpr std::size_t kLongestScript = 30'000;  // bytes: a request has at most twice as many, with its escapes

/// The text of a script of the caller, which may come through a pipe; `-`: standard input. Of one that is too long only
/// the beginning is read.
std::string readScript(const std::string& file) {
  std::error_code ec;
  if (std::filesystem::is_directory(file, ec)) throw std::runtime_error(fmt::format("{} is a folder", file));
  std::ifstream in;
  if (file != "-") in.open(file, std::ios::binary);
  if (file != "-" && !in) throw std::runtime_error(fmt::format("cannot read {}: {}", file, std::strerror(errno)));
  std::istream& from = file == "-" ? std::cin : in;
  std::string text(kLongestScript + 1, '\0');
  from.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (from.bad()) throw std::runtime_error(fmt::format("cannot read {}: {}", file, std::strerror(errno)));
  text.resize(static_cast<std::size_t>(from.gcount()));
  return text;
}

/// Throws std::runtime_error if the script cannot be sent.
void checkScript(const std::string& text, const std::string& name) {
  if (text.empty()) throw std::runtime_error(fmt::format("expected a script, but {} is empty", name));
  if (text.size() > kLongestScript)
    throw std::runtime_error(
        fmt::format("expected a script of at most {} bytes, but {} has more", kLongestScript, name));
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (!isUtf8(line)) throw std::runtime_error(fmt::format("{}:{}: expected UTF-8", name, number));
}

void attach(ControlConnection& simulation, const std::string& path, const std::string& text, const std::string& name) {
  checkScript(text, name);
  const std::string result = simulation
                                 .ask({{"do", "attach"},
                                       {"path", path},
                                       {"text", text},
                                       {"name", std::filesystem::path(name).filename().string()}})
                                 .value("text", "");
  if (!result.empty()) print(result + "\n");
}

void ask(ControlConnection& simulation, const std::string& what, const std::string& path) {
  Json request{{"do", what}};
  if (!path.empty()) request["path"] = path;
  print(answerText(simulation.ask(request)));
}

void watch(ControlConnection& simulation, const std::string& what) {
  const Target t = split(what, true);
  for (Json line = simulation.ask({{"do", "watch"}, {"path", t.path}, {"property", t.member}});;
       line = simulation.next())
    print(fmt::format("{:10.2f} s  {} {}\n", line.value("time", 0.0), line.value("text", ""), line.value("unit", "")));
}
}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): options that are set up wrongly end the program
int main(int argc, char** argv) {
  CLI::App app{"Inspects and controls a running Spark simulation: its tree, properties, plugins.", "sparkctl"};
  std::string socket, path = "/", target, value;
  std::vector<std::string> arguments;
  int pid = 0, depth = -1;
  double timeout = 10, patience = 0;
  bool all = false, links = false, force = false;
  app.add_option("--socket", socket, "Path of the control socket, if several simulations run");
  app.add_option("--pid", pid, "Process of the simulation, if several run");
  app.add_option("--timeout", timeout, "Maximum time to wait for an answer [s]")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  app.add_option("--wait", patience, "Maximum time to wait for a simulation to start [s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.require_subcommand(1);
  CLI::App* tree = app.add_subcommand("tree", "The tree below a path, with classes and their purpose");
  tree->add_option("PATH", path, "Where to begin")->capture_default_str();
  tree->add_option("--depth", depth, "Levels to show");
  tree->add_flag("--all", all, "Show all siblings of one class, even if there are many");
  tree->add_flag("--links", links, "Also the links of each node, with their targets");
  CLI::App* gets = app.add_subcommand("get", "A property, or all properties of a node, with units and documentation");
  gets->add_option("PATH.PROPERTY", target)->required();
  CLI::App* sets = app.add_subcommand("set", "Sets a property between two cycles");
  sets->add_option("PATH.PROPERTY", target)->required();
  sets->add_option("VALUE", value, "true, 3, 0.5, {1,2,3}, words")->required();
  CLI::App* calls = app.add_subcommand("call", "Calls a method between two cycles");
  calls->add_option("PATH.METHOD", target)->required();
  calls->add_option("ARGUMENTS", arguments);
  CLI::App* makes = app.add_subcommand("make", "Makes a node");
  makes->add_option("CLASS", target)->required();
  makes->add_option("PATH", value, "Of the new node; missing parents are made, too")->required();
  CLI::App* attaches = app.add_subcommand("attach", "Runs a script at a node, whose handlers stay there");
  attaches->add_option("PATH", target, "The node, in the script: self")->required();
  attaches->add_option("FILE", value, "A script of yours; -: standard input")->required();
  CLI::App* runs = app.add_subcommand("run", "Runs a script that is given as text, and prints what it returns");
  runs->add_option("TEXT", value)->required();
  runs->add_option("--at", path, "The node at which it runs")->capture_default_str();
  CLI::App* watches = app.add_subcommand("watch", "Prints a property now and whenever it changes");
  watches->add_option("PATH.PROPERTY", target)->required();
  CLI::App* asks = app.add_subcommand(
      "ask", "Requests contacts, joints PATH, percepts PATH or others that plugins answer; prints JSON");
  asks->add_option("REQUEST", target)->required();
  asks->add_option("PATH", value, "A node; for an agent any node of it");
  CLI::App* plugins = app.add_subcommand("plugins", "All plugins that were found");
  CLI::App* loads = app.add_subcommand(
      "load", "Loads a plugin from the host's folders, as the line plugin \"NAME\" of a config does");
  loads->add_option("NAME", target)->required();
  CLI::App* unloads =
      app.add_subcommand("unload", "Unloads a plugin that has no objects; a later load reads the file again");
  unloads->add_option("NAME", target)->required();
  CLI::App* snapshots =
      app.add_subcommand("snapshot", "Writes the whole simulation to a file, from which sparkhost --from FILE goes on");
  snapshots->add_option("FILE", target)->required();
  snapshots->add_flag("--force", force, "Replace the file if it exists");
  try {
    app.parse(withHiddenMinus(argc, argv));
    showMinus(value);
    for (std::string& argument : arguments) showMinus(argument);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    ControlConnection simulation(chooseSocket(socket, pid, patience), std::max(timeout, patience));
    if (*tree)
      print(treeText(simulation.ask({{"do", "tree"}, {"path", path}, {"depth", depth}, {"links", links}})["tree"], path,
                     all));
    if (*gets) get(simulation, target);
    if (*sets) set(simulation, target, value);
    if (*calls) call(simulation, target, arguments);
    if (*makes) print(simulation.ask({{"do", "make"}, {"class", target}, {"path", value}}).value("text", "") + "\n");
    if (*attaches) attach(simulation, target, readScript(value), value == "-" ? "stdin" : value);
    if (*runs) attach(simulation, path, value, "sparkctl run");
    if (*asks) ask(simulation, target, value);
    if (*watches) watch(simulation, target);
    if (*loads) print(simulation.ask({{"do", "load"}, {"name", target}}).value("text", "") + "\n");
    if (*unloads) simulation.ask({{"do", "unload"}, {"name", target}});
    if (*snapshots)
      call(simulation, "/sys/host/snapshots.save",
           {std::filesystem::absolute(target).lexically_normal().string(), force ? "true" : "false"});
    if (*plugins) print(pluginsText(simulation.ask({{"do", "plugins"}})["plugins"]));
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkctl: {}\n", spark::printable(e.what()));
    return 1;
  }
  return 0;
}
