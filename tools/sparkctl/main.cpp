#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "house.h"
#include "print.h"

// Exit codes: 0 done; 1 the house refused, there is none, or its answer cannot be written; 2 the command line is wrong.

using namespace sparkctl;

namespace {
/// What the command line names: a node, or a property or method of it.
struct Target {
  std::string path, member;
};

/// `/sys/server/simulation.step`: what follows the last dot behind the last slash is the member.
Target split(const std::string& text, bool memberNeeded) {
  const std::size_t slash = text.rfind('/');
  const std::size_t dot = text.rfind('.');
  if (dot != std::string::npos && (slash == std::string::npos || dot > slash) && dot + 1 < text.size())
    return {text.substr(0, dot), text.substr(dot + 1)};
  if (memberNeeded)
    throw std::runtime_error("expected PATH.NAME, such as /sys/server/simulation.step, found '" + text + "'");
  return {text, ""};
}

/// The one house that is meant; throws when it is unclear.
std::string choose(const std::string& socket, int pid) {
  if (!socket.empty()) return socket;
  std::vector<std::string> refused;
  std::vector<std::string> all = houses(refused);
  for (const std::string& why : refused) fmt::print(stderr, "sparkctl: {}: it is not looked into\n", why);
  if (pid > 0)
    std::erase_if(all, [&](const std::string& s) { return s.find(fmt::format("/{}.sock", pid)) == std::string::npos; });
  if (all.empty())
    throw std::runtime_error(pid > 0 ? fmt::format("process {} has no house with a control socket", pid)
                                     : "no house is running that has a control socket (plugin \"control\")");
  if (all.size() == 1) return all.front();
  throw std::runtime_error(
      fmt::format("several houses are running; say which with --socket:\n  {}", fmt::join(all, "\n  ")));
}

void print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw std::runtime_error(fmt::format("cannot write to stdout: {}", std::strerror(errno)));
}

void get(House& house, const std::string& what) {
  const Target t = split(what, false);
  Json request{{"do", "get"}, {"path", t.path}};
  if (!t.member.empty()) request["property"] = t.member;
  const Json answer = house.ask(request);
  if (t.member.empty()) print(fmt::format("{}  ({})\n", answer.value("path", ""), answer.value("class", "")));
  for (const Json& p : answer["properties"]) print(propertyText(p));
}

void set(House& house, const std::string& what, const std::string& value) {
  const Target t = split(what, true);
  for (const Json& p :
       house.ask({{"do", "set"}, {"path", t.path}, {"property", t.member}, {"value", value}})["properties"])
    print(propertyText(p));
}

void call(House& house, const std::string& what, const std::vector<std::string>& arguments) {
  const Target t = split(what, true);
  const std::string result =
      house.ask({{"do", "call"}, {"path", t.path}, {"method", t.member}, {"arguments", arguments}}).value("text", "");
  if (!result.empty()) print(result + "\n");
}

void ask(House& house, const std::string& what, const std::string& path) {
  Json request{{"do", what}};
  if (!path.empty()) request["path"] = path;
  print(answerText(house.ask(request)));
}

void watch(House& house, const std::string& what) {
  const Target t = split(what, true);
  for (Json line = house.ask({{"do", "watch"}, {"path", t.path}, {"property", t.member}});; line = house.next())
    print(fmt::format("{:10.2f} s  {} {}\n", line.value("time", 0.0), line.value("text", ""), line.value("unit", "")));
}
}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Looks into a running Spark house: its tree, properties, plugins.", "sparkctl"};
  std::string socket, path = "/", target, value;
  std::vector<std::string> arguments;
  int pid = 0, depth = -1;
  double timeout = 10;
  bool all = false, links = false;
  app.add_option("--socket", socket, "The house's control socket, where several run");
  app.add_option("--pid", pid, "The house's process, where several run");
  app.add_option("--timeout", timeout, "How long to wait for each answer [s]")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  app.require_subcommand(1);
  CLI::App* tree = app.add_subcommand("tree", "The tree below a path, with classes and what they are for");
  tree->add_option("PATH", path, "Where to begin")->capture_default_str();
  tree->add_option("--depth", depth, "Levels to show");
  tree->add_flag("--all", all, "Show every one of many brothers of one class");
  tree->add_flag("--links", links, "Also what each node looks up, and where that is");
  CLI::App* gets = app.add_subcommand("get", "A property, or all properties of a node, with units and documentation");
  gets->add_option("PATH.PROPERTY", target)->required();
  CLI::App* sets = app.add_subcommand("set", "Sets a property between two cycles");
  sets->add_option("PATH.PROPERTY", target)->required();
  sets->add_option("VALUE", value, "true, 3, 0.5, {1,2,3}, words")->required();
  CLI::App* calls = app.add_subcommand("call", "Calls a method between two cycles");
  calls->add_option("PATH.METHOD", target)->required();
  calls->add_option("ARGUMENTS", arguments);
  CLI::App* watches = app.add_subcommand("watch", "Prints a property now and whenever it changes");
  watches->add_option("PATH.PROPERTY", target)->required();
  CLI::App* asks = app.add_subcommand(
      "ask", "Asks for contacts, joints PATH, percepts PATH or what else a plugin answers; prints JSON");
  asks->add_option("REQUEST", target)->required();
  asks->add_option("PATH", value, "A node; of an agent: any of its own");
  CLI::App* plugins = app.add_subcommand("plugins", "The plugins that were found");
  CLI::App* loads =
      app.add_subcommand("load", "Loads a plugin of the host's folders, as a config's line plugin \"NAME\" does");
  loads->add_option("NAME", target)->required();
  CLI::App* unloads =
      app.add_subcommand("unload", "Unloads a plugin that has no objects; load then takes the file as it is by then");
  unloads->add_option("NAME", target)->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    House house(choose(socket, pid), timeout);
    if (*tree)
      print(
          treeText(house.ask({{"do", "tree"}, {"path", path}, {"depth", depth}, {"links", links}})["tree"], path, all));
    if (*gets) get(house, target);
    if (*sets) set(house, target, value);
    if (*calls) call(house, target, arguments);
    if (*asks) ask(house, target, value);
    if (*watches) watch(house, target);
    if (*loads) print(house.ask({{"do", "load"}, {"name", target}}).value("text", "") + "\n");
    if (*unloads) house.ask({{"do", "unload"}, {"name", target}});
    if (*plugins) print(pluginsText(house.ask({{"do", "plugins"}})["plugins"]));
  } catch (const std::exception& e) {
    fmt::print(stderr, "sparkctl: {}\n", e.what());
    return 1;
  }
  return 0;
}
