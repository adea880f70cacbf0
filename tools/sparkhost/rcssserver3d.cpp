#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "options.h"
#include "output.h"
#include "program.h"

// sparkhost with the command line of rcssserver3d and simspark. It runs in this process, so that scripts which kill it
// by name or process id end the server itself.

namespace {
/// The config that replaces a start-up script: a Lua file is used itself, Ruby scripts are recognised by name.
std::string configFor(const std::string& script) {
  const std::filesystem::path path(script);
  if (path.extension() == ".lua") return script;
  if (path.stem().string().find("spl") != std::string::npos) return "soccer-spl.lua";
  if (!script.empty())
    sparkhost::printError(fmt::format(
        "{} is a Ruby script, which is not run: soccer.lua stands for it. A Lua config may be named instead.\n",
        script));
  return "soccer.lua";
}

int runArguments(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& a : arguments) pointers.push_back(a.data());
  pointers.push_back(nullptr);
  return sparkhost::runProgram(static_cast<int>(arguments.size()), pointers.data());
}
}  // namespace

int sparkhost::runServer3d(int argc, char** argv) {
  const std::string name = std::filesystem::path(argv[0]).filename();
  CLI::App app{
      "Serves soccer of the 3D league: sparkhost with soccer.lua, under this name and with this server's options.",
      name};
  std::string script, prefix, drawHost;
  std::optional<int> agentPort, monitorPort;
  app.add_option("--agent-port", agentPort, "TCP port of agents (default 3100)")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  app.add_option("--server-port", monitorPort, "TCP port of monitors (default 3200)")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  app.add_option("--script-path", script, "Start-up script: a Lua config; Ruby scripts are not run")->type_name("FILE");
  app.add_option("--init-script-prefix", prefix, "Folder of Ruby scripts: ignored")->type_name("DIR");
  app.add_option("--rvdraw-host", drawHost, "Where the referee draws: ignored")->type_name("HOST");
  app.prefix_command();
  app.footer("Options of sparkhost may follow after a lone --, for example: " + name +
             " -- --sync --rate max --set Soccer.BeamNoiseXY=0");
  try {
    app.parse(argc, argv);
    const std::vector<std::string> rest = app.remaining();
    if (!rest.empty() && rest.front() != "--")
      throw CLI::ExtrasError(
          name, std::vector<std::string>{rest.front() + " (see --help; options of sparkhost go behind a lone --)"});
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : sparkhost::kUsageError;
  }
  std::vector<std::string> arguments{"sparkhost", "--config", configFor(script)};
  if (agentPort) arguments.insert(arguments.end(), {"--agent-port", std::to_string(*agentPort)});
  if (monitorPort) arguments.insert(arguments.end(), {"--monitor-port", std::to_string(*monitorPort)});
  const std::vector<std::string> rest = app.remaining();
  if (rest.size() > 1) arguments.insert(arguments.end(), rest.begin() + 1, rest.end());
  return runArguments(std::move(arguments));
}
