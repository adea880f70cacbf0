#include <catch2/catch.hpp>

#include "arena.h"
#include "test_consumer.h"

// Clients that write with Nagle's algorithm.

using namespace spark;
using namespace spark::test;

namespace {

/// A lockstep agent, and a client of another port that seldom gets a message, such as a trainer. It uses Nagle's
/// algorithm: what it writes may wait for an acknowledgement of what it wrote before.
struct Drill : Arena {
  TestConsumer* consumer;
  Client agent, trainer;
  Drill() : Arena(true), consumer(addTrainers()), agent(addAgent()), trainer(client("trainers")) {
    trainer.useNagle();
    cycles(2);
    consumer->events.clear();
  }
  TestConsumer* addTrainers() {
    kernel.registerClass<TestConsumer>();
    addPort("trainers");
    setProperty(port("trainers"), "consumer", "/usr/consumer");
    return &kernel.create<TestConsumer>("TestConsumer", "/usr/consumer");
  }
  Client addAgent() {
    Client c = client();
    until([&] { return agents() == 1; });
    c.send("(scene robot)(syn)");
    std::vector<std::string> got;
    until([&] { return !(got = c.drain()).empty(); });
    return c;
  }
  /// Sends the trainer a message. The system then expects more output that can carry acknowledgements, and delays them.
  void sendFrame() {
    for (IConnection* c : consumer->connections) c->send("frame");
    REQUIRE(trainer.receive());
  }
  /// Runs cycles, each after the agent's answer to the last one.
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      agent.send("(syn)");
      until([&] { return step(); }, false);
      REQUIRE(agent.receive());
    }
  }
};

}  // namespace

TEST_CASE("What a client with Nagle's algorithm writes is delivered within two cycles beside a lockstep agent") {
  const bool inTwoWrites = GENERATE(true, false);
  const int atOnce = GENERATE(1, 3, 40);
  CAPTURE(inTwoWrites, atOnce);
  Drill d;
  // Without acknowledgements nearly all rounds are late. A few may be on a busy machine, where the system itself can
  // take its time to pass bytes from one socket to the other.
  constexpr int kRounds = 40, kMaxLate = 4;
  int late = 0;
  for (int round = 1; round <= kRounds; ++round) {
    d.sendFrame();
    for (int i = 0; i < atOnce; ++i)
      if (inTwoWrites)
        d.trainer.sendInTwoWrites("(command)");
      else
        d.trainer.send("(command)");
    d.cycles(2);
    const auto expected = static_cast<std::size_t>(atOnce * round);
    late += d.consumer->events.size() < expected;
    d.until([&] { return d.consumer->events.size() == expected; }, false);
  }
  CHECK(late <= kMaxLate);
}

TEST_CASE("A lockstep agent with Nagle's algorithm may write its answer in pieces") {
  Drill d;
  d.agent.useNagle();
  // Each cycle needs several messages, and each waits for the acknowledgement of the one before. A wait is seldom
  // needed: most messages arrive in the poll that acknowledges the one before.
  constexpr int kCycles = 40, kMaxWaits = 10;
  int waits = 0;
  for (int i = 0; i < kCycles; ++i) {
    for (const char* piece : {"(he1 1)", "(he2 2)", "(syn)"}) d.agent.sendInTwoWrites(piece);
    bool done = false;
    for (int tries = 0; tries < 5 && !done; ++tries) done = d.step();
    waits += !done;
    if (!done) d.until([&] { return d.step(); }, false);
    REQUIRE(d.agent.receive());
  }
  CHECK(waits <= kMaxWaits);
}
