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

/// A separate player that only observes the match. In lockstep it answers a message only when the test calls one of its
/// functions, and so keeps the match running; with `answers` false it never sends (syn).
class Witness {
 public:
  Witness(unsigned short port, const std::string& team, int number, const std::string& robot = "rsg/agent/sphere.rsg",
          bool answers = true)
      : client_(port), syn_(answers ? "(syn)" : "") {
    client_.send("(scene " + robot + ")" + syn_);
    client_.receive();
    client_.send("(init (unum " + std::to_string(number) + ")(teamname " + team + "))" + syn_);
  }
  /// Waits until simulated time has advanced by a few cycles from now.
  void mustSeeTimePass() {
    while (client_.pending()) client_.receive();  // messages from before this call do not count
    answer();
    const double begin = time();
    for (double now = begin; now < begin + 0.1;) now = time();
  }
  Client& client() { return client_; }
  /// Reads messages until one contains the number that the host assigned; returns false if the next `messages` do not.
  bool hasTeam(int messages) {
    for (int i = 0; i < messages; ++i)
      if (client_.receive().find("(unum ") != std::string::npos) return true;
    return false;
  }
  /// Reads messages until one contains that number.
  void waitForTeam() {
    while (!hasTeam(1)) {
    }
  }

 private:
  double time() {
    Predicates p;
    readSexp(client_.receive(), p);
    answer();
    for (const Element e : p)
      if (e.head() == "time") return e.named("now").at(1).number();
    throw std::runtime_error("a message without time");
  }
  void answer() {
    if (!syn_.empty()) client_.send(syn_);
  }
  Client client_;
  std::string syn_;
};

/// The log of a host with a body that has no numbers: what a host says if an attacker gets one.
inline const std::string& withoutNumbers() {
  static const std::string log =
      runToEnd({program("sparkhost"), "--config", SPARK_SOURCES "/tests/reports/cases/eng_no_number.lua", "--rate",
                "max", "--duration", "0.2"})
          .errors;
  return log;
}

/// A host with a witness in it.
struct Arena {
  Process host;
  unsigned short agentPort = 0, monitorPort = 0, webPort = 0;
  std::unique_ptr<Witness> witness;

  /// `answers`: whether the witness answers in lockstep. All wall-clock limits of the host are off, except those in
  /// `more`.
  explicit Arena(std::vector<std::string> more = {}, const std::string& config = "soccer-sphere.lua",
                 bool answers = true)
      : host(command(std::move(more), config)) {
    const nlohmann::json ports = nlohmann::json::parse(host.line());
    agentPort = ports["agentPort"];
    monitorPort = ports["monitorPort"];
    if (ports["web"].is_string())
      webPort = static_cast<unsigned short>(
          std::stoi(ports["web"].get<std::string>().substr(std::string("http://127.0.0.1:").size())));
    witness = std::make_unique<Witness>(
        agentPort, "Calm", 1, config == "soccer-sphere.lua" ? "rsg/agent/sphere.rsg" : "rsg/agent/nao/nao.rsg",
        answers);
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
    return joined(joined(c, withoutLimits()), more);
  }
  /// Sets a property of the running host, such as a limit that must not apply while the arena is set up.
  void set(const std::string& property, const std::string& value) {
    REQUIRE(runToEnd(joined(sparkctl(host.pid()), {"set", property, value})).code == 0);
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
