#include "sweep.h"

#include <catch2/catch.hpp>
#include <set>

using namespace sparkbatch;
using Texts = std::vector<std::string>;

TEST_CASE("Values are separated by commas outside brackets and quotes") {
  REQUIRE(splitValues("60,120") == Texts{"60", "120"});
  REQUIRE(splitValues("one") == Texts{"one"});
  REQUIRE(splitValues("{0,0,-9.81},{0,0,-1.6}") == Texts{"{0,0,-9.81}", "{0,0,-1.6}"});
  REQUIRE(splitValues("\"a,b\",'c,d',[1,[2,3]]") == Texts{"\"a,b\"", "'c,d'", "[1,[2,3]]"});
  REQUIRE(splitValues("a,,b") == Texts{"a", "", "b"});
}

TEST_CASE("A batch without a sweep has one run per seed") {
  const Sweep sweep({}, 7, 3);
  REQUIRE(sweep.points() == 1);
  REQUIRE(sweep.runs() == 3);
  for (int n = 1; n <= 3; ++n) {
    REQUIRE(sweep.run(n).number == n);
    REQUIRE(sweep.run(n).seed == static_cast<std::uint64_t>(6 + n));
    REQUIRE(sweep.run(n).point.empty());
  }
}

TEST_CASE("Every combination runs with every seed, ordered by seed") {
  const Sweep sweep({{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}}, 5, 2);
  REQUIRE(sweep.points() == 6);
  REQUIRE(sweep.runs() == 12);
  const Run second = sweep.run(2), seventh = sweep.run(7), last = sweep.run(12);
  REQUIRE(second.seed == 5);
  REQUIRE(second.point == decltype(second.point){{"a", "1"}, {"b", "y"}});
  REQUIRE(seventh.seed == 6);
  REQUIRE(seventh.point == decltype(seventh.point){{"a", "1"}, {"b", "x"}});
  REQUIRE(last.point == decltype(last.point){{"a", "2"}, {"b", "z"}});
  std::set<std::pair<std::uint64_t, decltype(last.point)>> all;
  for (int n = 1; n <= 12; ++n) all.emplace(sweep.run(n).seed, sweep.run(n).point);
  REQUIRE(all.size() == 12);
}

TEST_CASE("More seeds do not change the numbers of the runs") {
  const std::vector<Parameter> parameters{{"a", {"1", "2"}}};
  const Sweep few(parameters, 1, 2), many(parameters, 1, 9);
  for (int n = 1; n <= few.runs(); ++n) {
    REQUIRE(few.run(n).seed == many.run(n).seed);
    REQUIRE(few.run(n).point == many.run(n).point);
  }
}
