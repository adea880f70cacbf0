#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "spark/predicates.h"
#include "test_support.h"

// The league of the Nao V4: its field, its robot and its percepts.

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// The list with this head, and with this `name` if one is given; throws if there is none.
Element find(const Predicates& message, std::string_view head, std::string_view name = {}) {
  for (const Element e : message)
    if (e.head() == head &&
        (name.empty() || (e.named("n") && e.named("n").at(1).text() == name) || e.at(1).text() == name))
      return e;
  throw std::runtime_error("the message has no " + std::string(head) + " " + std::string(name));
}

}  // namespace

TEST_CASE("A Nao V4 joins soccer-spl.lua, drives its motors, and receives its percepts") {
  Process host(joined({(binFolder() / "sparkhost").string(), "--config", "soccer-spl.lua", "--sync", "--rate", "max",
                       "--agent-port", "0", "--monitor-port", "0", "--log-level", "error"},
                      withoutLimits()));
  const Json ports = Json::parse(host.line());
  Client monitor(ports["monitorPort"].get<unsigned short>());
  CHECK_THAT(monitor.receive(),
             Contains("(FieldLength 9)(FieldWidth 6)") && Contains("(GoalWidth 1.5)") && Contains("(BallRadius 0.05)"));

  Client agent(ports["agentPort"].get<unsigned short>());
  agent.send("(scene rsg/agent/naov4/nao.rsg)(syn)");
  std::string text = agent.receive();
  CHECK_THAT(text, Contains("(HJ (n hj1) (ax ") && Contains("(tp 20.000))"));
  agent.send("(init (unum 1)(teamname Spl))(syn)");
  bool battery = false, sonar = false, cameras = false;
  for (int cycle = 0; cycle < 60; ++cycle) {
    text = agent.receive();
    battery |= text.find("(BAT 1.000)") != text.npos;
    sonar |= text.find("(US Left (") != text.npos && text.find("(US Right (") != text.npos;
    cameras |= text.find("(TopCamera ") != text.npos && text.find("(BottomCamera ") != text.npos;
    agent.send("(he1 0.5)(syn)");
  }
  CHECK(battery);
  CHECK(sonar);
  CHECK(cameras);
  Predicates message;
  readSexp(agent.receive(), message);
  CHECK(find(message, "HJ", "hj1").named("ax").at(1).number() == Approx(0.5 * 59 * 0.02 * 180 / 3.14159265).margin(2));
  CHECK(find(message, "GPS", "torso").named("tf").size() == 17);
  CHECK(find(message, "GPS", "head").named("tf").size() == 17);
  CHECK(find(message, "GPS", "torso").named("tf").at(12).number() == Approx(0.36).margin(0.03));  // it is upright
  CHECK(find(message, "FRP", "rf").named("f").at(3).number() > 10);
  host.signal(15);
  host.line();
  CHECK(host.wait() == 0);
  CHECK(host.errors() == "");
}
