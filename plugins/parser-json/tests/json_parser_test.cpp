#include <catch2/catch.hpp>
#include <cmath>

#include "api/agents.h"
#include "test_support.h"

using namespace spark;

namespace {
struct Fixture {
  test::TestHost host;
  IParser* parser;
  Fixture() {
    host.kernel.plugins().use("parser-json");
    parser = &host.kernel.create<IParser>("JsonParser", "/usr/parser");
  }
  /// The predicates read, as S-expressions.
  std::string read(std::string_view text, std::string* error = nullptr) {
    Predicates p;
    const auto result = parser->parse(text, p);
    if (error)
      *error = result.message;
    else
      CHECK(result.message == "");
    std::string out;
    writeSexp(p, 2, out);
    return out;
  }
  std::string written(const Predicates& p) {
    std::string out;
    parser->write(p, out);
    return out;
  }
};
}  // namespace

TEST_CASE("JSON mirrors the S-expressions") {
  Fixture f;
  const auto [text, same] = GENERATE(table<std::string, std::string>({
      {R"([["he1",1.2],["init",["unum",7],["teamname","A"]]])", "(he1 1.20)(init (unum 7) (teamname A))"},
      {R"(["syn"])", "(syn )"},
      {R"(["he1",1.5] ["he2",-2]["syn"])", "(he1 1.50)(he2 -2)(syn )"},
      {R"([["a"]][["b"],["c"]])", "(a )(b )(c )"},
      {"[]", ""},
      {" \n ", ""},
      {R"([["see",true,null]])", "(see true nan)"},
      {R"([["x",18446744073709551615]])", "(x 18446744073709551616.00)"},
      {R"([["say","h\u00e9"]])", "(say h\xc3\xa9)"},
  }));
  CAPTURE(text);
  REQUIRE(f.read(text) == same);
}

TEST_CASE("JSON numbers are exact at any size: clocks of days, and what is next to nothing") {
  Fixture f;
  const auto [text, number] = GENERATE(table<std::string, double>({{"65536.01", 65536.01},
                                                                   {"140000.01", 140000.01},
                                                                   {"16777217.00", 16777217.0},
                                                                   {"999999999.99", 999999999.99},
                                                                   {"-65537.03", -65537.03},
                                                                   {"0.00", 0.0},
                                                                   {"0.01", 0.01}}));
  CAPTURE(text);
  Predicates out;
  out.open("now").add(number).close();
  CHECK(f.written(out) == "[[\"now\"," + text + "]]");
  Predicates in;
  f.parser->parse("[\"now\"," + text + "]", in);
  CHECK((*in.begin()).at(1).number() == number);
}

TEST_CASE("JSON numbers give number tokens") {
  Fixture f;
  Predicates p;
  f.parser->parse(R"(["he1",1.25,7])", p);
  const Element list = *p.begin();
  REQUIRE(list.at(1).token().kind == Token::Kind::number);
  REQUIRE(list.at(1).number() == 1.25);
  REQUIRE(list.at(2).integer() == 7);
}

TEST_CASE("Invalid JSON costs its predicate and reports the reason") {
  Fixture f;
  const auto [text, kept, what] = GENERATE(table<std::string, std::string, std::string>({
      {R"(["a"]["b")", "(a )", "expected"},
      {R"([["a",1],["b",)", "(a 1)", "unexpected end"},
      {R"([["a",1],{"b":2}])", "(a 1)", "objects"},
      {R"(["a"]])", "(a )", "unexpected"},
      {R"(["a"] nonsense)", "(a )", "invalid literal"},
      {R"(["a","x)", "", "missing closing quote"},
      {"[\"a\",\"\xff\xfe\"]", "", "UTF-8"},
      {R"(["a",1e999])", "", "overflow"},
      {R"(["a",NaN])", "", "invalid literal"},
      {"[\"say\",\"\x01\"][\"syn\"]", "(syn )", "control character"},
      {R"([["a"],["say",x\y],["b"],["say",{"c":[1]}],["syn"]])", "(a )(b )(syn )", "invalid literal"},
      {R"([["say","x],["b"]]["syn"])", "(b )(syn )", "invalid literal"},
      {R"(["a"]] , nonsense ["syn"])", "(a )(syn )", "unexpected"},
  }));
  CAPTURE(text);
  std::string error;
  REQUIRE(f.read(text, &error) == kept);
  REQUIRE_THAT(error, Catch::Contains(what));
}

TEST_CASE("200,000 nested arrays are refused without harm") {
  Fixture f;
  std::string error;
  REQUIRE(f.read(R"(["syn"])" + std::string(200000, '['), &error) == "(syn )");
  REQUIRE_THAT(error, Catch::Contains("deeper than 64"));
}

TEST_CASE("JSON is compact, and numbers that JSON cannot represent are null") {
  Fixture f;
  Predicates p;
  p.open("time").open("now").add(0.3).close().close();
  p.open("See").close();
  p.open("x").add(std::nan("")).add(HUGE_VAL).add(1e300).add(-0.001).add(3).close();
  REQUIRE(f.written(p) == R"([["time",["now",0.30]],["See"],["x",null,null,null,-0.00,3]])");
  setProperty(*f.host.kernel.root().find("/usr/parser"), "decimals", -1);
  REQUIRE(f.written(p) == R"([["time",["now",0.3]],["See"],["x",null,null,1e+300,-0.001,3]])");
}

TEST_CASE("Any text is written as valid UTF-8") {
  Fixture f;
  Predicates p;
  p.open("hear").add("a\"b\\c\n").add("\xff").add("h\xc3\xa9").close();
  REQUIRE(f.written(p) == "[[\"hear\",\"a\\\"b\\\\c\\n\",\"\xef\xbf\xbd\",\"h\xc3\xa9\"]]");
}

TEST_CASE("With `binary` a text brings every byte in both directions") {
  Fixture f;
  std::string bytes, message = "[\"say\",\"";
  for (int c = 0; c < 256; ++c) {
    bytes += static_cast<char>(c);
    message += fmt::format("\\u{:04x}", c);
  }
  setProperty(*f.host.kernel.root().find("/usr/parser"), "binary", true);
  Predicates p, back;
  REQUIRE(f.parser->parse(message + "\"]", p).message == "");
  REQUIRE((*p.begin()).at(1).text() == bytes);
  REQUIRE(f.parser->parse(f.written(p), back).message == "");
  REQUIRE((*back.begin()).at(1).text() == bytes);
  std::string error;
  REQUIRE(f.read(R"([["say","\u0100"],["say","\u00ff"]])", &error) == "(say \xff)");
  REQUIRE_THAT(error, Catch::Contains("U+00FF"));
}

TEST_CASE("A JSON text stays a text whatever it looks like, and is read back as it was written") {
  Fixture f;
  const bool binary = GENERATE(false, true);
  setProperty(*f.host.kernel.root().find("/usr/parser"), "binary", binary);
  for (const std::string text : {"",     " ",         "5",        "-5",     "007",
                                 "1e5",  "1.50",      "+.5",      "0x10",   "nan",
                                 "inf",  "-infinity", "5 ",       "null",   "true",
                                 "[",    "]",         "[]",       ")(goal", "\"",
                                 "\\",   "a\tb",      ";x",       "'",      "4294967296000000000000",
                                 "word", "eight888",  "nine99999"}) {
    CAPTURE(binary, text);
    Predicates out, in, back;
    out.open("say").add(text).add(5).add(5.25).close();
    CHECK(f.parser->parse(f.written(out), in).message == "");
    const Element said = *in.begin();
    CHECK(said.at(1).text() == text);
    CHECK(said.at(1).token().quoted == (!isWord(text) || said.at(1).isNumber()));
    CHECK(said.at(2).token().kind == Token::Kind::integer);
    CHECK(said.at(3).token().kind == Token::Kind::number);
    std::string expression;
    writeSexp(in, 2, expression);
    CHECK(readSexp(expression, back).message == "");
    CHECK(back.size() == in.size());
    CHECK((*back.begin()).at(1).text() == text);
  }
}
