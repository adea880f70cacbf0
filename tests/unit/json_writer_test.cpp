#include "spark/json_writer.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace spark;

namespace {
/// The text that `write` produces.
template <class Write>
std::string written(Write write, JsonStyle style = {}) {
  std::string out;
  {
    JsonWriter json(out, style);
    write(json);
  }
  return out;
}
}  // namespace

TEST_CASE("JSON has commas between values, and none after brackets and keys") {
  CHECK(written([](JsonWriter& j) { j.beginArray().endArray(); }) == "[]");
  CHECK(written([](JsonWriter& j) { j.beginObject().endObject(); }) == "{}");
  CHECK(
      written([](JsonWriter& j) {
        j.beginObject().member("a", 1).key("b").beginArray().value(2).beginObject().endObject().beginArray().endArray();
        j.value("x").endArray().member("c", true).key("d").beginObject().member("e", false).endObject();
        j.key("f").null().key("g").raw("[1,2]").key("h").numbers(std::array{1.5, -2.0}).endObject();
      }) == R"({"a":1,"b":[2,{},[],"x"],"c":true,"d":{"e":false},"f":null,"g":[1,2],"h":[1.5,-2]})");
  CHECK(written([](JsonWriter& j) { j.value("alone"); }) == "\"alone\"");
}

TEST_CASE("A JSON text is complete when its outermost bracket is closed") {
  std::string out = "before ";
  JsonWriter json(out);
  json.beginArray().beginArray().endArray();
  json.endArray();
  CHECK(out == "before [[]]");
}

TEST_CASE("The members of a serialized JSON object can be added to another object") {
  CHECK(written([](JsonWriter& j) { j.beginObject().member("id", 7).members(R"({"ok":true,"n":[1]})").endObject(); }) ==
        R"({"id":7,"ok":true,"n":[1]})");
  CHECK(written([](JsonWriter& j) { j.beginObject().member("id", 7).members("{}").member("x", 1).endObject(); }) ==
        R"({"id":7,"x":1})");
}

TEST_CASE("JSON numbers have the requested number of digits, and numbers that are not finite become null") {
  CHECK(written([](JsonWriter& j) {
          j.beginArray().value(1.0 / 3).value(1e-7).value(1e6).value(-0.0).value(0.1f).endArray();
        }) == "[0.333333,1e-07,1e+06,-0,0.1]");
  CHECK(written([](JsonWriter& j) { j.beginArray().value(1.0 / 3, 10).value(1e6, 10).value(2.5, 1).endArray(); }) ==
        "[0.3333333333,1000000,2]");
  CHECK(written([](JsonWriter& j) { j.beginArray().fixed(2.0 / 3, 2).fixed(-0.001, 2).fixed(5, 0).endArray(); }) ==
        "[0.67,-0.00,5]");
  CHECK(written([](JsonWriter& j) { j.beginArray().value(std::int64_t{-1} << 62).value(7u).value('a').endArray(); }) ==
        "[-4611686018427387904,7,97]");
  const auto odd = [](JsonWriter& j) {
    j.beginArray().value(std::nan("")).value(HUGE_VAL, 10).fixed(-HUGE_VAL, 3).endArray();
  };
  CHECK(written(odd) == "[null,null,null]");
  CHECK(written(odd, {.notFinite = "0"}) == "[0,0,0]");
}

TEST_CASE("JSON strings and keys are escaped, and invalid UTF-8 is replaced") {
  const std::string odd = "quote\" back\\ \n\x01 \xff \xe2\x82\xac";
  const auto write = [&](JsonWriter& j) { j.beginObject().member(odd, odd).member("plain", "plain").endObject(); };
  const std::string utf8 = written(write), ascii = written(write, {.ascii = true});
  CHECK(utf8.find("\xe2\x82\xac") != utf8.npos);
  CHECK(ascii.find("\\u20ac") != ascii.npos);
  CHECK(std::all_of(ascii.begin(), ascii.end(), [](unsigned char c) { return c < 0x7f; }));
  const std::string read = "quote\" back\\ \n\x01 \xef\xbf\xbd \xe2\x82\xac";
  CHECK(nlohmann::json::parse(utf8) == nlohmann::json{{read, read}, {"plain", "plain"}});
  CHECK(nlohmann::json::parse(ascii) == nlohmann::json::parse(utf8));
}

TEST_CASE("A JSON text may be longer than the writer's buffer") {
  const std::string text = written([](JsonWriter& j) {
    j.beginArray();
    for (int i = 0; i < 5000; ++i) j.value(i).value(std::string(static_cast<std::size_t>(i % 7) * 1000, 'x'));
    j.endArray();
  });
  const auto read = nlohmann::json::parse(text);
  REQUIRE(read.size() == 10000);
  CHECK(read[9998] == 4999);
}
