#include "spark/value.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "spark/error.h"

using spark::Args;
using spark::Convert;
using spark::Error;
using spark::List;
using spark::Value;

namespace {
template <class T>
T from(const Value& v, bool loose = false) {
  Args args{std::span(&v, 1), loose};
  return Convert<T>::from(args);
}
}  // namespace

TEST_CASE("A value knows its type") {
  CHECK(Value().isNil());
  CHECK(Value(true).isBool());
  CHECK(Value(3).isInteger());
  CHECK(Value(3u).isInteger());
  CHECK(Value(3.0).type() == Value::Type::number);
  CHECK(Value(3).isNumber());
  CHECK(Value("a").isString());
  CHECK(Value(List{1, 2}).isList());
  CHECK(typeName(Value(List{}).type()) == "list");
  CHECK(typeName(Value().type()) == "nil");
}

TEST_CASE("Values of different types differ, also integers and numbers") {
  CHECK(Value(3) == Value(3));
  CHECK(Value(3) != Value(3.0));
  CHECK(Value("true") != Value(true));
  CHECK(Value(List{1, "a"}) == Value(List{1, "a"}));
}

TEST_CASE("The text of a value shows its type") {
  CHECK(Value().text() == "nil");
  CHECK(Value(false).text() == "false");
  CHECK(Value(-3).text() == "-3");
  CHECK(Value(3.0).text() == "3.0");
  CHECK(Value(0.1).text() == "0.1");
  CHECK(Value(1e22).text() == "1e+22");
  CHECK(Value("a b").text() == "\"a b\"");
  CHECK(Value("a b").plain() == "a b");
  CHECK(Value(List{1, List{2.5, "x"}}).text() == "{1, {2.5, \"x\"}}");
  CHECK(Value(-std::numeric_limits<double>::infinity()).text() == "-inf");
  CHECK(Value(std::nan("")).text() == "nan");
}

TEST_CASE("Numbers are unchanged when read back from their text") {
  for (const double d : {0.1, -0.0, 1.0 / 3.0, 1e-310, 1.7976931348623157e308, 4503599627370497.5}) {
    const Value back = Value::fromText(Value(d).text());
    REQUIRE(back.type() == Value::Type::number);
    CHECK(std::signbit(back.toNumber()) == std::signbit(d));
    CHECK(back.toNumber() == d);
  }
  CHECK(Value::fromText("9223372036854775807").toInteger() == std::numeric_limits<std::int64_t>::max());
}

TEST_CASE("A text becomes the value that it looks like") {
  CHECK(Value::fromText("true") == Value(true));
  CHECK(Value::fromText("nil").isNil());
  CHECK(Value::fromText("+5") == Value(5));
  CHECK(Value::fromText("+-5") == Value("+-5"));
  CHECK(Value::fromText("-5e-3") == Value(-5e-3));
  CHECK(Value::fromText("JsonParser") == Value("JsonParser"));
  CHECK(Value::fromText("'5'") == Value("5"));
  CHECK(Value::fromText("{1, 2.0, x}") == Value(List{1, 2.0, "x"}));
  CHECK(Value::fromText("[ 1 2 [3] ]") == Value(List{1, 2, List{3}}));
  CHECK(Value::fromText("{\"a b\", 'c'}") == Value(List{"a b", "c"}));
  CHECK(Value::fromText("{}") == Value(List{}));
  CHECK(Value::fromText("").isString());
}

TEST_CASE("A typed-in text is converted when the expected type is known") {
  const auto read = [](const char* text, const char* type) { return Value::typed(text).readAs(type); };
  for (const char* text :
       {"007", "1e3", "0123456789012345678", "12345678901234567890", "nil", "true", "{a, b}", " x ", ""}) {
    CAPTURE(text);
    CHECK(read(text, "string") == Value(text));
    CHECK(read(text, "number") == Value::fromText(text));
    CHECK(read(text, "") == Value::fromText(text));
  }
  CHECK(read("'5'", "string") == Value("5"));
  CHECK(read("\"a b\"", "string") == Value("a b"));
  CHECK(read("'a' and 'b'", "string") == Value("'a' and 'b'"));
  CHECK(read("'", "string") == Value("'"));
  CHECK(read("{007, true, 'a b'}", "list of string") == Value(List{"007", "true", "a b"}));
  CHECK(read("007", "list of string") == Value("007"));
  CHECK(Value(7).readAs("string") == Value(7));
  const Value typed = Value::typed("12");
  CHECK((typed.isTyped() && typed.isString() && !typed.isNumber()));
  CHECK(typed.toString() == "12");
  CHECK(typed.plain() == "12");
  CHECK_FALSE(Value("12").isTyped());
}

TEST_CASE("A malformed list is read as a string") {
  for (const char* text : {"[1}", "{1]", "{", "{1", "[[1]", "{,}", "{1} x", "[}", "{{{{"}) {
    CAPTURE(text);
    CHECK(Value::fromText(text) == Value(text));
  }
  CHECK(Value::fromText(std::string(100000, '[')).isString());
}

TEST_CASE("Lists of pairs are tables") {
  const Value table(List{List{"a", 1}, List{"b", List{2}}, "odd", List{3, 4}});
  REQUIRE(table.at("a"));
  CHECK(*table.at("a") == Value(1));
  CHECK(table.at("b")->isList());
  CHECK(table.at("c") == nullptr);
  CHECK(*table.at(2) == Value("odd"));
  CHECK(table.at(4) == nullptr);
  CHECK(Value(1).at("a") == nullptr);
  CHECK(Value(1).at(0) == nullptr);
}

TEST_CASE("Strict conversions accept exact values and refuse the rest") {
  CHECK(from<double>(3) == 3.0);
  CHECK(from<double>("2.5") == 2.5);
  CHECK(from<double>(List{7}) == 7.0);
  CHECK(from<int>(3.0) == 3);
  CHECK(from<bool>("true"));
  CHECK(from<bool>(1));
  CHECK(from<std::string>(3) == "3");
  CHECK(from<std::string>(true) == "true");
  CHECK_THROWS_WITH(from<double>("garbage"), Catch::Contains("expected number") && Catch::Contains("garbage"));
  CHECK_THROWS_AS(from<double>(Value()), Error);
  CHECK_THROWS_AS(from<double>(List{1, 2}), Error);
  CHECK_THROWS_AS(from<double>(true), Error);
  CHECK_THROWS_WITH(from<int>(2.5), Catch::Contains("expected an integer"));
  CHECK_THROWS_AS(from<int>(std::nan("")), Error);
  CHECK_THROWS_AS(from<int>(3e9), Error);
  CHECK_THROWS_AS(from<int>(std::int64_t{1} << 40), Error);
  CHECK_THROWS_WITH(from<bool>("1"), Catch::Contains("true or false"));
  CHECK_THROWS_AS(from<bool>(2), Error);
  CHECK_THROWS_AS(from<std::string>(List{1, 2}), Error);
}

TEST_CASE("Loose conversions read numbers as the installed base does") {
  CHECK(from<double>("garbage", true) == 0);
  CHECK(from<double>("true", true) == 0);
  CHECK(from<double>("+1.5", true) == 1.5);
  CHECK(from<double>("5e-3x", true) == double(5e-3f));
  CHECK(from<int>("60.9", true) == 60);
  CHECK(from<int>(1e12, true) == std::numeric_limits<int>::max());
  CHECK(from<int>(-1e12, true) == std::numeric_limits<int>::min());
  CHECK(from<int>("nan", true) == 0);
  CHECK_THROWS_AS(from<bool>("1", true), Error);
}

TEST_CASE("64-bit integers keep all bits") {
  const std::uint64_t all = ~std::uint64_t{0};
  CHECK(from<std::uint64_t>(Convert<std::uint64_t>::to(all)) == all);
  CHECK_THROWS_AS(from<std::uint64_t>(-1.0), Error);
}

TEST_CASE("A list parameter takes one list or all remaining arguments") {
  CHECK(from<std::vector<double>>(List{1, 2.5}) == std::vector<double>{1, 2.5});
  const std::vector<Value> plain{1, 2, 3};
  Args args{plain};
  CHECK(args.take() == Value(1));
  CHECK(Convert<std::vector<int>>::from(args) == std::vector<int>{2, 3});
  CHECK(args.atEnd());
  CHECK_THROWS_WITH(args.take(), Catch::Contains("one more argument"));
  CHECK(from<std::vector<int>>(List{}) == std::vector<int>{});
  CHECK_THROWS_AS(from<std::vector<int>>(List{1, "x"}), Error);
}
