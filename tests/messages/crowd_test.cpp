#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>

#include "message.h"
#include "recording.h"
#include "spark/predicates.h"

// Twenty-two robots in view of each other. Clients depend on three properties of the messages: a robot's messages all
// differ, none is longer than the buffer of a client, and numbers are plain decimals.

using namespace spark;
using namespace spark::test;

namespace {

constexpr std::size_t kBuffer = 8192;  ///< bytes
constexpr int kTeam = 11, kPlaced = 30, kCycles = 150;
/// Types of a team within its limits; type 4 has the largest number of joints.
constexpr int kTypes[kTeam] = {4, 4, 4, 4, 0, 0, 0, 0, 1, 1, 1};

/// The beam position of a player in its team's coordinates. Number 1 of each team sees all others from its goal line.
std::string beam(int unum) {
  if (unum == 1) return "(beam -14.5 0 0)";
  const int row = (unum - 2) / 2;
  return "(beam " + std::to_string(-2 - 1.6 * row) + " " + std::to_string((unum % 2 ? 1 : -1) * (0.9 + 0.3 * row)) +
         " 0)";
}

struct Player {
  explicit Player(unsigned short port) : client(port) {}
  Client client;
  std::string team, last;
  int unum = 0, messages = 0;
};

/// The first number of a message that is not a plain decimal; "" if there is none.
std::string numberFault(const std::string& message) {
  Predicates p;
  readSexp(message, p);
  for (const Token& t : p.tokens()) {
    if (t.kind != Token::Kind::text) continue;
    const std::string_view text = p.textOf(t);
    const std::size_t first = text.starts_with("-") ? 1 : 0;
    for (const char* const none : {"nan", "-nan", "inf", "-inf"})
      if (text == none) return std::string(text);
    if (first == text.size() || !std::isdigit(static_cast<unsigned char>(text[first]))) continue;
    if (text.find_first_not_of("0123456789.", first) != std::string_view::npos) return std::string(text);
  }
  return {};
}

int robotsIn(const std::string& see) {
  int n = 0;
  for (std::size_t at = see.find("(P "); at != std::string::npos; at = see.find("(P ", at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("A number that is no plain decimal, and a mark with other digits, are found") {
  const auto message = [](const std::string& number) { return "(HJ (n hj1) (ax " + number + "))"; };
  for (const char* const plain : {"0.00", "-1.50", "12"}) CHECK(numberFault(message(plain)) == "");
  for (const std::string bad : {"nan", "-nan", "inf", "-inf", "1e5", "-2.5e-7", "0x1"})
    CHECK(numberFault(message(bad)) == bad);
  CHECK(seeFault("(See (B (pol 1.00 2.00 3.00)))", 2) == "");
  for (const char* const bad : {"(See (B (pol 1.0 2.00 3.00)))", "(See (B (pol 1.00 nan 3.00)))",
                                "(See (X (pol 1.00 2.00 3.00)))", "(See  (B (pol 1.00 2.00 3.00)))"})
    CHECK(seeFault(bad, 2) != "");
}

TEST_CASE("Twenty-two robots in view of each other get distinct messages of bounded size with plain numbers") {
  const std::string compat = GENERATE("M", "F", "L");
  CAPTURE(compat);
  LockstepHost host({"compat=" + compat, "Soccer.BeamNoiseXY=0", "Soccer.BeamNoiseAngle=0"});
  std::vector<std::unique_ptr<Player>> players;
  host.halt(true);  // so that all join in one cycle, although they connect one after the other
  for (const char side : {'a', 'b'})
    for (int unum = 1; unum <= kTeam; ++unum) {
      players.push_back(std::make_unique<Player>(host.agentPort));
      players.back()->team = std::string(32, side);  // the maximum length of a name
      players.back()->unum = unum;
      players.back()->client.send("(scene rsg/agent/nao/nao_hetero.rsg " + std::to_string(kTypes[unum - 1]) + ")(syn)");
    }
  host.halt(false);
  std::size_t longest = 0;
  int maxRobots = 0, maxLines = 0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (const auto& p : players) {
      CAPTURE(p->team, p->unum, cycle);
      std::string message;
      try {
        message = p->client.receive();
      } catch (const boost::system::system_error&) {
        FAIL("the host closed the connection; it said:\n" << host.end());
      }
      REQUIRE(message != p->last);
      REQUIRE(message.size() <= kBuffer);
      REQUIRE(numberFault(message) == "");
      p->last = message;
      longest = std::max(longest, message.size());
      for (const std::string& e : topLevel(message)) {
        if (!e.starts_with("(See ")) continue;
        REQUIRE(seeFault(e, compat == "F" ? 3 : 2) == "");
        maxRobots = std::max(maxRobots, robotsIn(e));
        const std::vector<Item> seen = items(e);
        maxLines = std::max(maxLines, static_cast<int>(std::count_if(seen.begin(), seen.end(),
                                                                     [](const Item& i) { return i.name == "L"; })));
      }
      std::string answer = "(say 12345678901234567890)(syn)";
      if (++p->messages == 1)
        answer = "(init (unum " + std::to_string(p->unum) + ")(teamname " + p->team + "))(syn)";
      else if (p->messages <= kPlaced)
        answer = beam(p->unum) + "(syn)";
      p->client.send(answer);
    }
  }
  CHECK(maxRobots == 2 * kTeam);
  CHECK(maxLines == (compat == "F" ? 0 : 18));  // all but three that are behind the player
  CHECK(longest > 4500);                        // many robots were in view
  WARN("compat " << compat << ": the longest message had " << longest << " bytes, the most robots seen at once were "
                 << maxRobots << ", lines " << maxLines);
  players.clear();
  host.end();
}
