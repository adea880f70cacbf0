#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "process.h"
#include "spark/client/connection.h"
#include "spark/client/expression.h"
#include "test_support.h"

// Clients as existing programs implement them, written from descriptions of their behavior on the wire: players of two
// code bases, a program that creates its agents one after the other, a robot that does not play soccer, a utility that
// only sends, a viewer that pauses, a learner.

using namespace spark::test;
using spark::client::Connection;
using spark::client::Expression;
using spark::client::read;

namespace {

struct ServingHost {
  Process process;
  int agentPort = 0, monitorPort = 0;

  explicit ServingHost(std::vector<std::string> arguments) : process(command(std::move(arguments))) {
    const auto ports = nlohmann::json::parse(process.line());
    agentPort = ports["agentPort"];
    monitorPort = ports["monitorPort"];
  }
  static std::vector<std::string> command(std::vector<std::string> more) {
    std::vector<std::string> c{
        (binFolder() / "sparkhost").string(), "--agent-port", "0", "--monitor-port", "0", "--set", "web=false"};
    return joined(joined(c, withoutLimits()), more);
  }
  nlohmann::json result() {
    const auto line = nlohmann::json::parse(process.line());
    REQUIRE(process.wait() == 0);
    return line;
  }
};

const char* const kNao = "(scene rsg/agent/nao/nao_hetero.rsg 0)";

std::string init(const std::string& team, int unum) {
  return "(init (unum " + std::to_string(unum) + ")(teamname " + team + "))";
}

/// A player with a list of messages. It sends the next one after each message that it receives, and repeats the last
/// one.
class ScriptedPlayer {
 public:
  ScriptedPlayer(int port, std::vector<std::string> words) : connection_("127.0.0.1", port), words_(std::move(words)) {
    say();
  }
  /// Answers at most one message, because a fast host sends the next one at once. False when the server has closed the
  /// connection.
  bool play() try {
    if (const auto message = connection_.receive(0.001)) {
      ++heard_;
      last_ = read(*message);
      say();
    }
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
  int heard() const { return heard_; }
  const Expression& last() const { return last_; }
  double time() const { return last_.find("time").find("now")[1].number(); }

 private:
  void say() {
    connection_.send(words_[next_]);
    if (next_ + 1 < words_.size()) ++next_;
  }
  Connection connection_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
  int heard_ = 0;
  Expression last_;
};

/// The first messages of the two large code bases, of a small one, and of a robot in another game.
std::vector<std::string> stepByStep(int unum) { return {kNao, init("Porto", unum), "(syn)"}; }
std::vector<std::string> inTurn(int unum) {
  return {std::string(kNao) + "(syn)", init("Austin", unum) + "(syn)", "(he1 0.5)(syn)"};
}
std::vector<std::string> atOnce(int unum) { return {kNao + init("Small", unum) + "(syn)", "(syn)"}; }
std::vector<std::string> plain(int) { return {"(scene rsg/agent/sphere.rsg)(syn)", "(syn)"}; }

/// Runs a match that starts when these players, connected in this order, are ready; returns its state hash.
std::string match(const std::vector<int>& order) {
  const std::vector<std::vector<std::string>> kinds{stepByStep(1), stepByStep(2), inTurn(1),
                                                    inTurn(9),     atOnce(4),     plain(0)};
  ServingHost host({"--config", "soccer.lua", "--sync", "--rate", "max", "--expect", std::to_string(order.size()),
                    "--duration", "2", "--set", "/sys/server/gamecontrol.holdWait=0.02"});
  std::vector<std::unique_ptr<ScriptedPlayer>> players;
  for (const int kind : order)
    players.push_back(std::make_unique<ScriptedPlayer>(host.agentPort, kinds[static_cast<std::size_t>(kind)]));
  for (bool on = true; on;)
    for (auto& p : players) on &= p->play();
  const auto result = host.result();
  CHECK(result["agentsSeen"] == order.size());
  CHECK(result["simSeconds"] == 2.0);
  for (auto& p : players) CHECK(p->heard() >= 95);
  return result["stateHash"];
}

/// A sphere that keeps a match in lockstep running for `seconds`.
struct Pacemaker : ScriptedPlayer {
  explicit Pacemaker(int port)
      : ScriptedPlayer(port, {"(scene rsg/agent/sphere.rsg)(syn)", init("Pace", 1) + "(syn)", "(syn)"}) {}
  void run(double seconds) {
    while (heard() < 3) REQUIRE(play());
    for (const double begin = time(); time() < begin + seconds;) REQUIRE(play());
  }
};

double timeOf(const std::string& message) { return read(message)[0].find("time")[1].number(); }
std::string kindOf(const std::string& message) { return read(message)[1].name(); }

}  // namespace

TEST_CASE("With --expect the match is the same for any connection order of players that join in different ways") {
  const std::string first = match({0, 1, 2, 3, 4, 5});
  REQUIRE(match({5, 4, 3, 2, 1, 0}) == first);
  REQUIRE(match({2, 5, 0, 4, 1, 3}) == first);
}

TEST_CASE(
    "With --expect a program that creates its agents one after the other can play, and the match starts when no more "
    "connect") {
  ServingHost host({"--config", "soccer.lua", "--sync", "--rate", "max", "--expect", "3", "--set",
                    "/sys/server/gamecontrol.holdWait=0.02", "--set", "/sys/server/gamecontrol.joinWait=0.5"});
  std::vector<std::unique_ptr<ScriptedPlayer>> players;
  for (int unum = 1; unum <= 3; ++unum) {
    players.push_back(std::make_unique<ScriptedPlayer>(host.agentPort, stepByStep(unum)));
    while (players.back()->heard() < 6)
      for (auto& p : players) REQUIRE(p->play());
  }
  for (const double begin = players.back()->time(); players.back()->time() < begin + 1;)
    for (auto& p : players) REQUIRE(p->play());
  // On a slow machine the wait for the first agent may time out, too.
  CHECK(std::regex_search(host.process.errors(),
                          std::regex(R"(Of 3 expected agents [012] are ready, and nothing more came for 0\.5 s )"
                                     R"(\(joinWait\): the match starts\.)")));
  Connection("127.0.0.1", host.monitorPort).send("(killsim)");
  for (bool on = true; on;)  // in lockstep the match ends with its next cycle
    for (auto& p : players) on &= p->play();
  CHECK(host.result()["agentsSeen"] == 3);
}

TEST_CASE("The host reports which agents it waits for") {
  ServingHost host({"--config", "soccer.lua", "--sync", "--rate", "max", "--expect", "2", "--set",
                    "/sys/server/gamecontrol.holdReport=0.05", "--set", "/sys/server/gamecontrol.joinWait=3600"});
  Connection half("127.0.0.1", host.agentPort);
  half.send(kNao);
  host.process.waitForError(" has named its robot, owes (init ...) and (syn); 1 is not connected; ");
  CHECK(half.receive() == "(time (now 0.00))");
  host.process.signal(15);
  host.result();
}

TEST_CASE("A utility that only sends commands to the monitor port and never reads is never closed") {
  ServingHost host(
      {"--config", "soccer-sphere.lua", "--sync", "--rate", "max", "--set", "Soccer.AutomaticKickOff=false"});
  Connection utility("127.0.0.1", host.monitorPort);
  Pacemaker player(host.agentPort);
  player.run(0.1);
  // 120 s: about ten times what fits into the socket buffers.
  for (int i = 0; i < 12; ++i) {
    const std::string mode = i % 2 == 0 ? "PlayOn" : "BeforeKickOff";
    utility.send("(playMode " + mode + ")");
    player.run(10);
    CHECK(player.last().find("GS").find("pm")[1].text() == mode);
  }
  utility.send("(killsim)");  // its connection is still open
  while (player.play()) {
  }
  host.result();
}

TEST_CASE("A viewer that pauses gets complete messages again, and the complete scene on request") {
  // While the viewer reads, the player does not answer, so the match waits.
  ServingHost host({"--config", "soccer-sphere.lua", "--sync", "--rate", "max"});
  Connection viewer("127.0.0.1", host.monitorPort);
  REQUIRE(kindOf(*viewer.receive()) == "RSG");
  Pacemaker player(host.agentPort);
  player.run(120);
  const double now = player.last().find("GS").find("t")[1].number();  // monitors get the time of the match
  REQUIRE(now > 60);
  // The viewer gets the messages that were in the buffers when these were full, then a gap, then the current messages.
  constexpr double kLook = 0.1;  // s of wall time; TCP needs seconds to resume a full connection, and the
                                 // match must not end meanwhile
  double last = 0, gap = 0;
  int messages = 0;
  while (last < now - 0.5) {
    auto message = viewer.receive(kLook);
    if (!message) {
      player.run(0.04);
      continue;
    }
    ++messages;
    const std::string kind = kindOf(*message);
    REQUIRE((kind == "RSG" || kind == "RDS"));
    REQUIRE(read(*message).size() == 3);
    gap = std::max(gap, timeOf(*message) - last);
    REQUIRE(timeOf(*message) >= last);
    last = timeOf(*message);
  }
  CHECK(messages > 10);
  CHECK(gap > 1);
  viewer.send("(reqfullstate)");
  std::string kind;
  while (kind != "RSG") {
    if (auto message = viewer.receive(kLook))
      kind = kindOf(*message);
    else
      player.run(0.04);
  }
  viewer.send("(killsim)");
  while (player.play()) {
  }
  host.result();
}

TEST_CASE("With cheats=true a learner sees the ground truth and the effect of a trainer that never reads") {
  const std::string config = GENERATE("training.lua", "soccer-sphere.lua");
  ServingHost host({"--config", config, "--sync", "--rate", "max", "--expect", "1", "--set", "cheats=true", "--set",
                    "Soccer.AutomaticKickOff=false"});
  const bool sphere = config == "soccer-sphere.lua";
  const std::string scene = sphere ? "(scene rsg/agent/sphere.rsg)" : kNao;
  ScriptedPlayer player(host.agentPort, {scene + init("Learner", 1) + "(syn)", "(syn)"});
  Connection trainer("127.0.0.1", host.monitorPort);
  while (player.heard() < 5) REQUIRE(player.play());
  trainer.send("(playMode PlayOn)(agent (unum 1)(team Left)(move -4 2 0.5 0))(ball (pos 3 1 0.05)(vel 0 0 0))");
  const auto number = [&](const char* name, std::size_t i) { return player.last().find("See").find(name)[i].number(); };
  // The commands act within a few cycles, and vision is updated in every third cycle.
  while (!(player.last().find("See").size() > 1 && std::abs(number("mypos", 1) + 4) < 0.3 &&
           std::abs(number("mypos", 2) - 2) < 0.3 && std::abs(number("ballpos", 1) - 3) < 0.1 &&
           std::abs(number("ballpos", 2) - 1) < 0.1))
    REQUIRE(player.play());
  CHECK(player.last().find("See").find("myorien").size() == 2);
  trainer.send("(killsim)");
  while (player.play()) {
  }
  host.result();
}
