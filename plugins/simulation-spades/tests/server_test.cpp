#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>

#include "../instruction_counter.h"
#include "api/agents.h"
#include "api/net.h"
#include "api/phases.h"
#include "patience.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Tells each agent the cycle in every 20th one, and notes what comes back.
class Listener : public Node, public IConnectionConsumer {
  SPARK_CLASS(Listener, Node)
 public:
  static void describe(Description<Listener>& d) {
    d.doc("Notes what agents do.");
    d.implements<IConnectionConsumer>();
    d.on<&Listener::act>(phase::kAct);
    d.on<&Listener::sense>(phase::kSense);
  }
  void connected(IConnection& c) override {
    agents.push_back(&c);
    note("+" + c.peer());
  }
  void received(IConnection& c, std::string_view message) override { note(fmt::format("{} {}", c.id() - 1, message)); }
  void disconnected(IConnection& c) override {
    std::erase(agents, &c);
    note("-" + c.peer());
  }
  void act(const Event& event) {
    for (const std::string& line : arrived) lines.push_back(fmt::format("{}: {}", event.cycle - 1, line));
    arrived.clear();
  }
  void sense(const Event& event) {
    if (event.cycle % 20 == 1)
      for (IConnection* c : agents) c->send("(Ball (pol 5 0 0))");
  }
  std::vector<IConnection*> agents;
  std::vector<std::string> lines;    ///< with the step in which they were in effect
  std::vector<std::string> arrived;  ///< since the last act phase

 private:
  void note(std::string line) { arrived.push_back(std::move(line)); }
};

struct Field {
  TemporaryFolder folder;
  TestHost host;
  Kernel& kernel = host.kernel;
  Listener* listener = nullptr;

  /// `types`: name and arguments of the test agent, for each a type.
  using Types = std::vector<std::pair<std::string, std::string>>;
  explicit Field(const Types& types, const std::string& timer = "fixed 3", const std::string& further = "") {
    kernel.registerClass<Listener>();
    for (const char* plugin : {"simulation", "simulation-spades"}) kernel.plugins().use(plugin);
    kernel.create("Simulation", "/sys/server/simulation");
    set("/sys/server/simulation", "rate", "max");
    set("/sys/server/simulation", "step", 0.01);
    listener = &kernel.create<Listener>("Listener", "/usr/listener");
    std::string xml = "<agentdb>\n";
    for (const auto& [name, arguments] : types)
      xml += fmt::format(
          "<agent_type_external name=\"{}\"><timer>{}</timer><working_dir>{}</working_dir>"
          "<exec_line>spades-agent {}</exec_line>{}</agent_type_external>\n",
          name, timer, binFolder().string(), arguments, further);
    kernel.create("SpadesServer", "/sys/server/spades");
    set("/sys/server/spades", "consumer", "/usr/listener");
    set("/sys/server/spades", "database", folder.write("agentdb.xml", xml + "</agentdb>\n"));
    set("/sys/server/spades", "logs", folder.file("logs"));
    for (const auto& [name, unused] : types) queue(name, 1);
  }
  void set(const char* path, const char* property, const Value& value) {
    setProperty(kernel.root().require<Leaf>(path), property, value);
  }
  void queue(const std::string& type, int count) {
    callMethod(kernel.root().require<Leaf>("/sys/server/spades"), "queueAgents", std::vector<Value>{type, count});
  }
  void run(int cycles) {
    callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
  }
  std::vector<std::string> linesWith(std::string_view text) const {
    std::vector<std::string> out;
    for (const std::string& line : listener->lines)
      if (line.find(text) != line.npos) out.push_back(line);
    return out;
  }
};

}  // namespace

TEST_CASE("An agent in C creates, joins and plays, each act at its simulated time") {
  Field f(Field::Types{{"spheres", "Spheres"}});
  f.run(100);
  REQUIRE(f.listener->lines == std::vector<std::string>{
                                   "0: +agent 0 (spheres)",
                                   "24: 0 (create)",
                                   "44: 0 (init (unum 0) (teamname Spheres))",
                                   "64: 0 (drive 60.00 0.00 0)",
                                   "84: 0 (drive 60.00 0.00 0)",
                               });
  std::ifstream log(f.folder.file("logs/agent0-stdout.log"));
  std::string text;
  std::getline(log, text);
  REQUIRE(text == "Spheres plays");
}

TEST_CASE("An agent is informed how long it has thought, and plays as without that") {
  const auto run = [](bool thinkTimes) {
    Field f(Field::Types{{"spheres", "Spheres"}, {"others", "Others"}});
    f.set("/sys/server/spades", "thinkTimes", thinkTimes);
    f.run(200);
    std::ifstream log(f.folder.file("logs/agent0-stdout.log"));
    std::string text;
    std::getline(log, text);
    int informed = 0;
    for (; std::getline(log, text); ++informed) REQUIRE(text == "K3");
    REQUIRE((thinkTimes ? informed >= 10 : informed == 0));
    f.set("/sys/server/spades", "thinkTimes", thinkTimes);
    REQUIRE_THROWS_WITH(f.set("/sys/server/spades", "thinkTimes", !thinkTimes),
                        Catch::Contains("its agents are started already"));
    REQUIRE(f.linesWith("(drive").size() == 14);
    return f.listener->lines;
  };
  const auto lines = run(false);
  for (int i = 0; i < 3; ++i) REQUIRE(run(true) == lines);
}

TEST_CASE("An agent that does not answer K is lost, at the step of its next act") {
  Field f(Field::Types{{"mute", "Mute mute 1"}});
  f.set("/sys/server/spades", "thinkTimes", true);
  f.set("/sys/server/spades", "mostThought", 5.0);
  f.run(60);
  CHECK(f.linesWith("(create)").size() == 1);
  CHECK_THAT(f.host.text, Catch::Contains("agent 0 (mute) is lost at step 44: it does not answer K for more than 5 s"));
}

TEST_CASE("The server has the think times and latencies of its agents, and of no other connection") {
  Field f(Field::Types{{"spheres", "Spheres"}, {"others", "Others"}});
  f.set("/sys/server/spades", "actLatency", 7);
  f.run(5);
  const auto& times = f.kernel.root().require<IAgentTimes>("/sys/server/spades");
  REQUIRE(f.listener->agents.size() == 2);
  IConnection& agent = *f.listener->agents[1];
  REQUIRE(std::isnan(times.times(agent)->last));
  f.run(60);
  const auto now = times.times(agent);
  REQUIRE(now);
  CHECK(now->last == 3);
  CHECK(now->mean == 3);
  CHECK(now->senseLatency == 10);
  CHECK(now->actLatency == 7);
  CHECK(now->dropped == 0);
  Field other(Field::Types{{"spheres", "Spheres"}});
  other.run(5);
  CHECK_FALSE(times.times(*other.listener->agents[0]));
}

TEST_CASE("Agents that misbehave are lost alone, by name and reason") {
  Field f(Field::Types{{"good", "Good"},
                       {"crashes", "Bad crash 2"},
                       {"quits", "Bad quit 2"},
                       {"garbles", "Bad garbage 2"},
                       {"forks", "Bad fork"},
                       {"hangs", "Bad hang 2"},
                       {"floods", "Bad flood 2"}});
  f.set("/sys/server/spades", "mostThought", 5.0);
  f.run(100);
  REQUIRE(f.linesWith("(drive").size() == 4);  // of good and forks
  REQUIRE(f.listener->agents.size() == 2);
  for (const char* line : {"agent 1 (crashes) is lost at step 44: its program has ended, or closed the connection",
                           "agent 2 (quits) is lost at step 44: its program has ended, or closed the connection",
                           "agent 3 (garbles) is lost at step 44: it announces a message of 4294967295 bytes",
                           "agent 5 (hangs) is lost at step 44: it thinks for more than 5 s",
                           "agent 6 (floods) is lost at step 44: it sends more than 1048576 bytes of acts"}) {
    CAPTURE(line);
    CHECK_THAT(f.host.text, Catch::Contains(line));
  }
}

TEST_CASE("The acts of an agent that ends after its thought take effect, and it is missed at the same step each time") {
  const auto run = [] {
    Field f(Field::Types{{"good", "Good"}, {"leaves", "Bad last 2"}});
    f.run(100);
    CHECK_THAT(f.host.text, Catch::Contains("agent 1 (leaves) is lost at step 64"));
    return f.listener->lines;
  };
  const std::vector<std::string> lines = run();
  CHECK(std::count(lines.begin(), lines.end(), "44: 1 (init (unum 0) (teamname Bad))") == 1);
  CHECK(std::count(lines.begin(), lines.end(), "64: -agent 1 (leaves)") == 1);
  for (int i = 0; i < 5; ++i) CHECK(run() == lines);
}

TEST_CASE("What an agent has started ends with it") {
  pollfd ends{-1, POLLIN, 0};
  {
    Field f(Field::Types{{"forks", "Bad fork"}});
    f.run(30);
    std::ifstream log(f.folder.file("logs/agent0-stdout.log"));
    pid_t child = 0;
    for (std::string word; log >> word && child == 0;)
      if (word.starts_with("child=")) child = std::stoi(word.substr(6));
    REQUIRE(child > 0);
    ends.fd = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
    REQUIRE(ends.fd >= 0);
    REQUIRE(::poll(&ends, 1, 0) == 0);  // it runs
  }
  REQUIRE(::poll(&ends, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) == 1);
  ::close(ends.fd);
}

TEST_CASE("A program made for plain TCP plays: its messages are acts, and (syn) ends its thought") {
  Field f(Field::Types{{"plain", "tcp {port}"}, {"twice", "tcp {port} twice"}}, "fixed 3", "<protocol>tcp</protocol>");
  f.run(120);
  // It is told of its second sensation first: the first is answered by what it sends after it has connected.
  const auto of = [&f](const char* agent) {
    std::vector<std::string> out;
    for (const std::string& line : f.listener->lines)
      if (line.find(agent) != line.npos && line.find('+') == line.npos) out.push_back(line);
    return out;
  };
  REQUIRE(of(": 0 ") == std::vector<std::string>{"24: 0 (scene)", "44: 0 (answer 1)", "44: 0 (syn )",
                                                 "64: 0 (answer 2)", "64: 0 (syn )", "84: 0 (answer 3)", "84: 0 (syn )",
                                                 "104: 0 (answer 4)", "104: 0 (syn )"});
  // What comes unasked waits: the answers are one sensation late from then on.
  REQUIRE(of(": 1 ") == std::vector<std::string>{"24: 1 (scene)", "44: 1 (answer 1)", "44: 1 (syn )",
                                                 "64: 1 (answer 1)", "64: 1 (syn )", "84: 1 (answer 2)", "84: 1 (syn )",
                                                 "104: 1 (answer 2)", "104: 1 (syn )"});
}

TEST_CASE("Programs made for plain TCP that misbehave are lost alone") {
  Field f(Field::Types{{"plain", "tcp {port}"},
                       {"floods", "tcp {port} flood"},
                       {"mute", "tcp {port} mute"},
                       {"leaves", "tcp {port} leave"},
                       {"empties", "tcp {port} empty"}},
          "fixed 3", "<protocol>tcp</protocol>");
  f.set("/sys/server/spades", "mostThought", 5.0);
  f.run(60);
  CHECK(f.linesWith("0 (answer").size() == 1);
  REQUIRE(f.listener->agents.size() == 1);
  CHECK_THAT(f.host.text,
             Catch::Contains("agent 1 (floods) is lost") && Catch::Contains("bytes that no percept asked for"));
  CHECK_THAT(f.host.text, Catch::Contains("agent 4 (empties) is lost"));
  CHECK_THAT(f.host.text, Catch::Contains("agent 2 (mute) is lost at step 0: it says nothing for more than 5 s"));
  CHECK_THAT(f.host.text,
             Catch::Contains("agent 3 (leaves) is lost at step 0: its program has ended without connecting"));
}

TEST_CASE("Agents of a type have latencies of their own") {
  Field f(Field::Types{{"quick", "A"}, {"slow", "B"}});
  f.kernel.create("TypeLatency", "/sys/server/spades/slow");
  f.set("/sys/server/spades/slow", "type", "slow");
  f.set("/sys/server/spades/slow", "senseLatency", 12);
  f.set("/sys/server/spades/slow", "actLatency", 5);
  f.run(30);
  REQUIRE(f.linesWith("0 (create)") == std::vector<std::string>{"24: 0 (create)"});  // 1 + 10 + 3 + 10
  REQUIRE(f.linesWith("1 (create)") == std::vector<std::string>{"21: 1 (create)"});  // 1 + 12 + 3 + 5
}

TEST_CASE("Who thinks longer acts later, and all think at the same time") {
  Field f(Field::Types{{"quick", "A burn 1"}, {"slow", "B burn 25"}}, "jiffies 10000");
  f.run(30);
  REQUIRE(f.linesWith("0 (create)") == std::vector<std::string>{"22: 0 (create)"});
  REQUIRE(f.linesWith("1 (create)") == std::vector<std::string>{"24: 1 (create)"});
}

TEST_CASE("Think time in instructions, or a start that is refused in one sentence") {
  const std::string lacks = spades::InstructionCounter::lacks();
  const auto field = [](const char* timer) { return Field(Field::Types{{"thinks", "Thinks"}}, timer); };
  if (!lacks.empty()) {
    REQUIRE_THROWS_WITH(field("instructions 1000000000"),
                        Catch::Contains("/sys/server/spades: no agents of type 'thinks': " + lacks));
    return;
  }
  Field few(Field::Types{{"thinks", "Thinks"}}, "instructions 1000000000");
  few.run(30);
  REQUIRE(few.linesWith("0 (create)") == std::vector<std::string>{"22: 0 (create)"});
  Field many(Field::Types{{"thinks", "Thinks"}}, "instructions 1");
  many.run(100);
  REQUIRE(many.linesWith("0 (create)").empty());
}

TEST_CASE("Think time that becomes one in instructions later is refused at the start, or the agent is lost") {
  const std::string lacks = spades::InstructionCounter::lacks();
  Field f(Field::Types{{"thinks", "Thinks"}}, "default");
  SECTION("before the start") {
    f.kernel.create("InstructionThinkTime", "/sys/server/spades/think");
    f.run(30);
    if (!lacks.empty())
      CHECK_THAT(f.host.text, Catch::Contains("no more agents of type 'thinks' are started: " + lacks));
  }
  SECTION("after it") {
    f.run(5);
    f.kernel.create("InstructionThinkTime", "/sys/server/spades/think");
    f.run(40);
    if (!lacks.empty()) CHECK_THAT(f.host.text, Catch::Contains("agent 0 (thinks) is lost at step 22: " + lacks));
  }
  CHECK(f.linesWith("0 (create)").size() == (lacks.empty() ? 1 : 0));
}

TEST_CASE("A database that cannot be read says where and what") {
  Field f(Field::Types{});
  const auto fails = [&](const std::string& xml) {
    try {
      f.set("/sys/server/spades", "database", f.folder.write("bad.xml", xml));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  CHECK_THAT(fails("<agentdb>\n  <agent_type_external name=\"x\">\n"), Catch::Contains("bad.xml:2:"));
  CHECK_THAT(fails("<other/>"), Catch::Contains("bad.xml:1:2: expected the element agentdb"));
  CHECK_THAT(fails("<agentdb><agent_type_external name=\"x\"/></agentdb>"), Catch::Contains("has no exec_line"));
  CHECK_THAT(fails("<agentdb><agent_type_external/></agentdb>"), Catch::Contains("expected an attribute name"));
  CHECK_THAT(fails("<agentdb><agent_type_external name=\"x\"><inputfd>1</inputfd></agent_type_external></agentdb>"),
             Catch::Contains("expected a descriptor from 3 to 255 in inputfd, found '1'"));
  CHECK_THAT(fails("<agentdb><agent_type_external name=\"x\"><inputfd>4</inputfd></agent_type_external></agentdb>"),
             Catch::Contains("expected two descriptors"));
  CHECK_THAT(fails("<agentdb><agent_type_external name=\"x\"><protocol>udp</protocol><exec_line>y</exec_line>"
                   "</agent_type_external></agentdb>"),
             Catch::Contains("expected the protocol spades or tcp, found 'udp'"));
  CHECK_THAT(fails("<agentdb><agent_type_external name=\"x\"><protocol>tcp</protocol><exec_line>y</exec_line>"
                   "</agent_type_external></agentdb>"),
             Catch::Contains("expected {port} in its exec_line"));
  REQUIRE_THROWS_WITH(f.queue("ghosts", 1), Catch::Contains("expected an agent type of the database"));
}

TEST_CASE("A program that cannot be started is an error in the log, and the others play") {
  Field f(Field::Types{{"good", "Good"}});
  f.set("/sys/server/spades", "database",
        f.folder.write("other.xml", fmt::format("<agentdb><agent_type_external name='none'><exec_line>no-such-program"
                                                "</exec_line></agent_type_external>"
                                                "<agent_type_external name='good'><timer>fixed 3</timer><working_dir>{}"
                                                "</working_dir><exec_line>spades-agent G</exec_line>"
                                                "</agent_type_external></agentdb>",
                                                binFolder().string())));
  f.queue("none", 2);
  f.queue("good", 1);
  f.run(30);
  CHECK_THAT(f.host.text, Catch::Contains("cannot start 'no-such-program'"));
  CHECK(f.linesWith(" 0 (create)").size() == 1);
  // Its id is that which it has where all can be started: with it an agent comes back to its robot.
  CHECK(f.linesWith(" 3 (create)").size() == 1);
}
