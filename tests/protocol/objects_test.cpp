// Objects that become agents, and objects again.
#include "api/agents.h"
#include "stadium.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Pushes what it drives along x, and counts its percepts and those with its place.
class Pusher : public Behavior {
  SPARK_CLASS(Pusher, Behavior)
 public:
  static void describe(Description<Pusher>& d) { d.doc("Pushes along x."); }
  void start(Predicates&) override {}
  void think(const Predicates& percepts, Predicates& actions) override {
    ++thoughts;
    for (const Element e : percepts)
      if (e.head() == "GPS") ++places;
    actions.open("force").add(0.2).add(0.0).add(0.0).close();
  }
  int thoughts = 0, places = 0;
};

/// Fails to start, or leaves while it thinks.
class Quitter : public Behavior {
  SPARK_CLASS(Quitter, Behavior)
 public:
  static void describe(Description<Quitter>& d) { d.doc("Fails or leaves."); }
  void start(Predicates&) override {
    ++starts;
    if (inStart) throw Error("it does not start");
  }
  void think(const Predicates&, Predicates&) override {
    parent()->remove(*this);
    throw Error("it has left");
  }
  bool inStart = false;
  int starts = 0;
};

/// Counts what it senses, and fails when it is told to.
class Counting : public Perceptor {
  SPARK_CLASS(Counting, Perceptor)
 public:
  static void describe(Description<Counting>& d) { d.doc("Counts."); }
  void sense(Predicates& out, const Event&) override {
    out.open("count").add(++count).close();
    if (fails) throw Error("it cannot sense");
  }
  void saveState(StateWriter& out) const override { out.write(std::int64_t{count}); }
  void loadState(StateReader& in) override { count = static_cast<int>(in.readInteger()); }
  int count = 0;
  bool fails = false;
};

}  // namespace

TEST_CASE("A question to a perceptor changes nothing that it remembers, whether it is answered or fails") {
  Stadium s;
  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Counting>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  auto& counting = aspect.create<Counting>("Counting", "counting");
  const auto ask = [&] { return callMethod(aspect, "sense", {}).text(); };
  counting.count = 4;
  CHECK_THAT(ask(), Catch::Contains("5"));
  CHECK(counting.count == 4);
  counting.fails = true;
  CHECK_THROWS_WITH(ask(), Catch::Contains("it cannot sense"));
  CHECK(counting.count == 4);
  counting.fails = false;
  CHECK_THAT(ask(), Catch::Contains("5"));  // the failed one is over
}

TEST_CASE("A ball becomes an agent, plays, and becomes a ball again") {
  Stadium s;
  s.join("A", 1);
  s.trainer("(playMode PlayOn)" + Stadium::ballTo(0, 0));
  s.run(10);
  const auto agents = [&] { return s.get("/sys/server/gamecontrol", "agentCount").toInteger(); };
  const double still = s.ball().x();
  REQUIRE(agents() == 1);

  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Pusher>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  aspect.create("GPS", "gps");
  aspect.create("ForceEffector", "legs");
  auto& mind = aspect.create<Pusher>("Pusher", "mind");
  s.run(50);
  CHECK(agents() == 2);
  CHECK(getProperty(aspect, "number").toInteger() == 2);
  CHECK(mind.thoughts > 40);
  CHECK(mind.places >= mind.thoughts - 3);
  CHECK(s.ball().x() > still + 0.5);

  ball.remove(aspect);
  s.run(2);
  CHECK(agents() == 1);
  s.trainer(Stadium::ballTo(0, 0));
  s.run(20);
  CHECK(std::abs(s.ball().x()) < 0.01);
  // It may become an agent again.
  Node& second = ball.create<Node>("AgentAspect", "agent");
  second.create("ForceEffector", "legs");
  auto& again = second.create<Pusher>("Pusher", "mind");
  s.run(50);
  CHECK(agents() == 2);
  CHECK(again.thoughts > 40);
  CHECK(s.ball().x() > 0.5);
}

TEST_CASE("An object whose mind is taken away is no agent, and keeps what it is made of") {
  Stadium s;
  s.join("A", 1);
  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Pusher>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  aspect.create("GPS", "gps");
  aspect.create("Pusher", "mind");
  s.run(3);
  const auto agents = [&] { return s.get("/sys/server/gamecontrol", "agentCount").toInteger(); };
  REQUIRE(agents() == 2);
  aspect.remove(*aspect.find("mind"));
  s.run(2);
  CHECK(agents() == 1);
  CHECK(getProperty(aspect, "number").toInteger() == 0);
  CHECK(aspect.find("gps") != nullptr);
  CHECK(ball.find("physics") != nullptr);
  // Another mind may come.
  auto& again = aspect.create<Pusher>("Pusher", "again");
  s.run(10);
  CHECK(agents() == 2);
  CHECK(again.places > 4);
  // An agent that is removed loses its aspect.
  callMethod(s.node("/sys/server/gamecontrol"), "removeAgent", std::vector<Value>{getProperty(aspect, "number")});
  s.run(2);
  CHECK(agents() == 1);
  CHECK(ball.find("agent") == nullptr);
}

TEST_CASE("A behavior that fails to start makes no agent, and the object keeps what it has") {
  Stadium s;
  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Quitter>();
  ball.kernel().registerClass<Pusher>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  auto& first = aspect.create<Quitter>("Quitter", "first");
  first.inStart = true;
  aspect.create("ForceEffector", "legs");
  auto& second = aspect.create<Pusher>("Pusher", "second");
  s.run(20);
  CHECK(first.starts == 1);  // not tried again
  CHECK(second.thoughts > 10);
  CHECK(s.get("/sys/server/gamecontrol", "agentCount").toInteger() == 1);
}

TEST_CASE("A behavior may remove itself while it thinks") {
  Stadium s;
  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Quitter>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  aspect.create("ForceEffector", "legs");
  aspect.create("Quitter", "mind");
  s.run(10);
  CHECK(s.get("/sys/server/gamecontrol", "agentCount").toInteger() == 0);
  CHECK(ball.find("agent") == &aspect);
}

TEST_CASE("An object without sensors thinks in every cycle, also where agents may ask for some") {
  Stadium s({{"/sys/server/gamecontrol.requests", true}});
  Node& ball = *s.node("/usr/scene/Ball").asNode();
  ball.kernel().registerClass<Pusher>();
  Node& aspect = ball.create<Node>("AgentAspect", "agent");
  aspect.create("ForceEffector", "legs");
  auto& mind = aspect.create<Pusher>("Pusher", "mind");
  s.run(20);
  CHECK(mind.thoughts > 10);
}
