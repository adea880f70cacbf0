#include <catch2/catch.hpp>
#include <cmath>

#include "api/agents.h"
#include "test_support.h"

using namespace spark;

namespace {
struct SexpFixture {
  test::TestHost host;
  IParser* parser;
  SexpFixture() {
    host.kernel.plugins().use("parser-sexp");
    parser = &host.kernel.create<IParser>("SexpParser", "/usr/parser");
  }
  std::string written(const Predicates& p) {
    std::string out;
    parser->write(p, out);
    return out;
  }
};
}  // namespace

TEST_CASE("S-expressions are written in the format that existing clients expect") {
  SexpFixture f;
  Predicates p;
  p.open("time").open("now").add(7.359).close().close();
  p.open("See").close();
  p.open("HJ").open("n").add("hj1").close().open("ax").add(-0.001).close().close();
  p.open("GS").open("unum").add(3).close().open("t").add(0.0).close().close();
  REQUIRE(f.written(p) == "(time (now 7.36))(See )(HJ (n hj1) (ax -0.00))(GS (unum 3) (t 0.00))");
  SECTION("decimals are a property") {
    setProperty(*f.host.kernel.root().find("/usr/parser"), "decimals", 3);
    REQUIRE(f.written(p).starts_with("(time (now 7.359))"));
  }
}

TEST_CASE("Not-a-number and infinity are spelled as in C") {
  SexpFixture f;
  Predicates p;
  p.open("a").add(std::nan("")).add(HUGE_VAL).add(-HUGE_VAL).close();
  REQUIRE(f.written(p) == "(a nan inf -inf)");
}

TEST_CASE("A message with an error keeps what is complete before it") {
  SexpFixture f;
  const auto [text, kept] = GENERATE(table<std::string, std::string>({{"(a 1)(b 2", "(a 1)"},
                                                                      {"(a 1))(b 2)", "(a 1)"},
                                                                      {")(he1 2)", ""},
                                                                      {"(a \"x", ""},
                                                                      {"(a 1)(say ;zz)(he1 1)", "(a 1)"},
                                                                      {"(a 1)\x01(b 2)", "(a 1)"}}));
  Predicates p;
  CAPTURE(text);
  REQUIRE(!f.parser->parse(text, p).message.empty());
  REQUIRE(f.written(p) == kept);
}

TEST_CASE("200,000 nested lists are refused without harm") {
  SexpFixture f;
  Predicates p;
  const auto result = f.parser->parse("(syn)" + std::string(200000, '('), p);
  REQUIRE(result.message.find("deeper than 64") != std::string::npos);
  REQUIRE(f.written(p) == "(syn )");
}
