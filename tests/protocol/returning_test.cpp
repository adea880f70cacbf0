#include <catch2/catch.hpp>

#include "arena.h"
#include "fake_scene.h"
#include "spark/state.h"

// Agents that come back to their robots after a state was loaded.

using namespace spark;
using namespace spark::test;

namespace {

/// A port that starts its agents again.
class HostPort : public Node, public IReturningAgents {
  SPARK_CLASS(HostPort, Node)
 public:
  static void describe(Description<HostPort>& d) {
    d.doc("Starts its agents again.");
    d.implements<IReturningAgents>();
  }
};

}  // namespace

TEST_CASE("An agent that its port has started again comes back to its robot, whichever other agent comes before") {
  Arena a;
  auto& server = *a.kernel.root().find<Node>("/sys/server/gamecontrol");
  server.remove(*server.child("names"));  // without names any client may go on with a robot
  a.kernel.registerClass<HostPort>();
  auto& port = a.kernel.create<HostPort>("HostPort", "/sys/server/host");
  auto& control = *server.as<IConnectionConsumer>();
  FakeConnection one(port, 1), other(port, 2), two(port, 3);
  for (FakeConnection* c : {&one, &two}) {
    control.connected(*c);
    control.received(*c, "(scene robot)");
  }
  for (int i = 0; i < 5; ++i) a.cycle();
  REQUIRE(a.agents() == 2);
  StateWriter out(true);
  saveTree(server, out);
  for (FakeConnection* c : {&one, &two}) control.disconnected(*c);
  StateReader in(out.bytes());
  loadTree(server, in);
  // The second one was lost before the state was saved; now it is a new agent.
  for (FakeConnection* c : {&one, &other, &two}) control.connected(*c);
  a.cycle();
  REQUIRE(a.agents() == 3);
  const auto programOf = [&](std::size_t agent) { return a.control->connection(*a.control->agents()[agent])->peer(); };
  CHECK(programOf(0) == "client1");
  CHECK(programOf(1) == "client3");
  CHECK(programOf(2) == "client2");
}
