#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "spark/error.h"
#include "spark/predicates.h"
#include "spark/state_stream.h"

using namespace spark;

namespace {
/// Reads and shows the tokens: lists in brackets, quoted atoms with a leading '. An error follows as "!line:column
/// message".
std::string shown(std::string_view text, ReadLimits limits = {}, std::size_t maxExpressions = 0) {
  Predicates p;
  const ReadResult r = readSexp(text, p, limits, maxExpressions);
  std::string out;
  bool first = true;
  const auto show = [&](const auto& self, const Element& e) -> void {
    if (!std::exchange(first, false)) out += ' ';
    if (!e.isList()) {
      out += e.token().quoted ? "'" + std::string(e.text()) : std::string(e.text());
      return;
    }
    out += '[';
    first = true;
    for (const Element inner : e) self(self, inner);
    first = false;
    out += ']';
  };
  for (const Element e : p) show(show, e);
  if (!r.message.empty()) out += " !" + std::to_string(r.line) + ":" + std::to_string(r.column) + " " + r.message;
  return out;
}
}  // namespace

TEST_CASE("Expressions follow each other with or without blanks between them") {
  CHECK(shown("(he1 1.2)(he2 -0.3)(syn)") == "[he1 1.2] [he2 -0.3] [syn]");
  CHECK(shown(" \t\r\n(a\n\t(b  c)\r)  ") == "[a [b c]]");
  CHECK(shown("").empty());
  CHECK(shown("()") == "[]");
  CHECK(shown("((a) b)") == "[[a] b]");
  CHECK(shown("top (x) level") == "top [x] level");
}

TEST_CASE("A comment starts where a token may start, and extends to the end of the line") {
  CHECK(shown("(say ;zz)(he1 1)") == " !1:1 the list is not closed");
  CHECK(shown("(a ; one\n b) ;; two") == "[a b]");
  CHECK(shown("(setAxis 1 0 0 ;note\n)") == "[setAxis 1 0 0]");
  CHECK(shown("(foo;bar a;)") == "[foo;bar a;]");
  CHECK(shown(";only") == "");
}

TEST_CASE("Double quotes enclose one atom and need no blanks around them") {
  CHECK(shown(R"(("NaoType["$type"]['UseToe']"))") == "['NaoType[ $type ']['UseToe']]");
  CHECK(shown(R"(("a b" c))") == "['a b c]");
  CHECK(shown(R"((a"b"c))") == "[a 'b c]");
  CHECK(shown(R"((""))") == "[']");
  CHECK(shown("(\"a\nb\")") == "['a\nb]");
  CHECK(shown(R"(("a;b)(" ))") == "['a;b)(]");
}

TEST_CASE("Single quotes begin an atom and end one") {
  CHECK(shown("('models/naohead.obj' x)") == "['models/naohead.obj x]");
  CHECK(shown("('abc)") == "['abc]");
  CHECK(shown("('a b')") == "['a b ']");
  CHECK(shown("(abc'def')") == "[abc 'def]");
  CHECK(shown("('(a (b) \"c)' d)") == "['(a (b) \"c) ' d]");
}

TEST_CASE("A backslash escapes quotes, parentheses and itself, and nothing else") {
  CHECK(shown(R"((a\(b\)c))") == "[a(b)c]");
  CHECK(shown(R"((a\"b \'c \\d))") == R"([a"b 'c \d])");
  CHECK(shown(R"(("a\"b\n"))") == R"(['a"b\n])");
  CHECK(shown("(a\\") == " !1:1 the list is not closed");
  CHECK(shown("a\\") == "a\\");
}

TEST_CASE("Atoms may contain the bytes that the installed base accepts") {
  for (int c = 1; c < 256; ++c) {
    const bool atom = c == '!' || (c >= 0x23 && c <= 0x26) || (c >= 0x2A && c <= 0x7E && c != ';') || c > 0x7F;
    if (std::string_view(" \t\r\n();\"'\\").find(static_cast<char>(c)) != std::string_view::npos) continue;
    const std::string text{'(', 'x', ' ', static_cast<char>(c), ')'};
    CAPTURE(c);
    Predicates p;
    const bool ok = readSexp(text, p).message.empty();
    CHECK(ok == atom);
    if (ok) CHECK((*p.begin()).at(1).text() == std::string_view(text).substr(3, 1));
  }
  CHECK(shown(std::string("(a \x01)")) == " !1:4 byte 0x01 is no part of an atom");
  CHECK(shown(std::string_view("(a \0b)", 6)) == " !1:4 byte 0x00 is no part of an atom");
}

TEST_CASE("A stray parenthesis ends the message, and the expressions before it are kept") {
  CHECK(shown("(a))(b)") == "[a] !1:4 ')' without '('");
  CHECK(shown(")") == " !1:1 ')' without '('");
}

TEST_CASE("In an indented file, an unclosed list is located by the indentation of the next line") {
  const auto wrong = [](std::string_view text) {
    Predicates out;
    const ReadResult r = readSexp(text, out, ReadLimits{64, 1 << 16, true});
    return fmt::format("{}:{} {}", r.line, r.column, r.message);
  };
  CHECK(wrong("(RSG 0 1)\n(\n (nd A\n  (setX 1)\n  (nd B (setY 2)\n  (nd C)\n )\n)\n") ==
        "5:3 the list is not closed: line 6 begins beside it");
  CHECK(wrong("(nd A\n  (nd B\n    (setX 1\n  (nd C))\n)") == "3:5 the list is not closed: line 4 begins beside it");
  CHECK(wrong("(nd A ; (\n  (say \"a ( \\\" ;\n\")\n  (nd B\n  (nd C))") ==
        "4:3 the list is not closed: line 5 begins beside it");
  // No location: a bare bracket whose content is below it; an error in the last line; a file without indentation.
  CHECK(wrong("(\n(nd A)\n(nd B (c)\n)") == "1:1 the list is not closed");
  CHECK(wrong("(nd A\n  (nd B)\n  (nd C (d)") == "1:1 the list is not closed");
  CHECK(wrong("(nd A\n(nd B\n(c 1)\n)\n(nd D\n(e 1)\n") == "1:1 the list is not closed");
}

TEST_CASE("An expression that is not closed is dropped, and the error says where it begins") {
  CHECK(shown("(a)\n  (b (c)") == "[a] !2:3 the list is not closed");
  CHECK(shown("(a \"bc)") == " !1:4 the string is not closed");
  CHECK(shown("(a\n '(b)") == " !1:1 the list is not closed");
  CHECK(shown("(a\n '((b)") == " !2:2 the quoted list is not closed");
}

TEST_CASE("Tokens know their line and column, counted from 1") {
  Predicates p;
  REQUIRE(readSexp("(a \"b\"\n  (c)\n)", p).message.empty());
  std::vector<std::pair<int, int>> at;
  for (std::uint32_t i = 0; i < p.size(); ++i) at.emplace_back(Element(p, i).line(), Element(p, i).column());
  CHECK(at == std::vector<std::pair<int, int>>{{1, 1}, {1, 2}, {1, 4}, {2, 3}, {2, 4}});
}

TEST_CASE("Reading stops after the requested number of expressions") {
  CHECK(shown("(a)(b)))", {}, 2) == "[a] [b]");
  Predicates p;
  CHECK(readSexp("(a) (b) (c)", p, {}, 2).consumed == 7);
  CHECK(readSexp("x (b)", p, {}, 1).consumed == 1);
}

TEST_CASE("The depth and the number of tokens are limited") {
  CHECK(shown("(((a)))", {3, 100}) == "[[[a]]]");
  CHECK(shown("(x)((((a))))", {3, 100}) == "[x] !1:7 lists nested deeper than 3");
  CHECK(shown("(a b)", {3, 3}) == "[a b]");
  CHECK(shown("(a b c)", {3, 3}) == " !1:6 more than 3 tokens");
}

TEST_CASE("200000 nested parentheses are refused at the depth limit, and read if the limit allows them") {
  const std::string deep(200000, '(');
  CHECK(shown(deep) == " !1:65 lists nested deeper than 64");
  Predicates p;
  const ReadResult r = readSexp(deep + std::string(200000, ')'), p, {300000, 300000});
  CHECK(r.message.empty());
  CHECK(p.size() == 200000);
  CHECK(p.tokens()[0].size == 200000);
}

TEST_CASE("Reading appends, and an error removes only the faulty expression") {
  Predicates p;
  p.open("before").add(1).close();
  CHECK_FALSE(readSexp("(ok)(bad (x", p).message.empty());
  std::string out;
  writeSexp(p, 2, out);
  CHECK(out == "(before 1)(ok )");
}

TEST_CASE("Numbers are read from text as in C") {
  Predicates p;
  readSexp("(1e-3 +2 0x10 nan inf abc 12abc -0 () -3.9)", p);
  const Element e = *p.begin();
  CHECK(e.at(0).number() == 1e-3);
  CHECK(e.at(1).number() == 2);
  CHECK(e.at(2).number() == 16);
  CHECK(std::isnan(e.at(3).number()));
  CHECK(e.at(3).integer() == 0);
  CHECK(std::isinf(e.at(4).number()));
  CHECK(e.at(4).integer() == std::numeric_limits<std::int64_t>::max());
  CHECK(e.at(5).number() == 0);
  CHECK(e.at(6).number() == 12);
  CHECK(std::signbit(e.at(7).number()));
  CHECK(e.at(8).number() == 0);
  CHECK(e.at(9).integer() == -3);
  CHECK_FALSE(e.at(10));
  Predicates longNumber;
  readSexp("1" + std::string(100, '0'), longNumber);
  CHECK((*longNumber.begin()).number() == 1e100);
}

TEST_CASE("An element knows whether it is a number") {
  Predicates p;
  REQUIRE(readSexp("(he1 1.5 abc 1.5x (2) \"3\")", p).message.empty());
  const Element action = *p.begin();
  CHECK(action.at(1).asNumber() == 1.5);
  CHECK_FALSE(action.at(2).isNumber());
  CHECK_FALSE(action.at(3).isNumber());
  CHECK_FALSE(action.at(4).isNumber());
  CHECK(action.at(5).asNumber() == 3);
  CHECK_FALSE(action.at(6).isNumber());
  Predicates written;
  written.open("x").add(2.5).add(7).close();
  CHECK((*written.begin()).at(1).asNumber() == 2.5);
  CHECK((*written.begin()).at(2).asNumber() == 7);
}

TEST_CASE("balance closes open lists, and the next list starts at the top level") {
  Predicates p;
  p.open("GYR").open("rt").add(1);
  CHECK(p.isUnbalanced());
  CHECK(p.balance() == 2);
  CHECK_FALSE(p.isUnbalanced());
  p.open("HJ").pair("n", "hj1").close();
  CHECK(p.balance() == 0);
  std::string text;
  writeSexp(p, 2, text);
  CHECK(text == "(GYR (rt 1))(HJ (n hj1))");
  p.open("ACC").close().close();
  CHECK(p.isUnbalanced());
  CHECK(p.balance() == -1);
  CHECK(p.balance() == 0);
}

TEST_CASE("A named parameter is the first sub-list with that name and a value") {
  Predicates p;
  readSexp("(init (unum) unum (x 1) (unum 7 8) (unum 9) (teamname \"A B\"))", p);
  const Element e = *p.begin();
  CHECK(e.head() == "init");
  CHECK(e.named("unum").at(1).integer() == 7);
  CHECK(e.named("teamname").at(1).text() == "A B");
  CHECK_FALSE(e.named("nothing"));
  CHECK(e.size() == 7);
}

TEST_CASE("Messages are written as the installed base expects them") {
  Predicates p;
  p.open("See").close();
  p.open("time").open("now").add(12.345).close().close();
  p.open("GYR").open("n").add("torso").close().open("rt").add(0.0).add(-0.001).add(-1.005).close().close();
  p.open("GS").pair("sl", 3).pair("pm", "BeforeKickOff").close();
  p.open("empty").open("inner").close().close();
  p.open("raw").add("two words").close();
  p.open("quoted").add("two words", true).close();
  std::string out;
  writeSexp(p, 2, out);
  CHECK(out ==
        "(See )(time (now 12.35))(GYR (n torso) (rt 0.00 -0.00 -1.00))(GS (sl 3) (pm BeforeKickOff))(empty "
        "(inner))(raw two words)(quoted \"two words\")");
  out.clear();
  Predicates three;
  three.open("a").add(1.0f / 3.0).close();
  writeSexp(three, 3, out);
  CHECK(out == "(a 0.333)");
}

TEST_CASE("Numbers with fixed decimals look like those that C prints") {
  const auto text = [](double v, int decimals, DoubleRange doubles = {}) {
    std::string out;
    appendFixed(out, v, decimals, doubles);
    return out;
  };
  CHECK(text(-0.0, 2) == "-0.00");
  CHECK(text(-0.004, 2) == "-0.00");
  CHECK(text(1e6, 2) == "1000000.00");
  CHECK(text(0.1, 9) == "0.100000001");
  CHECK(text(0.1, 9, kAllDouble) == "0.100000000");
  CHECK(text(std::nan(""), 2) == "nan");
  CHECK(text(-std::nan(""), 2) == "nan");
  CHECK(text(300000.02, 2) == "300000.03");  // single precision
  CHECK(text(300000.02, 2, {300000, 300001}) == "300000.02");
  CHECK(text(299999.98, 2, {300000, 300001}) == "299999.97");
  CHECK(text(300001.04, 2, {300000, 300001.04}) == "300001.03");
  CHECK(text(-std::numeric_limits<double>::infinity(), 2) == "-inf");
  CHECK(text(1e308, 2) == "inf");
  CHECK(text(1e308, 1000, kAllDouble).size() == 309 + 1 + 60);
}

TEST_CASE("Predicates can be copied, truncated and reused") {
  Predicates p;
  readSexp("(a (b 1) \"c d\")(e)", p);
  Predicates copy;
  copy.append(*p.begin());
  std::string out;
  writeSexp(copy, 2, out);
  CHECK(out == "(a (b 1) \"c d\")");
  CHECK(copy.tokens()[5].quoted);
  p.truncate(0);
  CHECK(p.empty());
  readSexp("(x)", p);
  CHECK((*p.begin()).head() == "x");
  p.clear();
  CHECK(p.size() == 0);
}

TEST_CASE("Truncating keeps the expressions that were read before") {
  Predicates p;
  readSexp("(kept-and-longer-than-eight)", p);
  const auto size = static_cast<std::uint32_t>(p.size());
  for (const char* rest :
       {"(abcdefgh as-long-as-the-first-one-was)", "(1 2 3 4 5 6 7 8 9 0 as-long-as-the-first-one-was)", "(a)"}) {
    readSexp(rest, p);
    p.truncate(size);
    readSexp("(new-and-longer-than-eight)", p);
    CHECK((*p.begin()).head() == "kept-and-longer-than-eight");
    p.truncate(size);
  }
}

TEST_CASE("An atom can be replaced by a number, and its neighbours stay as they are") {
  Predicates p;
  readSexp("(speed \"a long text as an argument\" (and another 1.5))(next)", p);
  const Element speed = *p.begin();
  p.set(speed.at(1).index(), 0.25);
  p.set(speed.at(2).at(2).index(), std::int64_t(-3));
  CHECK(speed.at(1).number() == 0.25);
  CHECK(speed.at(2).at(2).token().kind == Token::Kind::integer);
  std::string text;
  writeSexp(p, 2, text);
  CHECK(text == "(speed 0.25 (and another -3))(next )");
}

TEST_CASE("Predicates are saved as the values that they are, and loaded") {
  Predicates p;
  readSexp("(a (b 1) () a-text-of-more-than-a-few-letters) atom ()", p);
  p.open("n").add(-2.5).add(3).add(std::int64_t{1} << 60).close();
  const auto saved = [](auto... write) {
    StateWriter out(true);
    (write(out), ...);
    return std::pair(out.bytes(), out.hash());
  };
  const auto direct = saved([&](StateWriter& out) { savePredicates(p, out); });
  CHECK(direct == saved([&](StateWriter& out) { out.write(Value(toList(p))); }));
  Predicates back;
  back.add("before");
  StateReader in(direct.first);
  loadPredicates(in, back);
  CHECK(in.atEnd());
  CHECK(Value(toList(back)) == Value(toList(p)));
  StateReader early(std::string_view(direct.first).substr(0, 40));
  CHECK_THROWS_AS(loadPredicates(early, back), Error);
}

TEST_CASE("A text in quotes is one in quotes after it was saved and loaded, and no other is") {
  Predicates p, back;
  readSexp("(a \"5\" 5 (\"b c\"))", p);
  p.open("d").add("raw text").close();
  StateWriter out(true);
  savePredicates(p, out);
  const std::string bytes = out.bytes();
  StateReader in(bytes);
  loadPredicates(in, back);
  std::string text;
  writeSexp(back, 2, text);
  CHECK(text == "(a \"5\" 5 (\"b c\"))(d raw text)");
}

TEST_CASE("Values that are no words are written in quotes") {
  Predicates p;
  append(List{List{"a", "b c", "", "(", "x;y", "word"}}, p);
  std::string out;
  writeSexp(p, 2, out);
  CHECK(out == "(a \"b c\" \"\" \"(\" \"x;y\" word)");
}

TEST_CASE("Predicates can be converted to values and back") {
  Predicates p;
  readSexp("(a (b 1))", p);
  p.open("n").add(2.5).add(3).close();
  const List values = toList(p);
  CHECK(Value(values) == Value(List{List{"a", List{"b", "1"}}, List{"n", 2.5, 3}}));
  Predicates back;
  append(values, back);
  append(List{List{true, Value()}}, back);
  std::string out;
  writeSexp(back, 2, out);
  CHECK(out == "(a (b 1))(n 2.50 3)(true nil)");
}
