#include <catch2/catch.hpp>

#include "absence.h"
#include "stage.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a new monitor gets a full message at once, even before the first frame") {
  Stage stage;
  FakeConnection& connection = stage.connect();
  REQUIRE(connection.sent == 1);
  Replica replica;
  replica.take(connection.read());
  CHECK(replica.fulls == 1);
  CHECK(replica.lastEnv == std::vector<std::string>{"FieldLength", "time", "score"});
  REQUIRE(replica.nodes.size() == 6);
  const char* types[] = {"Light", "TRF", "TRF", "StaticMesh", "TRF", "SMN"};
  const int depths[] = {0, 0, 1, 2, 0, 1};
  for (int i = 0; i < 6; ++i) {
    CHECK(replica.nodes[i].type == types[i]);
    CHECK(replica.nodes[i].depth == depths[i]);
  }
}

TEST_CASE("every interval-th cycle sends a diff, and the diffs add up to the full scene") {
  Stage stage;
  setProperty(stage.node(), "precision", 0.0);
  FakeConnection& connection = stage.connect();
  Replica replica;
  replica.take(connection.read());
  for (int i = 0; i < 20; ++i) {
    stage.item->score = i / 5;
    stage.head->shown = i % 3 != 0;
    stage.cycle();
    CHECK(connection.idle() == (stage.cycles % 2 != 0));
    if (connection.idle()) continue;
    replica.take(connection.read());
    CHECK(same(replica, freshReplica(stage), 0));
  }
  CHECK(replica.fulls == 1);
  CHECK(replica.diffs == 10);
  setProperty(stage.node(), "interval", 1);
  stage.cycle();
  CHECK_FALSE(connection.idle());
}

TEST_CASE("a diff contains only changes") {
  Stage stage;
  FakeConnection& connection = stage.connect();
  connection.read();
  for (Transform* part : stage.parts) part->setLocalPos({0, 0, 0});
  const auto publish = [&] {
    stage.kernel.events().channel("publish").emit({"", 0, 0.02, 2, nullptr});
    return connection.read();
  };
  // The first one repeats the visibility of every mesh.
  CHECK(publish() == "((time 0))(RDS 0 1)((nd)(nd(nd(nd StaticMesh (setVisible 1))))(nd(nd SMN (setVisible 1))))");
  CHECK(publish() == "((time 0))(RDS 0 1)((nd)(nd(nd(nd StaticMesh)))(nd(nd SMN)))");
  stage.parts[1]->setLocalPos({0, 0.0049f, 0});
  stage.head->shown = false;
  stage.item->score = 2;
  CHECK(publish() == "((time 0)(score 2))(RDS 0 1)((nd)(nd(nd(nd StaticMesh (setVisible 0))))(nd(nd SMN)))");
  stage.parts[1]->setLocalPos({0, 0.0051f, 0});
  CHECK(publish() ==
        "((time 0))(RDS 0 1)((nd)(nd(nd(nd StaticMesh)))(nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0.0051 0 1)(nd SMN)))");
  stage.parts[1]->setLocalPos({0, 0.01f, 0});  // compared with the last value sent
  CHECK(publish() == "((time 0))(RDS 0 1)((nd)(nd(nd(nd StaticMesh)))(nd(nd SMN)))");
}

TEST_CASE("a full message goes to all monitors after a change of the scene and on request") {
  Stage stage;
  FakeConnection& a = stage.connect();
  FakeConnection& b = stage.connect();
  const auto fulls = [&] {
    stage.nextFrame();
    const std::string x = a.read(), y = b.read();
    const bool full = x.find("(RSG 0 1)") != std::string::npos;
    CHECK(full == (y.find("(RSG 0 1)") != std::string::npos));
    return full;
  };
  a.read(), b.read();
  CHECK_FALSE(fulls());
  stage.scene.markModified();
  CHECK(fulls());
  CHECK_FALSE(fulls());
  stage.parts[1]->create("FakeVisual", "new");
  CHECK(fulls());
  CHECK_FALSE(fulls());
  stage.kernel.create("Node", "/usr/elsewhere");  // changes the tree, but not its visible part
  CHECK_FALSE(fulls());
  stage.monitor->received(b, "(reqfullstate)");
  CHECK(fulls());
  CHECK_FALSE(fulls());
  stage.server->requestFullState();
  CHECK(fulls());
  CHECK_FALSE(fulls());
}

TEST_CASE("five monitors of different speed each get the whole scene and each event exactly once") {
  Stage stage;
  const int threads = GENERATE(1, 4);
  stage.kernel.jobs().setThreads(threads);
  const int everyNth[] = {1, 2, 3, 7, 50};
  Replica replicas[5];
  FakeConnection* clients[5];
  for (int i = 0; i < 5; ++i) replicas[i].take((clients[i] = &stage.connect())->read());
  for (int frame = 1; frame <= 200; ++frame) {
    stage.item->score = frame / 9;
    stage.head->shown = (frame / 4) % 2;
    if (frame % 11 == 0) stage.item->waiting = 1 + frame % 3;
    stage.nextFrame();
    for (int i = 0; i < 5; ++i)
      if (frame % everyNth[i] == 0) replicas[i].take(clients[i]->read());
  }
  for (int round = 0; round < 2; ++round) {  // the message being sent, then the newest
    for (int i = 0; i < 5; ++i)
      if (!clients[i]->idle()) replicas[i].take(clients[i]->read());
    if (round == 0) stage.nextFrame();
  }
  std::vector<std::string> all;
  for (int i = 1; i <= stage.item->fouls; ++i) all.push_back(std::to_string(i));
  REQUIRE(all.size() > 20);
  const Replica now = freshReplica(stage);
  for (int i = 0; i < 5; ++i) {
    INFO("client " << i);
    CHECK(replicas[i].events == all);
    CHECK(same(replicas[i], now, 0.005001));
    CHECK(replicas[i].fulls == 1);
  }
  CHECK(replicas[0].diffs == 201);
}

TEST_CASE("a monitor that never reads has one message pending, costs no more and is never closed") {
  Stage stage;
  FakeConnection& deaf = stage.connect();
  FakeConnection& good = stage.connect();
  good.read();
  for (int i = 0; i < 100; ++i) {
    stage.nextFrame();
    CHECK_FALSE(good.read().empty());
  }
  deaf.stalled = 1e6;
  stage.monitor->received(deaf, "(push 7)");
  stage.nextFrame();
  stage.nextFrame();
  CHECK(stage.trainer->pushed == std::vector<std::int64_t>{7});
  CHECK(deaf.sent == 1);
  CHECK(deaf.closes == 0);
  CHECK(good.closes == 0);
  CHECK(good.sent == 102);
  stage.monitor->disconnected(deaf);
  CHECK(getProperty(stage.node(), "clients") == Value(1));
}

TEST_CASE("a monitor that pauses gets whole messages afterwards, the current scene and the newest events") {
  Stage stage;
  FakeConnection& viewer = stage.connect();
  Replica replica;
  for (int frame = 0; frame < 30000; ++frame) {
    stage.item->score = frame;
    stage.item->waiting = 1;
    stage.nextFrame();
  }
  REQUIRE(viewer.sent == 1);
  replica.take(viewer.read());
  stage.nextFrame();
  replica.take(viewer.read());
  stage.nextFrame();
  replica.take(viewer.read());
  CHECK(same(replica, freshReplica(stage), 0.005001));
  CHECK(replica.events.back() == "30000");
  CHECK(replica.events.size() > 1000);
  CHECK(replica.events.size() < 8192 / 2);
  for (std::size_t i = 1; i < replica.events.size(); ++i)
    REQUIRE(std::stoi(replica.events[i]) == std::stoi(replica.events[i - 1]) + 1);
}

TEST_CASE("commands act in the cycle after a due one in order of arrival, and invalid ones are logged and ignored") {
  Stage stage;
  FakeConnection& a = stage.connect();
  FakeConnection& b = stage.connect();
  stage.nextFrame();
  stage.monitor->received(a, "(push 1)(push 2)");
  stage.monitor->received(b, "(init)(push 3)");
  stage.monitor->received(a, "(push 4)garbage(nosuchcommand 1 2 3)(push)()((push 9))(push 5)(unbalanced (a");
  CHECK(stage.trainer->pushed.empty());
  stage.cycle();
  CHECK(stage.trainer->pushed == std::vector<std::int64_t>{1, 2, 3, 4, 5});
  for (const char* line :
       {"command 'nosuchcommand' ignored: no trainer knows it", "command 'push' ignored: expected a number, found none",
        "from client1: expected a command in parentheses, found 'garbage'",
        "from client1: expected a command, found parentheses without a name", "from client1: 1:"}) {
    INFO(line << "\n" << stage.text);
    CHECK(count(stage.text, line) == 1);
  }
  stage.monitor->received(a, "(push 6)");
  stage.cycle();  // a frame is due, but not the commands
  CHECK(stage.trainer->pushed.size() == 5);
  stage.cycle();
  CHECK(stage.trainer->pushed.size() == 6);
  CHECK_FALSE(stage.kernel.stopRequested());
  stage.monitor->received(b, "(killsim)");
  stage.nextFrame();
  CHECK_FALSE(stage.kernel.stopRequested());
  stage.cycle();
  CHECK(stage.kernel.stopRequested());
}

TEST_CASE("a parser below the server or the port reads the commands, and that of the port takes precedence") {
  Stage stage;
  stage.kernel.registerClass<WordParser>();
  FakeConnection& a = stage.connect();
  Node& parserAt = GENERATE(0, 1) ? *stage.port : stage.node();
  parserAt.create("WordParser", "parser");
  stage.monitor->received(a, "hello");
  stage.nextFrame();
  CHECK(stage.trainer->pushed == std::vector<std::int64_t>{5});
}

TEST_CASE("commands from inside the host act like those of monitors, and their errors are returned") {
  Stage stage;
  FakeConnection& a = stage.connect();
  stage.kernel.registerClass<WordParser>();
  stage.node().create("WordParser", "parser");  // used for monitors only
  CHECK(stage.server->command("the browser", "(push 1)(push 2)") == "");
  stage.monitor->received(a, "word");
  CHECK(stage.server->command("the browser", "(push 3) (oh").starts_with("1:"));
  CHECK(stage.trainer->pushed.empty());
  stage.nextFrame();
  CHECK(stage.trainer->pushed == std::vector<std::int64_t>{1, 2, 4, 3});
  CHECK(stage.text.find("from the browser: 1:") != std::string::npos);
  std::string flood;
  for (int i = 0; i < 20000; ++i) flood += "(push 1)";
  CHECK(stage.server->command("the browser", flood).find("dropped") != std::string::npos);
}

TEST_CASE("an unknown command is answered with the nearest name, and logged once") {
  Stage stage;
  FakeConnection& a = stage.connect();
  CHECK(stage.server->command("the browser", "(pusch 3)") ==
        "");  // a trainer that does not list its commands may accept any
  stage.kernel.registerClass<ListingTrainer>();
  stage.node().create("ListingTrainer", "trainer2");
  CHECK(stage.server->command("the browser", "(pusch 3)") == "");
  stage.node().remove(*stage.node().child("trainer"));
  CHECK(stage.server->command("the browser", "(pull 1)(reqfullstate)") == "");
  CHECK(stage.server->command("the browser", "(pull 1)(pul 2)") ==
        "there is no command 'pul' here. Did you mean 'pull'?");
  CHECK(stage.server->command("the browser", "(pul 2)(pall 1)")
            .find("'pul' here. Did you mean 'pull'?; there is no "
                  "command 'pall'") != std::string::npos);
  CHECK(stage.server->command("the browser", "(killSim)") ==
        "there is no command 'killSim' here. Did you mean 'killsim'?");
  const Value text = "(pul 2)";
  CHECK_THROWS_WITH(callMethod(stage.node(), "command", std::span(&text, 1)), Catch::Contains("Did you mean 'pull'?"));
  stage.nextFrame();
  for (int i = 0; i < 400; ++i) stage.cycle();
  for (int i = 0; i < 50; ++i) stage.monitor->received(a, "(pol 2)");
  CHECK(count(stage.text, "from client1: there is no command") == 1);
  CHECK(a.sent == 1);
}

TEST_CASE("what is no command, or has more arguments than have an effect, is answered and logged once each") {
  Stage stage;
  FakeConnection& a = stage.connect();
  const auto [command, reason] = GENERATE(table<std::string, std::string>({
      {"", "expected commands in parentheses, found none"},
      {"  \n", "expected commands in parentheses, found none"},
      {"push", "expected a command in parentheses, found 'push'"},
      {"()", "expected a command, found parentheses without a name"},
      {"(reqfullstate 1 2)", "reqfullstate: expected no arguments, found 2: they are ignored"},
  }));
  INFO(command);
  stage.text.clear();
  CHECK(stage.server->command("the browser", command) == reason);
  for (int i = 0; i < 3; ++i) stage.monitor->received(a, command);
  stage.nextFrame();
  stage.nextFrame();
  INFO(stage.text);
  CHECK(count(stage.text, reason) == 1);
  CHECK(count(stage.text, "\n") == 1);
  CHECK(stage.server->command("the browser", "(init)(getAck x)(push 1)") == "");
}

TEST_CASE("a flood of mistakes is answered with some of them, and of many kinds the log has a limited number") {
  Stage stage;
  FakeConnection& a = stage.connect();
  std::string flood;
  for (int i = 0; i < 1000; ++i) flood += "x ";
  CHECK(count(stage.server->command("the browser", flood), "expected a command") == 8);
  CHECK(stage.server->command("the browser", flood).ends_with("; there are more mistakes"));
  stage.text.clear();
  for (int i = 0; i < 400; ++i) {
    stage.monitor->received(a, "(nothing" + std::to_string(i) + ")");
    if (i % 50 == 0) stage.nextFrame();
  }
  CHECK(count(stage.text, "no trainer knows it") < 200);
  CHECK(count(stage.text, "No more mistakes in commands are logged.") == 1);
}

TEST_CASE("the transforms of a frame are those of the scene") {
  Stage stage;
  stage.nextFrame();
  std::vector<Transform*> transforms;
  for (const FrameNode& node : stage.server->frame().nodes)
    if (node.kind == FrameNode::Kind::transform) transforms.push_back(node.transform);
  CHECK(transforms == std::vector<Transform*>{stage.parts[0], stage.parts[2], stage.parts[1]});
}

TEST_CASE("a flood of commands uses bounded memory") {
  Stage stage;
  FakeConnection& a = stage.connect();
  std::string flood;
  for (int i = 0; i < 10000; ++i) flood += "(push 1)";
  for (int i = 0; i < 100; ++i) stage.monitor->received(a, flood);
  stage.nextFrame();
  CHECK(stage.trainer->pushed.size() < 200000);
  CHECK(stage.trainer->pushed.size() >= 10000);
  CHECK(count(stage.text, "more commands than can wait") == 1);
  stage.monitor->received(a, "(push 7)");
  stage.nextFrame();
  CHECK(stage.trainer->pushed.back() == 7);
}

TEST_CASE("without an item the server sends the time, and without a scene or an encoder it does not fail") {
  Stage stage;
  stage.node().remove(*stage.node().child("item"));
  FakeConnection& a = stage.connect();
  a.read();
  stage.kernel.events().channel("publish").emit({"", 1.5, 0.02, 2, nullptr});
  CHECK(a.read().rfind("((time 1.5))(RDS 0 1)(", 0) == 0);

  Node& usr = stage.kernel.root().require<Node>("/usr");
  usr.remove(*usr.child("scene"));
  stage.kernel.events().channel("act").emit({"", 1.5, 0.02, 4, nullptr});
  stage.kernel.events().channel("publish").emit({"", 1.5, 0.02, 4, nullptr});
  CHECK(a.read() == "((time 1.5))(RSG 0 1)()");

  stage.node().remove(*stage.node().child("encoder"));
  stage.kernel.events().channel("publish").emit({"", 1.5, 0.02, 6, nullptr});
  CHECK(a.idle());
  CHECK(stage.text.find("/sys/server/monitor: expected an encoder below it, found none") != std::string::npos);
}
