#pragma once
/// \file
/// Shared by tests of recordings: a match that is recorded, and its simulation again.

#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "../../plugins/recorder/input_codec.h"
#include "client.h"
#include "mcap.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace spark::test {

using Json = nlohmann::json;

/// Waits until a host has simulated at least `cycle` cycles.
inline void waitForCycle(const Process& host, std::int64_t cycle) {
  for (std::int64_t now = 0; now < cycle;) {
    const Finished f = runToEnd(joined(sparkctl(host.pid()), {"get", "/sys/server/simulation.cycle"}));
    REQUIRE(f.code == 0);
    now = std::stoll(f.out.substr(f.out.find("= ") + 2));
  }
}

/// A host that records, with two teams.
struct Recorded {
  TemporaryFolder folder;
  std::string file = folder.path() / "match.mcap";
  std::unique_ptr<Process> host, red, blue;
  Json ports;

  Recorded(const std::string& config, const std::string& team, int players, const std::vector<std::string>& arguments) {
    host = std::make_unique<Process>(joined(
        {program("sparkhost"), "--config", config, "--seed", "7", "--expect", std::to_string(2 * players),
         "--agent-port", "0", "--monitor-port", "0", "--web-port", "0", "--log-level", "error", "--record", file},
        arguments));
    ports = Json::parse(host->line());
    for (const auto& [name, process] : {std::pair{"Red", &red}, std::pair{"Blue", &blue}})
      *process = std::make_unique<Process>(std::vector<std::string>{
          program(team), "--team", name, "--port", ports["agentPort"].dump(), "--players", std::to_string(players)});
  }
  void until(std::int64_t cycle) { waitForCycle(*host, cycle); }
  Json end() {
    Json result = Json::parse(host->line());
    REQUIRE(host->wait() == 0);
    return result;
  }
};

/// The texts of a recording, its inputs decoded: what a reader of the file learns. (Its bytes are compressed.)
inline std::string textsOf(const std::string& file) {
  mcap::Reader from(file);
  recorder::InputReader reader;
  std::string out;
  for (const auto& [key, value] : from.metadataOf("spark")) out += key + " = " + value + "\n";
  for (const auto& a : from.attachments()) out += from.read(a) + "\n";
  for (const auto& chunk : from.chunks())
    from.forEach(chunk, [&](const mcap::Message& m) {
      std::vector<recorder::OwnInput> inputs;
      if (from.channels().at(m.channel).topic == recorder::kInputs)
        reader.read(m.data, inputs);
      else
        out += std::string(m.data) + "\n";
      for (const recorder::OwnInput& i : inputs) out += i.place + " " + i.text + "\n";
      return true;
    });
  return out;
}

/// The texts of a recording in which sparkctl sends a request with a word: to a method that takes a secret, or to one
/// that does not.
inline std::string textsWith(const std::string& word, bool secret) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Process host({program("sparkhost"), "--config",
                folder.write("run.lua",
                             "include 'house.lua'\nfiles() scene() simulation() control()\nplugin 'remote'\n"
                             "new('RemoteServer', '/usr/remote')\nnew('Variables', '/usr/words')\n"),
                "--record", file});
  host.line();
  const std::vector<std::string> request =
      secret ? std::vector<std::string>{"call", "/usr/remote.listen", "127.0.0.1:0", word}
             : std::vector<std::string>{"call", "/usr/words.set", "word", word};
  const Finished done = runToEnd(joined(sparkctl(host.pid()), request));
  INFO(done.errors);
  REQUIRE(done.code == 0);
  host.signal(15);
  host.line();
  REQUIRE(host.wait() == 0);
  return textsOf(file);
}

/// The line and the exit code of sparkreplay --verify.
inline std::pair<Json, int> verify(const std::string& file) {
  const Finished f = runToEnd({program("sparkreplay"), file, "--verify"});
  INFO(f.errors);
  REQUIRE(!f.out.empty());
  return {Json::parse(f.out), f.code};
}

inline const std::vector<std::string> kLockstep{"--sync", "--rate", "max"};

}  // namespace spark::test
