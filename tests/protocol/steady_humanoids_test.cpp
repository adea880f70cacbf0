#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <deque>

#include "allocations.h"
#include "api/agents.h"
#include "spark/script_server.h"
#include "test_support.h"

// Two teams of humanoids in lua/soccer.lua that move all their motors: sensing, encoding and sending must not allocate.
// They use fake connections without sockets.

using namespace spark;
using namespace spark::test;

namespace {

constexpr int kTeam = 11, kTypes = 3;

/// A player at the other end of a connection.
class Player : public IConnection {
 public:
  Player(Node& port, int index) : port_(port), index_(index) {}
  std::uint64_t id() const override { return static_cast<std::uint64_t>(index_) + 1; }
  const std::string& peer() const override { return peer_; }
  Node& port() override { return port_; }
  bool send(std::string_view message) override {
    ++heard_;
    longest_ = std::max(longest_, message.size());
    return true;
  }
  bool idle() const override { return true; }
  double stalledSeconds() const override { return 0; }
  void close(std::string_view why) override { FAIL(why); }

  /// Sends the next message, once for every message received.
  void answer(IConnectionConsumer& control) {
    if (said_ > heard_) return;
    control.received(*this, words());
    ++said_;
  }
  std::int64_t heard() const { return heard_; }
  std::size_t longest() const { return longest_; }

 private:
  std::string_view words() {
    const int n = index_ % kTeam;
    size_ = 0;
    if (said_ == 0) say("(scene rsg/agent/nao/nao_hetero.rsg %d)", index_ % kTypes);
    if (said_ == 1) say("(init (unum %d)(teamname %s))", n + 1, index_ < kTeam ? "A" : "B");
    if (said_ == 4) say("(beam %.1f %.1f 0)", -2 - 2.4 * (n % 4), 4.0 * (n / 4 - 1) + 0.3 * (n % 4));
    if (said_ > 20)
      for (const char* motor : {"he1",  "he2",  "lae1", "lae2", "lae3", "lae4", "rae1", "rae2", "rae3", "rae4", "lle1",
                                "lle2", "lle3", "lle4", "lle5", "lle6", "rle1", "rle2", "rle3", "rle4", "rle5", "rle6"})
        say("(%s %.4f)", motor, 0.8 * std::sin(0.06 * static_cast<double>(said_) + 0.7 * size_));
    return {text_, static_cast<std::size_t>(size_)};
  }
  template <class... A>
  void say(const char* format, A... values) {
    size_ += std::snprintf(text_ + size_, sizeof text_ - static_cast<std::size_t>(size_), format, values...);
  }

  Node& port_;
  const int index_;
  std::string peer_ = "test";
  char text_[1024] = {};
  int size_ = 0;
  std::int64_t said_ = 0, heard_ = 0;
  std::size_t longest_ = 0;
};

/// An input source that delivers the players' messages.
class TestPlayers : public Node, public IInputSource {
  SPARK_CLASS(TestPlayers, Node)
 public:
  static void describe(Description<TestPlayers>& d) {
    d.doc("Players without a network.");
    d.implements<IInputSource>();
  }
  void connect(Node& control, Node& port) {
    control_ = control.as<IConnectionConsumer>();
    for (int i = 0; i < 2 * kTeam; ++i) control_->connected(players.emplace_back(port, i));
  }
  void poll() override {
    for (Player& p : players) p.answer(*control_);
  }
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }
  std::deque<Player> players;

 private:
  IConnectionConsumer* control_ = nullptr;
};

struct Match : TestHost {
  TestPlayers* team;
  explicit Match(int threads) {
    kernel.log().setLevel(Level::warning);
    kernel.registerClass<TestPlayers>();
    ScriptServer& lua = scripts(kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = {} }", "match");
    for (const char* port : {"agents", "monitors"}) lua.addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
    lua.addOverride("/sys/server/simulation.rate", "max");
    lua.addOverride("web", false);  // it works by the wall clock, also without viewers
    lua.addOverride("/sys/server/simulation.threads", threads);
    lua.runConfig("soccer.lua");
    team = &kernel.create("TestPlayers", "/sys/server/players").as<TestPlayers>()[0];
    team->connect(node("gamecontrol"), node("net/agents"));
  }
  Node& node(const std::string& name) { return kernel.root().require<Node>("/sys/server/" + name); }
  void play(std::int64_t cycles) { callMethod(node("simulation"), "runCycles", std::vector<Value>{cycles}); }
};

}  // namespace

TEST_CASE("Two teams of moving humanoids with all their percepts and messages allocate nothing in steady state") {
  Match m(GENERATE(1, 2));
  m.play(250);
  const auto heard = m.team->players.back().heard();
  const int one = Allocations::in([&] { m.play(1); });  // allocations of the call itself
  const int hundred = Allocations::in([&] { m.play(100); });
  INFO(m.text);
  REQUIRE(hundred == one);
  for (const Player& p : m.team->players) CHECK(p.longest() > 800);
  CHECK(m.team->players.back().heard() == heard + 101);
  CHECK(m.text.empty());
}
