#include "options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "common_options.h"

namespace sparkhost {

namespace {
/// Splits `K=V`. Throws CLI::ValidationError.
std::pair<std::string, spark::Value> splitOverride(const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == 0 || at == std::string::npos)
    throw CLI::ValidationError("--set", fmt::format("expected KEY=VALUE, found '{}'", text));
  return {text.substr(0, at), spark::Value::typed(std::string_view(text).substr(at + 1))};
}

/// Options that a run which goes on from a file does not take from it, each with one value.
constexpr std::string_view kOfOneRun[] = {"--record", "--from", "--at", "--hashes", "--hash-every", "--log-level"};

/// The words that build the same simulation, whose folders are absolute.
std::vector<std::string> lasting(int argc, char** argv) {
  std::vector<std::string> out;
  const auto absolute = [](std::string_view folder) {
    return std::filesystem::absolute(folder).lexically_normal().string();
  };
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i], name = word.substr(0, word.find('='));
    if (std::find(std::begin(kOfOneRun), std::end(kOfOneRun), name) != std::end(kOfOneRun)) {
      i += name == word;
    } else if (name == "--plugin-path" || name == "--scene-path") {
      const bool apart = name == word;
      out.emplace_back(name);
      if (apart && ++i >= argc) break;
      out.push_back(absolute(apart ? std::string_view(argv[i]) : word.substr(name.size() + 1)));
    } else if (word != "--histogram" && word != "--force") {
      out.emplace_back(word);
    }
  }
  return out;
}
}  // namespace

std::vector<std::string> withoutSecrets(std::vector<std::string> words, const std::vector<std::string>& secrets) {
  constexpr std::string_view kSet = "--set";
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool apart = words[i] == kSet && i + 1 < words.size();
    if (!apart && !words[i].starts_with("--set=")) continue;
    std::string& word = words[apart ? ++i : i];
    const std::size_t key = apart ? 0 : kSet.size() + 1, end = word.find('=', key);
    if (end != std::string::npos && std::count(secrets.begin(), secrets.end(), word.substr(key, end - key)) > 0)
      word.resize(end + 1);
  }
  return words;
}

std::optional<int> readOptions(int argc, char** argv, Options& out, std::string* problem) {
  CLI::App app{"Runs a Spark config: a Lua file that creates and connects nodes of plugins.", "sparkhost"};
  std::vector<std::string> sets;
  std::optional<std::string> rate;
  std::optional<double> duration;
  std::optional<int> expect, agentPort, monitorPort, webPort;
  bool sync = false;
  // A run that goes on adds to the command line of the first one.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_version_flag("--version", "sparkhost " SPARK_VERSION);
  app.add_option("--config", out.config, "Lua config, looked up in the working folder, then in the installed share")
      ->type_name("FILE");
  app.add_option("--set", sets, "Overrides an option of the config, a variable GROUP.NAME or /path.property")
      ->type_name("K=V")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  app.add_option("--seed", out.seed, "Seed of all random streams (default 1); with --from: from there on")
      ->type_name("N")
      ->check(checkSeed);
  app.add_option("--rate", rate, "real: paced to wall time (default); max: as fast as it goes")
      ->check(CLI::IsMember({"real", "max"}));
  app.add_flag("--sync", sync, "Lockstep: a cycle starts when every agent has answered with (syn)");
  app.add_option("--expect", expect, "Hold the clock until N agents have named robot and team")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--duration", duration,
                 "End at this simulated time [s], counted from the start also with --from; 0: never")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--agent-port", agentPort, "TCP port of agents (default 3100); 0 picks a free one")
      ->type_name("P")
      ->check(CLI::Range(0, 65535));
  app.add_option("--monitor-port", monitorPort, "TCP port of monitors (default 3200); 0 picks a free one")
      ->type_name("P")
      ->check(CLI::Range(0, 65535));
  app.add_option("--web-port", webPort, "TCP port of the page for browsers (default 3280); 0 picks a free one")
      ->type_name("P")
      ->check(CLI::Range(0, 65535));
  addCommonOptions(app, out.pluginPaths, out.scenePaths, out.logLevel, "Minimum level of log lines on stderr",
                   !problem);
  addForce(app, out.force);
  app.add_flag(
      "--check", out.check,
      "Run the config and import scenes, but no cycle; exit code 0, or 2 after errors, including those of scenes "
      "that a run only logs; warns of handlers of scripts that keep what is not saved");
  auto* hashes =
      app.add_option("--hashes", out.hashes, "Write hashes of state and configuration to a file, a line for a cycle")
          ->type_name("FILE")
          ->excludes("--check");
  app.add_option("--hash-every", out.hashEvery, "With --hashes: only every N-th cycle (default 1)")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->needs(hashes);
  app.add_option("--record", out.record, "Record the run to an MCAP file, which sparkreplay simulates again")
      ->type_name("FILE")
      ->excludes("--check");
  auto* from = app.add_option("--from", out.from,
                              "Go on from a snapshot (sparkctl snapshot), or from the last state of a recording, with "
                              "its config and files; other options add to its command line")
                   ->type_name("FILE")
                   ->check(CLI::ExistingFile)
                   ->excludes("--config");
  app.add_option(
         "--at", out.at,
         "With --from a recording: go on from this simulated time [s], which is simulated from the last state before")
      ->type_name("SECONDS")
      ->needs(from);
  app.add_option("--convert", out.convert,
                 "Write a scene file of any language as one of Spark's own, (RSG 0 2), and end; --config: one "
                 "that builds what the file needs, such as variables (default convert.lua)")
      ->type_name("IN OUT.rsg")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
      ->expected(2)
      ->excludes("--check")
      ->excludes(from);
  app.add_flag("--histogram", out.histogram, "Print a table of the delay and duration of cycles to stderr at the end");
  app.add_flag("--list-plugins", out.listPlugins, "Print the plugins that were found, and end")->excludes("--config");
  app.add_option("--describe", out.describe, "Print the description of a class, and end")
      ->type_name("CLASS")
      ->excludes("--config");
  app.footer(
      "stdout: a first JSON line with the ports and the page for browsers, a last one with the result; all else is "
      "on stderr.\n"
      "Exit code 0: done; 1: it failed on the way, or a line could not be written to stdout; 2: the command line, "
      "the config or what --check looks at is wrong.\n"
      "SIGINT, SIGTERM and SIGHUP end a run with its result, a second one ends it at once.");
  try {
    app.parse(argc, argv);
    for (const std::string& s : sets) out.overrides.push_back(splitOverride(s));
    if (!out.convert.empty() && out.config.empty()) out.config = "convert.lua";
    if (out.config.empty() && out.from.empty() && !out.listPlugins && out.describe.empty())
      throw CLI::RequiredError("--config");
  } catch (const CLI::ParseError& e) {
    if (problem) return *problem = e.what(), kUsageError;
    return app.exit(e) == 0 ? 0 : kUsageError;
  }
  const auto put = [&](const char* flag, const char* path, const char* property, spark::Value v, const char* missing) {
    const std::string text = std::string(flag) + (v.isBool() ? "" : " " + v.plain());
    out.switches.push_back({text, path, property, std::move(v), missing});
  };
  constexpr const char *kLoop = "run loop: add simulation() of house.lua",
                       *kAgents = "agents and no port for them: add agents{} of house.lua";
  if (rate) put("--rate", "/sys/server/simulation", "rate", *rate, kLoop);
  if (sync) put("--sync", "/sys/server/simulation", "sync", true, kLoop);
  if (duration) put("--duration", "/sys/server/simulation", "duration", *duration, kLoop);
  if (expect) put("--expect", "/sys/server/gamecontrol", "expect", *expect, kAgents);
  if (agentPort) put("--agent-port", "/sys/server/net/agents", "port", *agentPort, kAgents);
  if (monitorPort)
    put("--monitor-port", "/sys/server/net/monitors", "port", *monitorPort,
        "port for monitors: add monitors{} of house.lua");
  if (webPort)
    put("--web-port", "/sys/server/web", "port", *webPort,
        "page for browsers: add web() of house.lua, and no --set web=false");
  out.arguments = lasting(argc, argv);
  makeAbsolute(out.pluginPaths);
  makeAbsolute(out.scenePaths);
  if (!out.from.empty()) {
    // Messages name them as others do.
    for (std::string* file : {&out.from, &out.record, &out.hashes})
      if (!file->empty()) *file = std::filesystem::absolute(*file).string();
  }
  return std::nullopt;
}

}  // namespace sparkhost
