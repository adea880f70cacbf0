#include <cmath>

#include "absence.h"
#include "attack.h"

// Players and trainers that send messages out of order or with out-of-range values (protocol sections 1.6, 1.7, 2.2 and
// 4.5).

using namespace spark;
using namespace spark::test;

namespace {

/// An agent with a robot but no team yet.
struct Robot : Client {
  explicit Robot(const Arena& a, const std::string& file = "rsg/agent/sphere.rsg") : Client(a.agentPort) {
    send("(scene " + file + ")(syn)");
    receive();
  }
};
std::string init(const std::string& team, const std::string& unum) {
  return "(init (unum " + unum + ")(teamname " + team + "))(syn)";
}

/// The number of messages within which an accepted init would have been answered.
constexpr int kSome = 25;

/// The number that the host assigns in one of the next `messages`; 0: none. Messages that had already arrived before
/// this call are not counted, because they cannot be a reply to the last request.
std::int64_t numberIn(Client& c, int messages) {
  auto earlier = static_cast<std::ptrdiff_t>(c.waiting());
  for (int i = 0; i < messages;) {
    const std::string message = c.receive();
    i += earlier <= 0;
    earlier -= static_cast<std::ptrdiff_t>(message.size() + 4);
    Predicates p;
    readSexp(message, p);
    for (const Element e : p)
      if (const Element unum = e.named("unum"); unum && e.head() == "GS") return unum.at(1).integer();
  }
  return 0;
}
/// Sends init; returns the number that the host assigns, 0 if it refuses.
std::int64_t ask(Client& c, const std::string& team, const std::string& unum) {
  while (c.pending()) c.receive();
  c.send(init(team, unum));
  return numberIn(c, kSome);
}

/// A monitor that sends commands and waits until they have taken effect.
class Trainer {
 public:
  explicit Trainer(const Arena& a) : client_(a.monitorPort) {}
  /// Returns when a frame shows that the commands have taken effect. No frame until then may contain NaN or infinity.
  void command(const std::string& commands) {
    const std::string mark = "(score_left " + std::to_string(++mark_) + ")";
    client_.send(commands);
    client_.send("(score (left " + std::to_string(mark_) + ")(right 0))");
    for (std::string frame; frame.find(mark) == frame.npos;) {
      frame = client_.receive();
      for (const double bad : {std::nan(""), HUGE_VAL}) CHECK(lacks(frame, written(bad).substr(1), written(bad)));
    }
  }

 private:
  /// A number as it is in a message, after a blank.
  static std::string written(double number) {
    Predicates p;
    p.open("n").add(number).close();
    std::string out;
    writeSexp(p, 2, out);
    return out.substr(2, out.size() - 3);
  }
  Client client_;
  int mark_ = 0;
};

}  // namespace

TEST_CASE("An init sent before scene or in the same message is ignored and reserves no number") {
  Arena a;
  Client c(a.agentPort);
  SECTION("in a separate message") {
    c.send("(init (unum 3)(teamname Calm))");
    c.send("(scene rsg/agent/sphere.rsg)(syn)");
  }
  SECTION("in the same message") {
    c.send("(init (unum 3)(teamname Calm))(scene rsg/agent/sphere.rsg)(syn)(init (unum 3)(teamname Calm))");
  }
  REQUIRE(numberIn(c, kSome) == 0);
  Robot other(a);
  REQUIRE(ask(other, "Calm", "3") == 3);
  REQUIRE(ask(c, "Calm", "4") == 4);
  a.mustEndWell();
}

TEST_CASE("A number in use is refused to every agent, and a released number is available again") {
  Arena a;
  Robot one(a), two(a);
  REQUIRE(ask(one, "Calm", "5") == 5);
  REQUIRE(ask(two, "Calm", "5") == 0);
  REQUIRE(ask(one, "Calm", "5") == 0);  // a second init with the same data
  REQUIRE(ask(one, "Calm", "6") == 0);  // no second confirmation, but the agent has number 6 now
  REQUIRE(ask(two, "Calm", "6") == 0);
  REQUIRE(ask(two, "Calm", "5") == 5);
  {
    Robot gone(a);
    REQUIRE(ask(gone, "Calm", "11") == 11);
  }
  a.host.waitForError("leaves");
  Robot heir(a);
  REQUIRE(ask(heir, "Calm", "11") == 11);
  a.mustEndWell();
}

TEST_CASE(
    "A third team and a number out of range are refused, and 0, a word or no number gives the lowest free number") {
  Arena a;
  Robot other(a);
  REQUIRE(ask(other, "Other", "1") == 1);
  Robot c(a);
  for (const auto& [team, unum] :
       {std::pair{"Third", "1"}, {"Calm", "12"}, {"Calm", "-1"}, {"Calm", "99999999999999999999"}, {"\"\"", "2"}})
    REQUIRE(ask(c, team, unum) == 0);
  c.send(
      "(init)(init (unum))(init (unum 2))(init (teamname))(init (unum 2)(teamname (Calm)))(init (unum "
      "(2))(teamname))(syn)");
  REQUIRE(numberIn(c, kSome) == 0);
  REQUIRE(ask(c, "Calm", "0") == 2);
  Robot word(a), none(a);
  REQUIRE(ask(word, "Calm", "nan") == 3);
  none.send("(init (teamname Calm))(syn)");
  REQUIRE(numberIn(none, kSome) == 4);
  a.mustEndWell();
}

TEST_CASE("A robot is refused and takes no number when its team has the maximum of that type") {
  Arena a({}, "soccer.lua");
  const std::string heterogeneous = "rsg/agent/nao/nao_hetero.rsg ";
  std::vector<std::unique_ptr<Robot>> team;
  for (int unum = 2; unum <= 7; ++unum) {
    team.push_back(std::make_unique<Robot>(a, heterogeneous + "0"));
    REQUIRE(ask(*team.back(), "Calm", std::to_string(unum)) == unum);
  }
  // The witness is the seventh robot of type 0.
  Robot eighth(a, heterogeneous + "0");
  REQUIRE(ask(eighth, "Calm", "8") == 0);
  a.host.waitForError("robots of type 0 already");
  Robot other(a, heterogeneous + "1");
  REQUIRE(ask(other, "Calm", "8") == 8);
  REQUIRE(ask(eighth, "Else", "1") == 1);
  a.mustEndWell();
}

TEST_CASE("A killed agent loses its robot, number and connection, and may continue to send") {
  Arena a;
  Robot c(a);
  REQUIRE(ask(c, "Calm", "7") == 7);
  Trainer trainer(a);
  trainer.command("(kill (unum 7)(team Left))");
  c.waitForClose();
  for (int i = 0; i < 100; ++i) c.send("(drive 1 2 3)(say hello)(syn)");
  a.witness->mustSeeTimePass();
  Robot heir(a);
  REQUIRE(ask(heir, "Calm", "7") == 7);
  trainer.command("(kill)(kill (unum 9)(team Left))(kill (unum 7))(kill (unum 7)(team Middle))");
  trainer.command("(select (unum 7)(team Left))(kill)(kill)");
  heir.waitForClose();
  a.mustEndWell();
}

TEST_CASE(
    "Trainer commands with missing or extreme arguments do not stop the match, and no monitor gets NaN or infinity") {
  Arena a({"--set", "/sys/server/monitor.interval=1"});
  Trainer trainer(a);
  for (const char* name : {"playMode", "kickOff", "ball", "agent", "kill", "repos", "select", "time", "score",
                           "nonsense", "init", "getAck"})
    for (const char* arguments : {"", " nan", " ()", " (unum)", " (unum x)(team)", " (pos)", " (unum 99)(team Left)",
                                  " (left)(right)", " (((("})
      trainer.command("(" + std::string(name) + arguments + ")");
  trainer.command("(agent (unum 1)(team Left)(pos)(move)(battery)(temperature))(ball (pos 1)(vel))");
  for (const char* x : {"nan", "-nan", "inf", "-inf", "1e30", "-1e30", "1e308", "1e999", "x", "9e5", "-9e5"}) {
    const std::string n = x, three = " " + n + " " + n + " " + n;
    for (const std::string& command :
         {"(ball (pos" + three + "))", "(ball (vel" + three + "))", "(ball (pos" + three + ")(vel" + three + "))",
          "(agent (unum 1)(team Left)(pos" + three + "))", "(agent (unum 1)(team Left)(move" + three + " " + n + "))",
          "(agent (unum 1)(team Left)(move 0 0 1 " + n + "))", "(agent (unum 1)(team Left)(rot" + three + "))",
          "(agent (unum 1)(team Left)(battery " + n + "))", "(agent (unum 1)(team Left)(temperature " + n + "))",
          "(agent (unum " + n + ")(team Left)(pos 0 0 1))", "(select (unum " + n + ")(team Left))",
          "(score (left " + n + ")(right 0))"}) {
      trainer.command(command);
      trainer.command("(playMode PlayOn)(dropBall)(repos (unum 1)(team Left))(playMode BeforeKickOff)");
    }
    trainer.command("(time " + n + ")(time 0)");
  }
  REQUIRE(lacks(a.host.errors(), "was no number", withoutNumbers()));
  a.mustEndWell();
}

TEST_CASE("Beams to invalid positions leave the robot on the field") {
  Arena a;
  Trainer trainer(a);
  for (const char* beam :
       {"(beam 1e30 1e30 1e30)", "(beam -1e30 -1e30 -1e30)", "(beam nan nan nan)", "(beam inf -inf inf)",
        "(beam 1e999 0 1e308)", "(beam)", "(beam 1)", "(beam x y z)", "(beam (1) (2) (3))"}) {
    a.witness->client().send(beam);
    a.witness->mustSeeTimePass();
    trainer.command("");
  }
  REQUIRE(lacks(a.host.errors(), "was no number", withoutNumbers()));
  a.mustEndWell();
}

TEST_CASE("A thousand commands in one message are accepted, and a second robot is refused") {
  Arena a;
  Robot c(a);
  REQUIRE(ask(c, "Calm", "2") == 2);
  std::string thousand;
  for (int i = 0; i < 1000; ++i) thousand += "(drive " + std::to_string(i % 7) + " 0 0)";
  c.send(thousand + "(scene rsg/agent/sphere.rsg)(syn)");
  a.host.waitForError("a second one is refused");
  c.receive();
  a.mustEndWell();
}

TEST_CASE("An agent that stops answering in lockstep is closed after a timeout, and the others continue") {
  // The witness never sends (syn), because on a slow machine it could exceed the timeout of half a second, too.
  Arena a({"--sync", "--rate", "max", "--set", "/sys/server/gamecontrol.syncTimeout=0.5"}, "soccer-sphere.lua", false);
  Client silent(a.agentPort);
  silent.send("(scene rsg/agent/sphere.rsg)(syn)");
  a.host.waitForError("did not answer for 0.5 s, all others wait");
  silent.waitForClose();
  a.mustEndWell();
}

TEST_CASE("An agent in lockstep that answers and never reads does not block the match") {
  Arena a({"--sync", "--rate", "max", "--set", "/sys/server/net/agents.sendBuffer=4096"});
  Client& player = a.witness->client();
  Client deaf(a.agentPort);
  deaf.send("(scene rsg/agent/sphere.rsg)(syn)");
  for (int i = 0; i < 1000; ++i) {
    player.receive();
    player.send("(syn)");
    deaf.send("(syn)");
  }
  a.host.signal(15);
  REQUIRE(nlohmann::json::parse(a.host.line())["cycles"].get<int>() > 900);
  REQUIRE(a.host.wait() == 0);
}

TEST_CASE("Two hundred silent connections keep no other client out") {
  Arena a;
  std::vector<std::unique_ptr<Client>> idle;
  for (int i = 0; i < 200; ++i) idle.push_back(std::make_unique<Client>(a.agentPort));
  Robot c(a);
  REQUIRE(ask(c, "Calm", "2") == 2);
  for (int i = 0; i < 70; ++i) idle.push_back(std::make_unique<Client>(a.agentPort));
  REQUIRE(ask(c, "Calm", "2") == 0);  // still connected: it already has its number
  a.host.waitForError("it said nothing, and its place is needed");
  a.mustEndWell();
}

TEST_CASE("Clients that never get a robot are closed after a time limit") {
  Arena a;
  a.set("/sys/server/gamecontrol.idleLimit", "0.3");  // set now, because the witness already has its robot
  Client silent(a.agentPort), chatty(a.agentPort);
  chatty.send("(hello)(scene rsg/agent/none.rsg)");
  silent.waitForClose();
  chatty.waitForClose();
  a.host.waitForError("it has no robot after 0.3 s");
  a.mustEndWell();
}
