#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "../agent_mind.h"
#include "test_support.h"

using namespace spark;
using namespace spark::spades;
using Result = AgentMind::Result;

TEST_CASE("the recorded conversation of an agent of 2006 is the same, message for message") {
  const auto folder = test::referenceFolder();
  if (folder.empty()) std::exit(77);
  std::ifstream in(folder / "captures" / "spades" / "agent-2006.txt");
  REQUIRE(in);
  // The server of the session answered C3 to each question, and counted no think time: T251 came at 251, requested by a
  // cycle that began then.
  constexpr Time kThink = 0;
  const Latencies latencies;
  AgentMind mind(latencies);
  std::vector<Act> acts;
  Time now = 0;
  int compared = 0;
  for (std::string line; std::getline(in, line);) {
    CAPTURE(line.substr(0, 60));
    const bool toAgent = line.starts_with("-> ");
    if (!toAgent && !line.starts_with("<- ")) continue;
    std::string text = line.substr(3);
    if (!toAgent) {  // as it was printed: 'D'
      text = text.substr(1, text.size() - 2);
      const Result result = mind.take(text);
      REQUIRE((result == Result::question) == (text == "C"));
      if (result == Result::done) mind.end(kThink, acts);
    } else if (text == "C3" || text == "D" || text == "X") {
      continue;
    } else {
      if (Time sent = 0, arrives = 0; text.front() == 'S') {
        int at = 0;
        REQUIRE(std::sscanf(text.c_str(), "S%ld %ld%n", &sent, &arrives, &at) == 2);
        mind.sense(sent, text.substr(static_cast<std::size_t>(at) + 1));
      }
      std::optional<std::string> told;
      for (; !told && now < 10000; ++now) told = mind.next(now, {kThink, 0});
      --now;
      REQUIRE(told == text);
      ++compared;
    }
  }
  REQUIRE(compared == 71);
}
