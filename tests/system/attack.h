#pragma once
/// \file
/// Shared by tests of bad input: a host with a running match, and a player in it that must not be affected.

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "spark/predicates.h"
#include "test_support.h"

namespace spark::test {

/// A well-behaved player that only observes. In lockstep it answers for as long as its observations are read.
class Witness {
 public:
  Witness(unsigned short port, const std::string& team, int number, const std::string& robot = "rsg/agent/sphere.rsg")
      : client_(port) {
    client_.send("(scene " + robot + ")(syn)");
    client_.receive();
    client_.send("(init (unum " + std::to_string(number) + ")(teamname " + team + "))(syn)");
  }
  /// Waits until simulated time has advanced by a few cycles from now.
  void mustSeeTimePass() {
    while (client_.pending()) client_.receive();  // messages sent before now prove nothing
    client_.send("(syn)");
    const double begin = time();
    for (double now = begin; now < begin + 0.1;) now = time();
  }
  Client& client() { return client_; }
  /// True once the host has assigned a side or a number; reads at most `messages` messages.
  bool hasTeam(int messages) {
    for (int i = 0; i < messages; ++i)
      if (client_.receive().find("(unum ") != std::string::npos) return true;
    return false;
  }

 private:
  double time() {
    Predicates p;
    readSexp(client_.receive(), p);
    client_.send("(syn)");
    for (const Element e : p)
      if (e.head() == "time") return e.named("now").at(1).number();
    throw std::runtime_error("a message without time");
  }
  Client client_;
};

/// A host with a witness in it.
struct Arena {
  Process host;
  unsigned short agentPort = 0, monitorPort = 0, webPort = 0;
  std::unique_ptr<Witness> witness;

  explicit Arena(std::vector<std::string> more = {}, const std::string& config = "soccer-sphere.lua")
      : host(command(std::move(more), config), 60) {
    const nlohmann::json ports = nlohmann::json::parse(host.line());
    agentPort = ports["agentPort"];
    monitorPort = ports["monitorPort"];
    if (ports["web"].is_string())
      webPort = static_cast<unsigned short>(
          std::stoi(ports["web"].get<std::string>().substr(std::string("http://127.0.0.1:").size())));
    witness = std::make_unique<Witness>(
        agentPort, "Calm", 1, config == "soccer-sphere.lua" ? "rsg/agent/sphere.rsg" : "rsg/agent/nao/nao.rsg");
    witness->mustSeeTimePass();
  }
  static std::vector<std::string> command(std::vector<std::string> more, const std::string& config) {
    std::vector<std::string> c{(binFolder() / "sparkhost").string(),
                               "--config",
                               config,
                               "--agent-port",
                               "0",
                               "--monitor-port",
                               "0",
                               "--web-port",
                               "0"};
    c.insert(c.end(), more.begin(), more.end());
    return c;
  }
  /// Resident memory of the host [MiB].
  double memory() {
    std::ifstream in("/proc/" + std::to_string(host.pid()) + "/statm");
    double total = 0, resident = 0;
    in >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
  }
  void mustEndWell() {
    witness->mustSeeTimePass();
    host.signal(15);
    REQUIRE(nlohmann::json::parse(host.line())["cycles"].get<int>() > 0);
    REQUIRE(host.wait() == 0);
  }
};

}  // namespace spark::test
