#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absence.h"
#include "client.h"
#include "process.h"
#include "spark/predicates.h"
#include "test_support.h"

// Clients that join the default league in the way the programs of well-known teams do: in lockstep and in real time,
// one after the other and all at once, eleven on each side.

using namespace spark;
using namespace spark::test;

namespace {

struct Host {
  Process process;
  unsigned short port;

  explicit Host(bool lockstep) : process(command(lockstep)), port(nlohmann::json::parse(process.line())["agentPort"]) {}
  static std::vector<std::string> command(bool lockstep) {
    std::vector<std::string> c{(binFolder() / "sparkhost").string(),
                               "--config",
                               "soccer.lua",
                               "--agent-port",
                               "0",
                               "--monitor-port",
                               "0",
                               "--log-level",
                               "warning"};
    if (lockstep) c.insert(c.end(), {"--sync", "--rate", "max"});
    return joined(c, withoutLimits());
  }
  void mustEndWell() {
    process.signal(15);
    process.line();
    REQUIRE(process.wait() == 0);
    for (const char* complaint : {"effector registered", "refused"})
      REQUIRE(lacks(process.errors(), complaint, complaints()));
  }
  /// What a host says of a player that sends an unknown action and asks for a second robot.
  static const std::string& complaints() {
    static const std::string log = [] {
      Host host(false);
      Client player(host.port);
      player.send("(scene rsg/agent/nao/nao.rsg)");
      player.receive();
      player.send("(fly 1)(scene rsg/agent/nao/nao.rsg)");
      host.process.waitForError("refused");
      return host.process.errors();
    }();
    return log;
  }
};

/// A player's connection and the state of its side, from the messages received.
class Player {
 public:
  Player(unsigned short port, std::string team, int unum) : client_(port), team_(std::move(team)), unum_(unum) {}

  std::string scene() const { return "(scene rsg/agent/nao/nao_hetero.rsg " + std::to_string(unum_ % 4) + ")"; }
  std::string init() const { return "(init (unum " + std::to_string(unum_) + ")(teamname " + team_ + "))"; }
  void send(const std::string& message) { client_.send(message); }
  bool pending() { return client_.pending(); }
  /// Reads one message, which must differ from the previous one.
  void receiveOne() {
    std::string message = client_.receive();
    REQUIRE(message != last_);
    last_ = std::move(message);
    ++heard_;
    Predicates p;
    readSexp(last_, p);
    for (const Element e : p) {
      if (e.head() != "GS") continue;
      if (const Element side = e.named("team")) side_ = side.at(1).text();
      if (const Element number = e.named("unum")) REQUIRE(number.at(1).integer() == unum_);
    }
  }
  /// Waits for a message, then reads until no more are pending.
  void receive() {
    do receiveOne();
    while (pending());
  }
  /// "left", "right", or "" before the server has sent it.
  const std::string& side() const { return side_; }
  int heard() const { return heard_; }
  const std::string& team() const { return team_; }

 private:
  Client client_;
  std::string team_, last_, side_;
  int unum_, heard_ = 0;
};
using Team = std::vector<std::unique_ptr<Player>>;

/// Joins as an agent of the FC Portugal code base does, while the same program leads `others`: it answers for them
/// while it waits for the newcomer. In lockstep it has a side after three cycles; in real time the host may be a few
/// cycles ahead.
std::unique_ptr<Player> joinPorto(unsigned short port, const std::string& team, int unum, Team& others, bool lockstep) {
  auto p = std::make_unique<Player>(port, team, unum);
  const auto waitFor = [&] {
    while (!others.empty() && !p->pending()) {
      for (auto& o : others) o->send("(syn)");
      for (auto& o : others) o->receive();
    }
    p->receive();
  };
  p->send(p->scene());
  waitFor();
  p->send(p->init());
  waitFor();
  for (int i = 0; i < 3 || (!lockstep && p->side().empty()); ++i) {
    p->send("(syn)");
    for (auto& o : others) o->send("(syn)");
    for (auto& o : others) o->receive();
    p->receive();
  }
  return p;
}

void requireSides(const Team& players) {
  for (const auto& p : players) REQUIRE(p->side() == (p->team() == "Alpha" ? "left" : "right"));
}

}  // namespace

TEST_CASE(
    "A program adds eleven players one after the other with scene, init and three times (syn) in separate messages") {
  const bool lockstep = GENERATE(true, false);
  Host host(lockstep);
  Team players;
  for (int unum = 1; unum <= 11; ++unum) players.push_back(joinPorto(host.port, "Alpha", unum, players, lockstep));
  requireSides(players);
  for (int i = 0; i < 30; ++i) {
    for (auto& p : players) p->send("(he1 0.12345)(lae1 -1.50000)(syn)");
    for (auto& p : players) p->receive();
  }
  host.mustEndWell();
}

TEST_CASE(
    "Players of two teams join at once, each with scene and (syn), init and (syn), then (syn) until it has a number") {
  const bool lockstep = GENERATE(true, false);
  Host host(lockstep);
  Team players;
  for (int unum = 1; unum <= 11; ++unum)
    for (const char* team : {"Alpha", "Beta"}) {
      players.push_back(std::make_unique<Player>(host.port, team, unum));
      players.back()->send(players.back()->scene() + "(syn)");
      if (players.size() == 1)
        players.back()->receiveOne(),
            players.back()->send(players.back()->init() + "(syn)");  // Alpha gets the left side
    }
  const auto done = [](const auto& p) { return !p->side().empty() && p->heard() >= 20; };
  while (!std::all_of(players.begin(), players.end(), done))
    for (auto& p : players) {
      if (!p->pending()) continue;
      p->receiveOne();
      p->send(p->heard() == 1 ? p->init() + "(syn)" : "(syn)");
    }
  requireSides(players);
  host.mustEndWell();
}

TEST_CASE(
    "Players that send scene and init without (syn) and wait for the rest of both teams join a match in lockstep") {
  Host host(true);
  Team players;
  Player& leader = *players.emplace_back(std::make_unique<Player>(host.port, "Alpha", 1));
  leader.send(leader.scene() + "(syn)");
  leader.receiveOne();
  leader.send(leader.init() + "(syn)");
  // All players read what arrives; a waiting player answers only once, with init.
  const auto play = [&](bool all) {
    for (auto& p : players) {
      if (!p->pending()) continue;
      p->receiveOne();
      const bool named = p->heard() > 1 || p.get() == &leader;
      if (!named)
        p->send(p->init());
      else if (all || p.get() == &leader)
        p->send("(syn)");
    }
  };
  for (int unum = 1; unum <= 11; ++unum)
    for (const char* team : {"Alpha", "Beta"}) {
      if (unum == 1 && std::string(team) == "Alpha") continue;
      auto& p = players.emplace_back(std::make_unique<Player>(host.port, team, unum));
      p->send(p->scene());
      while (p->side().empty()) play(false);
    }
  requireSides(players);
  // So far the leader alone has advanced the match; now all players do.
  for (std::size_t i = 1; i < players.size(); ++i) players[i]->send("(syn)");
  std::vector<int> before;
  for (auto& p : players) before.push_back(p->heard());
  const auto done = [&] {
    for (std::size_t i = 0; i < players.size(); ++i)
      if (players[i]->heard() < before[i] + 20) return false;
    return true;
  };
  while (!done()) play(true);
  host.mustEndWell();
}
