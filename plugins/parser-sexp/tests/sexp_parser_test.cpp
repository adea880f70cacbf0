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

TEST_CASE("Numbers are exact at any size: clocks of days, and what is next to nothing") {
  SexpFixture f;
  const auto [text, number] = GENERATE(table<std::string, double>({{"65536.01", 65536.01},
                                                                   {"140000.01", 140000.01},
                                                                   {"16777217", 16777217.0},
                                                                   {"999999999.99", 999999999.99},
                                                                   {"-65537.03", -65537.03},
                                                                   {"0.00", 0.0},
                                                                   {"0.01", 0.01}}));
  CAPTURE(text);
  Predicates out;
  out.open("time").open("now").add(number).close().close();
  CHECK(f.written(out) == "(time (now " + (text == "16777217" ? text + ".00" : text) + "))");
  Predicates in;
  f.parser->parse("(time (now " + text + "))", in);
  CHECK((*in.begin()).at(1).at(1).number() == number);
}

TEST_CASE("Not-a-number and infinity are spelled as in C") {
  SexpFixture f;
  Predicates p;
  p.open("a").add(std::nan("")).add(HUGE_VAL).add(-HUGE_VAL).close();
  REQUIRE(f.written(p) == "(a nan inf -inf)");
}

TEST_CASE("A mistake in a message costs its predicate alone") {
  SexpFixture f;
  const auto [text, kept] = GENERATE(table<std::string, std::string>({{"(a 1)(b 2", "(a 1)"},
                                                                      {"(a 1))(b 2)", "(a 1)(b 2)"},
                                                                      {")(he1 2)", "(he1 2)"},
                                                                      {"(a \"x", ""},
                                                                      {"(a \"x)(syn)", "(syn )"},
                                                                      {"(a \x01\")\")(syn)", "(syn )"},
                                                                      {"(a 1)(say ;zz)(he1 1)", "(a 1)(he1 1)"},
                                                                      {"(a (b x\\)\x02) c)(syn)", "(syn )"},
                                                                      {"\x01 a \x02(syn)", "(syn )"},
                                                                      {"(a 1)\x01(b 2)", "(a 1)(b 2)"}}));
  Predicates p;
  CAPTURE(text);
  REQUIRE(!f.parser->parse(text, p).message.empty());
  REQUIRE(f.written(p) == kept);
}

TEST_CASE("No byte in a word takes the other predicates of its message along") {
  SexpFixture f;
  for (int c = 0; c < 256; ++c) {
    if (c == '(') continue;  // a list without its end
    const std::string message = "(first)(say a" + std::string(1, static_cast<char>(c)) + "b)(syn)";
    Predicates p;
    f.parser->parse(message, p);
    CAPTURE(c);
    std::string heads;
    for (const Element e : p) heads += std::string(e.head()) + ' ';
    CHECK(heads.starts_with("first "));
    CHECK(heads.ends_with(c == ';' ? "syn " : " syn "));
  }
}

TEST_CASE("Text in quotes is written as it is read, byte for byte") {
  SexpFixture f;
  std::string bytes;
  for (int c = 0; c < 256; ++c) bytes += static_cast<char>(c);
  for (const std::string& text : {bytes, bytes + bytes, std::string(), std::string("a b"), std::string("\"\\")}) {
    Predicates p, back;
    p.open("note").add(text, true).add("word").close();
    REQUIRE(f.parser->parse(f.written(p), back).message == "");
    REQUIRE((*back.begin()).at(1).text() == text);
    REQUIRE((*back.begin()).at(2).text() == "word");
  }
}

TEST_CASE("A message full of mistakes is given up, and takes little time") {
  SexpFixture f;
  std::string message;
  for (int i = 0; i < 20000; ++i) message += "(\x01\")\"((((";
  Predicates p;
  REQUIRE(f.parser->parse(message + "(syn)", p).message.find("0x01") != std::string::npos);
}

TEST_CASE("200,000 nested lists are refused without harm") {
  SexpFixture f;
  Predicates p;
  const auto result = f.parser->parse("(syn)" + std::string(200000, '('), p);
  REQUIRE(result.message.find("deeper than 64") != std::string::npos);
  REQUIRE(f.written(p) == "(syn )");
}
