#include <catch2/catch.hpp>

#include "../draw_packet.h"
#include "../shape_reader.h"
#include "packets.h"

using namespace spark;
using namespace spark::test;
using drawing::Command;
using drawing::PacketReader;

namespace {
std::vector<Command> readAll(const std::string& text, bool* failed = nullptr) {
  PacketReader reader(packet(text));
  std::vector<Command> all;
  for (Command c; reader.next(c);) all.push_back(c);
  if (failed) *failed = reader.failed();
  return all;
}

/// The single command of a packet.
Command readOne(const std::string& text) {
  bool failed = true;
  const auto all = readAll(text, &failed);
  REQUIRE_FALSE(failed);
  REQUIRE(all.size() == 1);
  return all[0];
}

Drawing shapeOf(const std::string& text) {
  Predicates p;
  readSexp(text, p);
  Drawing d;
  const std::string wrong = drawing::readShape(*p.begin(), d);
  INFO(text);
  REQUIRE(wrong == "");
  return d;
}

std::string complaintOf(const std::string& text) {
  Predicates p;
  readSexp(text, p);
  Drawing d;
  return drawing::readShape(*p.begin(), d);
}
}  // namespace

TEST_CASE("each command of the drawing port is read like the original viewer reads it") {
  using Kind = Drawing::Kind;
  const std::string rgb = bytes({255, 0, 51});
  Drawing d = readOne(bytes({1, 0}) + "-5.0002.50000.75002.0000" + rgb + zero("a.b")).drawing;
  CHECK(d.kind == Kind::circle);
  CHECK(d.points == std::vector<Vec3f>{{-5, 2.5f, 0}});
  CHECK(d.size == 0.75f);
  CHECK(d.thickness == 2);
  CHECK(d.color.r == 1);
  CHECK(d.color.b == Approx(0.2));
  CHECK(d.color.a == 1);
  d = readOne(bytes({1, 1}) + "0.00001.00002.00003.00004.00005.00001.5000" + rgb + zero("n")).drawing;
  CHECK(d.kind == Kind::line);
  CHECK(d.points == std::vector<Vec3f>{{0, 1, 2}, {3, 4, 5}});
  CHECK(d.thickness == 1.5f);
  d = readOne(bytes({1, 2}) + "0.00001.00002.000010.000" + rgb + zero("n")).drawing;
  CHECK(d.kind == Kind::point);
  CHECK(d.size == 10);
  d = readOne(sphere("n")).drawing;
  CHECK(d.kind == Kind::sphere);
  CHECK(d.points == std::vector<Vec3f>{{1, 2, 3}});
  CHECK(d.size == 0.5f);
  d = readOne(bytes({1, 4, 3}) + rgb + bytes({128}) + "0.00000.00000.00001.00000.00000.00000.00001.00000.0000" +
              zero("n"))
          .drawing;
  CHECK(d.kind == Kind::polygon);
  CHECK(d.points.size() == 3);
  CHECK(d.color.a == Approx(0.502).margin(0.001));
  const Command text = readOne(bytes({2, 0}) + "0.00001.00002.0000" + rgb + zero("h\u00e4llo") + zero("set"));
  CHECK(text.kind == Command::Kind::draw);
  CHECK(text.set == "set");
  CHECK(text.drawing.kind == Kind::text);
  CHECK(text.drawing.text == "h\u00e4llo");
  const Command label = readOne(bytes({2, 1, 128 + 4}) + rgb + zero("keeper"));
  CHECK(label.kind == Command::Kind::agentText);
  CHECK(label.drawing.team == 1);
  CHECK(label.drawing.number == 5);
  CHECK(label.drawing.text == "keeper");
  const Command none = readOne(bytes({2, 2, 0}));
  CHECK(none.drawing.text.empty());
  CHECK(none.drawing.team == 0);
  CHECK(none.drawing.number == 1);
  CHECK(readOne(bytes({3, 0, 7})).kind == Command::Kind::none);
  const Command swapped = readOne(swap("a"));
  CHECK(swapped.kind == Command::Kind::swap);
  CHECK(swapped.set == "a");
}

TEST_CASE("commands are the same after writing and reading") {
  const std::string commands = sphere("a.b") + swap("a") + bytes({1, 0}) + "-5.0002.50000.75002.0000" +
                               bytes({1, 2, 3}) + zero("a.b") + bytes({1, 4, 2, 9, 8, 7, 6}) + "0.0000-1.500099999" +
                               "1.00000.00000.0001" + zero("c") + bytes({2, 0}) + "0.00001.00002.0000" +
                               bytes({0, 0, 0}) + zero("text") + zero("t") + bytes({2, 1, 130, 0, 0, 0}) + zero("x") +
                               bytes({2, 2, 3});
  bool failed = true;
  const auto first = readAll(commands, &failed);
  REQUIRE_FALSE(failed);
  REQUIRE(first.size() == 7);
  std::string written;
  for (const Command& c : first)
    c.kind == Command::Kind::swap ? drawing::writeSwap(c.set, written)
                                  : drawing::writeDrawing(c.drawing, c.set, written);
  const auto second = readAll(written, &failed);
  REQUIRE_FALSE(failed);
  REQUIRE(second.size() == first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    CAPTURE(i);
    CHECK(second[i].kind == first[i].kind);
    CHECK(second[i].set == first[i].set);
    CHECK(second[i].drawing.points == first[i].drawing.points);
    CHECK(second[i].drawing.text == first[i].drawing.text);
    CHECK(second[i].drawing.size == first[i].drawing.size);
    CHECK(second[i].drawing.color.a == first[i].drawing.color.a);
  }
}

TEST_CASE("invalid bytes end their packet, and the commands before them take effect") {
  const std::string good = sphere("a");
  for (const std::string& bad : {bytes({1}), bytes({9, 9}), bytes({1, 5}), bytes({2, 3}), bytes({3, 1, 0}),
                                 bytes({1, 3}) + "nan   0.00000.00000.0000" + bytes({0, 0, 0}) + zero("n"),
                                 bytes({1, 3}) + "1e9999" + "0.00000.00000.0000" + bytes({0, 0, 0}) + zero("n"),
                                 bytes({1, 3}) + "1 2   0.00000.00000.0000" + bytes({0, 0, 0}) + zero("n"),
                                 bytes({1, 3}) + "1e30  0.00000.00000.0000" + bytes({0, 0, 0}) + zero("n"),
                                 bytes({1, 4, 255, 0, 0, 0, 0}) + "0.0000", bytes({0, 0}) + "endless"}) {
    bool failed = false;
    CHECK(readAll(good + bad, &failed).size() == 1);
    CHECK(failed);
  }
  for (std::size_t n = 1; n < good.size(); ++n) {
    bool failed = false;
    CHECK(readAll(good.substr(0, n), &failed).empty());
    CHECK(failed);
  }
}

TEST_CASE("names and texts are truncated, valid UTF-8, and without control characters") {
  CHECK(drawing::cleanText("a\nb\x7f", 10) == "a b ");
  CHECK(drawing::cleanText("\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80", 100) == "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80");
  CHECK(drawing::cleanText("\xff\xc3", 100) == "??");  // an invalid byte, an incomplete character
  CHECK(drawing::cleanText("\xc0\x80|\xed\xa0\x80", 100) ==
        "??|???");                                               // an overlong encoding, half of a surrogate pair
  CHECK(drawing::cleanText("\xf5\x80\x80\x80", 100) == "????");  // above the last code point
  CHECK(drawing::cleanText("aaa\xe2\x82\xac", 5) == "aaa");      // truncated between characters
  CHECK(readOne(bytes({0, 0}) + zero(std::string(500, 'x'))).set.size() == PacketReader::kMaxNameBytes);
}

TEST_CASE("agents write shapes as lists") {
  using Kind = Drawing::Kind;
  Drawing d = shapeOf("(circle (at 1 2) (radius 0.5) (thickness 3) (color 255 0 0))");
  CHECK(d.kind == Kind::circle);
  CHECK(d.points == std::vector<Vec3f>{{1, 2, 0}});
  CHECK(d.size == 0.5f);
  CHECK(d.thickness == 3);
  CHECK(d.color.g == 0);
  d = shapeOf("(line (from 0 0 0) (to 1 2 3))");
  CHECK(d.points == std::vector<Vec3f>{{0, 0, 0}, {1, 2, 3}});
  CHECK(d.color.g == 1);
  CHECK(d.thickness == 1);
  CHECK(shapeOf("(point (at 1 2 3))").size == 5);
  CHECK(shapeOf("(sphere (at 1 2 3) (radius 0.1))").size == 0.1f);
  d = shapeOf("(polygon (at 0 0 0) (at 1 0 0) (at 0 1 0) (color 0 0 255 51))");
  CHECK(d.points.size() == 3);
  CHECK(d.color.a == Approx(0.2));
  CHECK(shapeOf("(text (at 0 0 1) (say \"two words\"))").text == "two words");
  d = shapeOf("(agent (side right) (unum 7) (say hello))");
  CHECK(d.kind == Kind::agentText);
  CHECK(d.team == 1);
  CHECK(d.number == 7);
}

TEST_CASE("an invalid shape is refused with the expected format") {
  const std::pair<const char*, const char*> cases[] = {{"(cube (at 1 2 3))", "expected a circle"},
                                                       {"(circle (at 1 2))", "(radius number)"},
                                                       {"(circle (radius 1))", "(at x y)"},
                                                       {"(sphere (at 1 2) (radius 1))", "(at x y z)"},
                                                       {"(sphere (at 1 2 nan) (radius 1))", "(at x y z)"},
                                                       {"(sphere (at 1 2 1e9) (radius 1))", "(at x y z)"},
                                                       {"(sphere (at 1 2 3) (radius -1))", "not below 0"},
                                                       {"(line (from 0 0 0))", "(to x y z)"},
                                                       {"(polygon (at 0 0 0) (at 1 1 1))", "three corners"},
                                                       {"(polygon (at 0 0 0) (at 1 1) (at 2 2 2))", "corners"},
                                                       {"(text (at 0 0 0))", "(say text)"},
                                                       {"(agent (side left))", "(unum 1)"},
                                                       {"(agent (side up) (unum 1))", "(side left)"},
                                                       {"(point (at 0 0 0) (color 1 2))", "(color red green blue)"}};
  for (const auto& [text, why] : cases) CHECK_THAT(complaintOf(text), Catch::Contains(why));
}
