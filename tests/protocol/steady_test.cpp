#include <malloc.h>

#include <catch2/catch.hpp>

#include "allocations.h"
#include "arena.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Reads a number and does nothing.
class TestIdle : public Effector {
  SPARK_CLASS(TestIdle, Effector)
 public:
  static void describe(Description<TestIdle>& d) { d.doc("Reads a number."); }
  std::string predicate() const override { return "idle"; }
  std::string act(const Element& action) override {
    sum_ += action.at(1).number();
    return {};
  }

 private:
  double sum_ = 0;
};

struct Match : Arena {
  std::vector<Client> clients;
  explicit Match(int senseLatency = 1, int actLatency = 0) : Arena(true) {
    setTiming("senseLatency", senseLatency);
    setTiming("actLatency", actLatency);
    kernel.registerClass<TestIdle>();
    kernel.log().setLevel(Level::warning);
    set("expect", 4);
    for (int i = 0; i < 4; ++i) {
      clients.push_back(client());
      clients.back().send(fmt::format("(scene robot)(init (unum {})(teamname A))(syn)", i + 1));
    }
    until([&] { return agents() == 4 && control->agents()[3]->find("syn"); });
    for (AgentAspect* agent : control->agents()) agent->create("TestIdle", "idle");
    play(20);
  }
  /// Runs cycles in which every agent answers; counts only the allocations of the host.
  void play(int cycles) {
    const auto end = this->cycles() + cycles;
    until(
        [&] {
          Allocations::on = false;
          for (auto& c : clients)
            for (std::size_t n = c.drain().size(); n > 0; --n) c.send("(idle 1.5)(idle -0.25)(syn)");
          for (auto& c : clients) c.arrive();
          Allocations::on = true;
          step();
          Allocations::on = false;
          return this->cycles() >= end;
        },
        false);
  }
};

std::size_t heap() { return mallinfo2().uordblks; }
}  // namespace

TEST_CASE("A cycle with sending agents allocates nothing in steady state") {
  Match m;
  m.play(20);
  Allocations::count = 0;
  m.play(100);
  REQUIRE(Allocations::count == 0);
}

TEST_CASE("Messages with latencies allocate nothing in steady state") {
  Match m(7, 5);
  m.play(30);
  Allocations::count = 0;
  m.play(100);
  REQUIRE(Allocations::count == 0);
}

TEST_CASE("Clients that come and go leave no memory behind") {
  Arena a;
  const auto visit = [&](int n) {
    for (int i = 0; i < n; ++i) {
      Client c = a.client();
      c.send("(scene robot)garbage)((((");
      c.arrive();
      a.cycle();
      a.cycle();
      c.leave();
      a.until([&] { return a.agents() == 0; });
    }
    a.host.text.clear();
    a.host.text.shrink_to_fit();
  };
  visit(100);
  const std::size_t before = heap();
  visit(300);
  REQUIRE(heap() < before + 65536);
}

TEST_CASE("A client that never reads does not make the host grow") {
  Arena a;
  Client deaf = a.client();
  a.until([&] { return a.agents() == 1; });
  deaf.send("(scene loud)");
  a.until([&] { return a.get("messagesDropped").toInteger() > 0; });
  const std::size_t before = heap();
  for (int i = 0; i < 500; ++i) a.cycle();
  REQUIRE(a.get("messagesDropped").toInteger() > 400);
  REQUIRE(heap() < before + 65536);
}
