#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>

#include "message.h"
#include "recording.h"
#include "spark/predicates.h"

// Twenty-two robots in view of each other. Clients judge servers by what arrives: a robot's messages all differ, none
// is longer than the buffer into which clients read, and numbers are plain.

using namespace spark;
using namespace spark::test;

namespace {

constexpr std::size_t kBuffer = 8192;  ///< bytes
constexpr int kTeam = 11, kPlaced = 30, kCycles = 150;
/// Types of a team within its limits; 4 has the most joints.
constexpr int kTypes[kTeam] = {4, 4, 4, 4, 0, 0, 0, 0, 1, 1, 1};

/// Where a player stands, as his team sees the field. Number 1 of each team looks at all others from his goal line.
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

/// What is wrong with the numbers of a message.
std::string numberFault(const std::string& message) {
  Predicates p;
  readSexp(message, p);
  for (const Token& t : p.tokens()) {
    if (t.kind != Token::Kind::text) continue;
    const std::string_view text = p.textOf(t);
    const std::size_t first = text.starts_with("-") ? 1 : 0;
    if (text == "inf" || text == "-inf" || text == "-nan") return std::string(text);
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

TEST_CASE("Of twenty-two robots in view of each other none is told anything twice, too much or in odd numbers") {
  const std::string compat = GENERATE("M", "F", "L");
  CAPTURE(compat);
  LockstepHost host({"compat=" + compat, "Soccer.BeamNoiseXY=0", "Soccer.BeamNoiseAngle=0"});
  std::vector<std::unique_ptr<Player>> players;
  host.halt(true);  // all join in one cycle: here each is read in turn
  for (const char side : {'a', 'b'})
    for (int unum = 1; unum <= kTeam; ++unum) {
      players.push_back(std::make_unique<Player>(host.agentPort));
      players.back()->team = std::string(32, side);  // the longest name
      players.back()->unum = unum;
      players.back()->client.send("(scene rsg/agent/nao/nao_hetero.rsg " + std::to_string(kTypes[unum - 1]) + ")(syn)");
    }
  host.halt(false);
  std::size_t longest = 0;
  int mostRobots = 0, mostLines = 0;
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
        mostRobots = std::max(mostRobots, robotsIn(e));
        const std::vector<Item> seen = items(e);
        mostLines = std::max(mostLines, static_cast<int>(std::count_if(seen.begin(), seen.end(),
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
  CHECK(mostRobots == 2 * kTeam);
  CHECK(mostLines == (compat == "F" ? 0 : 18));  // all but three behind him
  CHECK(longest > 4500);                         // it was a crowd
  WARN("compat " << compat << ": the longest message had " << longest << " bytes, the most robots seen at once were "
                 << mostRobots << ", lines " << mostLines);
  players.clear();
  host.end();
}
