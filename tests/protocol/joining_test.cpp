#include <catch2/catch.hpp>

#include "arena.h"

// How agents join a running match in lockstep: from when on the simulation waits for an agent, and which agents cannot
// block the others.

using namespace spark;
using namespace spark::test;

namespace {

/// Connects and runs cycles until the agent exists.
Client connect(Arena& a) {
  const auto before = a.agents();
  Client c = a.client();
  a.until([&] { return a.agents() > before; });
  return c;
}
/// Counts the messages of `c` until the simulation is blocked (200 tries without a cycle).
std::size_t messagesUntilBlocked(Arena& a, Client& c) {
  std::size_t n = 0;
  for (int blocked = 0; blocked < 200;) {
    blocked = a.step() ? 0 : blocked + 1;
    n += c.drain().size();
  }
  return n;
}
/// Runs cycles until `c` has a message, while `answering` answer theirs; returns the number of messages.
std::size_t firstMessages(Arena& a, Client& c, const std::vector<Client*>& answering = {}) {
  std::size_t n = 0;
  a.until([&] {
    for (Client* other : answering)
      if (!other->drain().empty()) other->send("(syn)");
    return (n = c.drain().size()) > 0;
  });
  return n;
}
/// A client like that of the FC Portugal code base: (scene ...) alone, a message, (init ...), three times (syn) and a
/// message; then a (syn) for every message.
class Portugal {
 public:
  Portugal(Arena& a, int unum) : client_(a.client()), unum_(unum) { client_.send("(scene robot)"); }
  /// Reads what has arrived and sends the next step.
  void play() {
    const auto messages = client_.drain();
    heard_ += messages.size();
    if (messages.empty()) return;
    if (!named_) client_.send(fmt::format("(init (unum {})(teamname Porto))", unum_));
    named_ = true;
    client_.send("(syn)");
  }
  std::size_t heard() const { return heard_; }

 private:
  Client client_;
  const int unum_;
  bool named_ = false;
  std::size_t heard_ = 0;
};

}  // namespace

TEST_CASE("After (scene ...)(syn) the first percepts need no further (syn), and the second do") {
  Arena a(true);
  Client c = connect(a);
  c.send("(scene robot)(syn)");
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 1);
  SECTION("an answer without (syn) does not count") { c.send("(init (unum 1)(teamname A))"); }
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 0);
  c.send("(syn)");
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 1);
}

TEST_CASE("A separate (syn) before (scene ...) counts as well") {
  Arena a(true);
  Client c = connect(a);
  c.send("(syn)");
  c.arrive();
  for (int i = 0; i < 20; ++i) REQUIRE(a.step());
  c.send("(scene robot)");
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 1);
}

TEST_CASE("The first answer of a client that sends (syn) with (scene ...) acts in the very next cycle") {
  Arena a(true);
  Client c = connect(a);
  c.send("(scene robot)(syn)");
  c.arrive();
  messagesUntilBlocked(a, c);
  const auto before = a.cycles();
  c.send("(init (unum 1)(teamname A))(syn)");
  a.until([&] { return !actionLog().empty(); });
  REQUIRE(a.cycles() == before + 1);
}

TEST_CASE("A client that stopped answering before its first (syn) gets every cycle's percepts and delays nothing") {
  Arena a(true);
  a.set("joinPace", 0);
  Client player = connect(a);
  player.send("(scene robot)(syn)");
  messagesUntilBlocked(a, player);
  Client watcher = a.client();
  watcher.send("(scene robot)");
  std::size_t told = firstMessages(a, watcher, {&player});
  watcher.send("(init (unum 2)(teamname A))");
  watcher.arrive();
  a.set("answerWait", 0);  // it answers nothing more
  player.drain();
  for (int i = 0; i < 20; ++i) {
    player.send("(syn)");
    player.arrive();
    told += messagesUntilBlocked(a, watcher);
    player.drain();
  }
  REQUIRE(told == 21);
  REQUIRE(actionLog() == std::vector<std::string>{"2 init A 2"});
  SECTION("the simulation waits for it after its first (syn)") {
    watcher.send("(syn)");
    watcher.arrive();
    REQUIRE(messagesUntilBlocked(a, watcher) == 0);
    player.send("(syn)");
    player.arrive();
    REQUIRE(messagesUntilBlocked(a, watcher) == 1);
    player.send("(syn)");
    player.arrive();
    REQUIRE(messagesUntilBlocked(a, watcher) == 0);
    watcher.send("(syn)");
    watcher.arrive();
    REQUIRE(messagesUntilBlocked(a, watcher) == 1);
  }
}

TEST_CASE(
    "A client that answers only after a pause can join alone, since cycles are paced until an agent sends (syn)") {
  Arena a(true);
  a.set("joinPace", 3600.0);
  Client c = connect(a);
  c.send("(scene robot)");
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 1);
  c.send("(init (unum 1)(teamname A))");
  c.arrive();
  REQUIRE(messagesUntilBlocked(a, c) == 0);
  a.set("joinPace", 0);
  REQUIRE(a.step());
  c.send("(syn)");
  c.arrive();
  REQUIRE(a.step());
}

TEST_CASE("A new client that never sends (syn) slows a match only for its first messages") {
  Arena a(true);
  a.set("joinPace", 0.001);
  a.set("answerWait", 0.001);
  Client player = connect(a), watcher = connect(a);
  player.send("(scene robot)(syn)");
  watcher.send("(scene robot)");
  std::size_t told = 0;
  const auto play = [&] {
    told += watcher.drain().size();
    if (!player.drain().empty()) player.send("(syn)");
  };
  a.until([&] { return play(), told >= 51; });
  a.set("joinPace", 3600.0);
  a.until([&] { return play(), told >= 60; });
}

TEST_CASE("Eleven clients that send scene and init without (syn) join a match in lockstep next to another player") {
  Arena a(true);
  a.set("joinPace", 0.0005);
  Client host = connect(a);
  host.send("(scene robot)(syn)");
  std::vector<std::unique_ptr<Portugal>> team;
  const auto play = [&] {
    if (!host.drain().empty()) host.send("(syn)");
    for (auto& p : team) p->play();
  };
  for (int unum = 1; unum <= 11; ++unum) {
    team.push_back(std::make_unique<Portugal>(a, unum));
    a.until([&] { return play(), team.back()->heard() >= 4; });
  }
  REQUIRE(a.agents() == 12);
  const auto from = a.cycles();
  a.until([&] { return play(), a.cycles() >= from + 50; });
  REQUIRE(a.get("messagesDropped").toInteger() == 0);
  std::vector<std::string> inits;
  for (const auto& action : actionLog())
    if (action.find("init") != action.npos) inits.push_back(action);
  REQUIRE(inits.size() == 11);
}

TEST_CASE("A program with eleven agents may answer each message at once or all after reading the last") {
  const bool atOnce = GENERATE(true, false);
  Arena a(true);
  a.set("answerWait", 0.001);
  std::vector<Client> team;
  for (int unum = 1; unum <= 11; ++unum) {
    team.push_back(a.client());
    team.back().send("(scene robot)(syn)");
    team.back().arrive();
    a.step();  // so that they join in different cycles
  }
  std::vector<std::size_t> told(team.size(), 0);
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      a.until([&] { return (told[i] += team[i].drain().size()) > 0; });
      --told[i];
      if (atOnce) team[i].send("(syn)");
    }
    if (!atOnce)
      for (Client& c : team) c.send("(syn)");
  }
  REQUIRE(a.agents() == 11);
}

TEST_CASE(
    "The simulation waits for a player while another agent joins, but only for answerWait before its first percepts") {
  Arena a(true);
  a.set("answerWait", 3600.0);
  Client player = connect(a);
  player.send("(scene robot)(syn)");
  player.arrive();
  messagesUntilBlocked(a, player);
  Client other = a.client();
  other.send("(scene robot)(syn)");
  other.arrive();
  REQUIRE(messagesUntilBlocked(a, player) == 0);
  a.set("answerWait", 0);
  a.until([&] { return !other.drain().empty(); });
  a.set("syncTimeout", 0);
  other.send("(syn)");
  other.arrive();
  player.drain();
  REQUIRE(messagesUntilBlocked(a, player) == 0);
}

namespace {
/// Plays with an agent until it is trusted, which means that it has answered enough messages.
void playUntilTrusted(Arena& a, Client& player) {
  int answered = 0;
  a.until([&] {
    for (std::size_t n = player.drain().size(); n > 0; --n, ++answered) player.send("(syn)");
    return answered >= 120;
  });
}
}  // namespace

TEST_CASE("New agents that join a match in lockstep and never answer delay it by at most joinBudget in total") {
  Arena a(true);
  a.set("joinBudget", 0.02);
  a.set("joinPace", 3600.0);  // new agents that have not sent (syn) would stop it, too
  const bool says = GENERATE(true, false);
  Client player = a.client();
  player.send("(scene robot)(syn)");
  playUntilTrusted(a, player);
  for (int i = 0; i < 5; ++i) {
    Client stranger = a.client();
    stranger.send(says ? "(scene robot)(syn)" : "(scene robot)");
    stranger.arrive();
    const auto from = a.cycles();
    a.until([&] {
      for (std::size_t n = player.drain().size(); n > 0; --n) player.send("(syn)");
      return a.cycles() >= from + 50;
    });
  }
}

TEST_CASE("Without trusted agents in the match the joinBudget does not apply") {
  Arena a(true);
  a.set("joinBudget", 0);
  a.set("syncTimeout", 0);
  Client player = connect(a);
  player.send("(scene robot)(syn)");
  player.arrive();
  messagesUntilBlocked(a, player);
  const auto from = a.cycles();
  for (int i = 0; i < 200; ++i) a.step();
  REQUIRE(a.cycles() == from);
}

TEST_CASE("In lockstep robots of untrusted agents are built 2 maxAgents at once, then a few per second") {
  const bool crowd = GENERATE(false, true);
  Arena a(true);
  if (crowd) a.set("maxAgents", 1000);
  Client player = a.client();
  player.send("(scene robot)(syn)");
  const auto begin = std::chrono::steady_clock::now();
  playUntilTrusted(a, player);
  for (int i = 0; i < 200; ++i) {
    Client stranger = a.client();
    stranger.send("(scene robot)");
    stranger.arrive();
    for (int k = 0; k < 4; ++k) {
      a.step();
      for (std::size_t n = player.drain().size(); n > 0; --n) player.send("(syn)");
    }
  }
  const double few = 4 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto seen = static_cast<double>(a.get("agentsSeen").toInteger());
  REQUIRE(seen > (crowd ? 199 : 100));
  REQUIRE(seen < (crowd ? 202 : 132 + few));  // twice maxAgents are 128
}

TEST_CASE("Clients that repeatedly connect, cause errors and leave write a bounded number of log lines") {
  Arena a(true);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 400; ++i) {
    Client stranger = a.client();
    stranger.send("(scene robot)(nonsense)");
    stranger.arrive();
    a.cycle();
    a.cycle();
    stranger.leave();
    a.cycle();
  }
  const auto lines = std::count(a.host.text.begin(), a.host.text.end(), '\n');
  // 300 at once, and then so few per second that the duration of the test hardly matters on a fast machine.
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  REQUIRE(lines > 200);
  REQUIRE(static_cast<double>(lines) < 400 + 5 * seconds);
}

TEST_CASE("The simulation does not wait for a client that cannot answer") {
  Arena a(true);
  Client c = connect(a);
  SECTION("an idle connection") {}
  SECTION("a robot without a sync effector") {
    c.send("(scene mute)(syn)");
    firstMessages(a, c);
    c.send("(syn)");
  }
  SECTION("a robot that cannot be built") { c.send("(scene missing)(syn)"); }
  SECTION("nonsense") { c.send("(syn)(syn)(fly)"); }
  c.arrive();
  for (int i = 0; i < 40; ++i) REQUIRE(a.step());
}

TEST_CASE("The cycles in which a perceptor senses do not depend on when the client names its robot") {
  Arena a(true);
  const int hesitation = GENERATE(0, 1, 2, 3, 4, 5);
  Client c = connect(a);
  for (int i = 0; i < hesitation; ++i) REQUIRE(a.step());
  c.send("(scene robot)(syn)");
  std::string seen;
  a.until([&] {
    for (const auto& m : c.drain()) {
      seen += m.find("vision") == m.npos ? '.' : 'V';
      c.send("(syn)");
    }
    return seen.size() >= 7;
  });
  REQUIRE(seen.substr(0, 7) == "V..V..V");
}

TEST_CASE("Clients without a robot are closed after idleLimit, and others are not") {
  Arena a(true);
  Client player = connect(a), silent = connect(a), chatty = connect(a);
  player.send("(scene robot)(syn)");
  firstMessages(a, player);
  player.send("(syn)");
  a.set("idleLimit", 0.02);
  a.until([&] {
    if (!player.drain().empty()) player.send("(syn)");
    chatty.send("(hello)");
    return a.agents() == 1;
  });
  REQUIRE(silent.closed());
  REQUIRE(chatty.closed());
  REQUIRE(a.logged("it has no robot after 0.02 s"));
  REQUIRE(a.control->agents()[0]->number() == 1);
}

TEST_CASE("Idle connections do not count towards maxAgents") {
  Arena a;
  a.set("maxAgents", 2);
  std::vector<Client> idle;
  for (int i = 0; i < 10; ++i) idle.push_back(connect(a));
  Client one = connect(a), two = connect(a);
  one.send("(scene robot)");
  firstMessages(a, one);
  two.send("(scene robot)");
  firstMessages(a, two);
  idle.front().send("(scene robot)");
  REQUIRE(idle.front().closed());
  REQUIRE(a.logged("there are 2 agents already (maxAgents)"));
}

TEST_CASE("On a full port the oldest client that never sent anything is closed, and one that did is kept") {
  Arena a;
  setProperty(a.port(), "maxConnections", 3);
  setProperty(a.port(), "makeRoom", true);
  Client spoke = connect(a);
  spoke.send("(scene robot)");
  firstMessages(a, spoke);
  std::vector<Client> idle;
  for (int i = 0; i < 6; ++i) {
    idle.push_back(a.client());
    a.until([&] { return getProperty(a.port(), "connectionsSeen").toInteger() == 2 + i; });
  }
  for (int i = 0; i < 4; ++i) REQUIRE(idle[static_cast<std::size_t>(i)].closed());
  a.until([&] { return a.agents() == 3; });
  Client late = a.client();
  late.send("(scene robot)");
  firstMessages(a, late);
  spoke.drain();
  REQUIRE(firstMessages(a, spoke) > 0);
  REQUIRE(a.logged("it said nothing, and its place is needed"));
}

namespace {
/// The part of a run loop that game control uses.
class TestLoop : public Node, public ISimulation {
  SPARK_CLASS(TestLoop, Node)
 public:
  static void describe(Description<TestLoop>& d) {
    d.doc("Reports its kind of cycles.");
    d.implements<ISimulation>();
  }
  void run() override {}
  void runCycles(std::int64_t) override {}
  void stop() override {}
  double time() const override { return 0; }
  std::int64_t cycle() const override { return 0; }
  double step() const override { return 0.02; }
  bool lockstep() const override { return waits; }
  bool paced() const override { return isPaced; }
  void setPaced(bool on) override { isPaced = on; }
  bool isPaced = true, waits = false;
};

/// The number of robots after each cycle, for seven agents that request one at the same time.
std::vector<int> robotsByCycle(bool paced, bool lockstep, bool sync) {
  Arena a;
  a.kernel.registerClass<TestLoop>();
  auto& loop = a.kernel.create<TestLoop>("TestLoop", "/sys/server/simulation");
  loop.isPaced = paced;
  loop.waits = lockstep;
  a.set("loadsPerCycle", 3);
  a.set("sync", sync);
  std::vector<Client> clients;
  for (int i = 0; i < 7; ++i) {
    clients.push_back(a.client());
    clients.back().send("(scene robot)");
    clients.back().arrive();
  }
  std::vector<int> robots;
  for (int cycle = 0; cycle < 10 && (robots.empty() || robots.back() < 7); ++cycle) {
    a.cycle();
    int n = 0;
    for (AgentAspect* agent : a.control->agents()) n += agent->child("clock") != nullptr;
    if (n > 0) robots.push_back(n);
  }
  return robots;
}
}  // namespace

TEST_CASE("In real time each cycle loads at most loadsPerCycle robots, and otherwise all load at once") {
  CHECK(robotsByCycle(true, false, false) == std::vector<int>{3, 6, 7});
  CHECK(robotsByCycle(false, false, false) == std::vector<int>{7});
  CHECK(robotsByCycle(true, true, false) == std::vector<int>{7});
  CHECK(robotsByCycle(true, false, true) == std::vector<int>{7});
}

TEST_CASE("Actions that arrive before the robot is loaded are kept for the robot") {
  for (const int loads : {1, 100}) {
    actionLog().clear();
    Arena a;
    a.kernel.registerClass<TestLoop>();
    a.kernel.create("TestLoop", "/sys/server/simulation");
    a.set("loadsPerCycle", loads);
    std::vector<Client> clients;
    const auto say = [&](const std::string& message) {
      for (Client& c : clients) c.send(message), c.arrive();
    };
    for (int i = 0; i < 5; ++i) clients.push_back(a.client());
    say("(scene robot)");
    for (int cycle = 0; cycle < 3; ++cycle) a.cycle();
    say("(init (unum 1)(teamname t))");
    a.cycle();
    say("(he1 7)");
    for (int cycle = 0; cycle < 10; ++cycle) a.cycle();
    std::vector<std::string> found = actionLog(), expected;
    for (int agent = 1; agent <= 5; ++agent)
      for (const char* action : {" he1 7", " init t 1"}) expected.push_back(std::to_string(agent) + action);
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
  }
}

TEST_CASE("Robot files must be below robotFolder") {
  Arena a;
  a.set("robotFolder", "rsg/agent/");
  Client c = connect(a);
  c.send("(scene rsg/soccer/field.rsg)(scene robot)(scene ./rsg/agent/x)");
  c.arrive();
  a.cycle();
  a.cycle();
  REQUIRE(
      a.logged("agent 1 (" + c.name() + "): scene: expected a file below rsg/agent/, found 'rsg/soccer/field.rsg'"));
  // The others are of the same kind.
  REQUIRE_FALSE(a.logged("found 'robot'"));
  REQUIRE(a.control->agents()[0]->children().size() == 1);
}
