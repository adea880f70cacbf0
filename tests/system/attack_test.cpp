#include "attack.h"

#include "absence.h"

// Bad input to a host with a running match. After every attack a well-behaved player still sees time advance and the
// host has logged what was wrong. At the end of the test the host's memory has not grown.

using namespace spark;
using namespace spark::test;

TEST_CASE("Bytes that are not a message close their own connection and no other") {
  Arena a;
  const std::vector<std::pair<std::string, std::string>> attacks{
      {"GET / HTTP/1.1\r\n\r\n", "announces a message of"},
      {Client::prefix(0x80000000u) + "x", "2147483648"},
      {Client::prefix(0xffffffffu) + "x", "4294967295"},
      {Client::prefix(200000) + std::string(200000, '('), "200000"},
  };
  for (const auto& [bytes, complaint] : attacks) {
    Client bad(a.agentPort);
    bad.sendRaw(bytes);
    bad.waitForClose();
    a.host.waitForError(complaint);
    a.witness->mustSeeTimePass();
  }
  a.mustEndWell();
}

TEST_CASE("An incomplete message times out, and a disconnect in the middle of one is reported") {
  Arena a({"--set", "/sys/server/net/agents.messageTimeout=0.5"});
  {
    Client gone(a.agentPort);
    gone.sendRaw(Client::prefix(100) + "(scene ");
  }
  a.host.waitForError("left in the middle of a message");
  Client silent(a.agentPort);
  silent.sendRaw(Client::prefix(100) + "(scene ");
  a.witness->mustSeeTimePass();
  silent.waitForClose();
  a.host.waitForError("did not finish it within");
  a.mustEndWell();
}

TEST_CASE("Messages of length 0 are legal and ignored") {
  Arena a;
  for (int i = 0; i < 100; ++i) a.witness->client().sendRaw(Client::prefix(0));
  a.mustEndWell();
}

TEST_CASE("Deep nesting, unknown effectors, NaN and infinity cause no harm") {
  Arena a;
  for (const std::string& message :
       {std::string(60000, '('), std::string(30000, '(') + std::string(30000, ')'),
        std::string("(fly 1 2 3)(drive nan inf -inf)(drive 1e999 -1e999 nan)(kick nan nan)"),
        std::string("(beam nan inf 0)(pantilt nan nan)(say \"\x01\xff\")(say ;)"), std::string(")))((("),
        std::string(1, '\0')}) {
    Witness other(a.agentPort, "Strange", 0);
    other.client().send(message);
    other.client().send("(syn)");
    other.mustSeeTimePass();
    a.witness->mustSeeTimePass();
  }
  a.host.waitForError("fly");
  REQUIRE(lacks(a.host.errors(), "was no number", withoutNumbers()));
  a.mustEndWell();
}

TEST_CASE("A scene path that is missing, a folder, absolute or leads upwards is refused with an error that names it") {
  Arena a;
  const std::vector<std::pair<std::string, std::string>> scenes{
      {"rsg/agent/none.rsg", "no resource 'rsg/agent/none.rsg'"},
      {"rsg/agent", "found a folder"},
      {"rsg/agent/", "found a folder"},
      {"rsg/soccer/field.rsg", "expected a file below rsg/agent/"},
      {"/etc/passwd", "it is absolute"},
      {"rsg/../../../../etc/passwd", "'..'"}};
  for (const auto& [scene, complaint] : scenes) {
    Client other(a.agentPort);
    other.send("(scene " + scene + ")(syn)");
    a.host.waitForError(complaint);
    a.witness->mustSeeTimePass();
  }
  REQUIRE(lacks(a.host.errors(), "root:", textOf("/etc/passwd")));
  a.mustEndWell();
}

TEST_CASE("A 23rd player does not join a team") {
  Arena a;
  std::vector<std::unique_ptr<Witness>> players;
  for (int number = 2; number <= 11; ++number)
    players.push_back(std::make_unique<Witness>(a.agentPort, "Calm", number));
  for (int number = 1; number <= 11; ++number)
    players.push_back(std::make_unique<Witness>(a.agentPort, "Other", number));
  for (const auto& p : players) p->waitForTeam();
  for (const char* team : {"Calm", "Other", "Third"}) {
    Witness late(a.agentPort, team, 0);
    REQUIRE_FALSE(late.hasTeam(25));
  }
  a.mustEndWell();
}

TEST_CASE("Clients that connect in large numbers or disconnect at once do not increase memory use") {
  Arena a;
  const auto crowd = [&] {
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 30; ++i) clients.push_back(std::make_unique<Client>(a.agentPort));
    for (const auto& c : clients) c->send("(scene rsg/agent/sphere.rsg)(syn)");
    for (const auto& c : clients) c->receive();
    clients.clear();
    a.witness->mustSeeTimePass();
  };
  const auto visitors = [&] {
    for (int i = 0; i < 200; ++i) Client(a.agentPort).sendRaw(i % 2 ? "" : Client::prefix(3) + "(s");
    a.witness->mustSeeTimePass();
  };
  crowd();
  visitors();
  const double before = a.memory();
  for (int i = 0; i < 3; ++i) crowd(), visitors();
  a.witness->mustSeeTimePass();
  CAPTURE(before, a.memory());
  REQUIRE(a.memory() < before + 8);
  a.mustEndWell();
}

TEST_CASE("Monitors that never read stay connected and use bounded memory, and their commands take effect") {
  Arena a({"--rate", "max", "--sync"});
  std::vector<std::unique_ptr<Client>> monitors;
  for (int i = 0; i < 5; ++i) monitors.push_back(std::make_unique<Client>(a.monitorPort));
  a.witness->mustSeeTimePass();
  const double before = a.memory();
  for (int i = 0; i < 1000; ++i)
    a.witness->mustSeeTimePass();  // 100 s: far more frames than fit into the socket buffers
  CAPTURE(before, a.memory());
  REQUIRE(a.memory() < before + 16);
  // The only line about monitors reports the open port.
  REQUIRE(a.host.errors().find("monitors") == a.host.errors().rfind("monitors"));
  monitors.back()->send("(killsim)");
  REQUIRE_THROWS([&] {  // in lockstep the match ends with its next cycle
    for (;;) a.witness->mustSeeTimePass();
  }());
  REQUIRE(nlohmann::json::parse(a.host.line())["cycles"].get<int>() > 5000);
  REQUIRE(a.host.wait() == 0);
}
