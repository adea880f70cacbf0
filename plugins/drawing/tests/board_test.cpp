#include <catch2/catch.hpp>
#include <set>
#include <sstream>

#include "../draw_board.h"
#include "../draw_packet.h"
#include "packets.h"

using namespace spark;
using namespace spark::test;
using drawing::DrawBoard;

namespace {
Drawing point(float x) {
  Drawing d;
  d.points = {{x, 0, 0}};
  return d;
}
Drawing label(int number, const std::string& text) {
  Drawing d;
  d.kind = Drawing::Kind::agentText;
  d.number = number;
  d.text = text;
  return d;
}

/// Set and x of each visible shape; for texts of agents the number of the agent.
using Shown = std::multiset<std::pair<std::string, float>>;
Shown shown(const DrawBoard& board) {
  Shown all;
  for (const auto& set : board.sets())
    for (const Drawing& d : set.shapes)
      all.emplace(set.name, d.points.empty() ? static_cast<float>(d.number) : d.points[0].x());
  return all;
}

/// Applies the output of record() like a reader of logs: packets of at most 512 bytes.
void replay(const std::string& record, DrawBoard& board) {
  std::size_t at = 0;
  while (at < record.size()) {
    REQUIRE(record[at] == '[');
    const std::size_t end = record.find(']', at);
    REQUIRE(end != std::string::npos);
    std::string bytes;
    std::istringstream numbers(record.substr(at + 1, end - at - 1));
    for (std::string number; std::getline(numbers, number, ',');) {
      const int v = std::stoi(number);
      REQUIRE((v >= -128 && v <= 127));
      bytes += static_cast<char>(v);
    }
    REQUIRE(bytes.size() <= 512);
    drawing::PacketReader reader(packet(bytes));
    for (drawing::Command c; reader.next(c);) {
      if (c.kind == drawing::Command::Kind::swap) board.swap(c.set);
      if (c.kind == drawing::Command::Kind::draw) board.add(c.set, c.drawing);
      if (c.kind == drawing::Command::Kind::agentText) board.setAgentText(c.drawing);
    }
    REQUIRE_FALSE(reader.failed());
    at = end + 1;
  }
}
}  // namespace

TEST_CASE("a swap shows the shapes of a set, or of all sets below a prefix, and replaces those before") {
  DrawBoard board;
  board.add("red.1", point(1));
  board.add("red.2", point(2));
  board.add("blue", point(3));
  CHECK(board.version() == 0);
  CHECK(shown(board).empty());
  board.swap("red");
  CHECK(shown(board) == Shown{{"red.1", 1}, {"red.2", 2}});
  board.add("red.1", point(4));
  board.swap("");
  CHECK(shown(board) == Shown{{"blue", 3}, {"red.1", 4}});
  const auto version = board.version();
  board.swap("nobody");
  board.swap("red.2");  // it shows nothing already
  CHECK(board.version() == version);
  for (std::size_t i = 1; i < board.sets().size(); ++i) CHECK(board.sets()[i - 1].name < board.sets()[i].name);
  board.clear();
  CHECK(shown(board).empty());
  CHECK(board.version() > version);
}

TEST_CASE("the version of a set changes only with the set") {
  DrawBoard board;
  board.show("a", {point(1)});
  board.show("b", {point(2)});
  const auto before = board.version();
  board.show("b", {point(3)});
  CHECK(board.sets()[0].version <= before);
  CHECK(board.sets()[1].version == board.version());
  CHECK(board.version() > before);
}

TEST_CASE("agents' texts are shown at once, one per agent, and are not affected by swaps") {
  DrawBoard board;
  board.setAgentText(label(3, "hello"));
  board.setAgentText(label(4, "you"));
  board.setAgentText(label(3, "there"));
  board.swap("");
  board.swap(DrawBoard::kAgents);
  REQUIRE(board.sets().size() == 1);
  CHECK(board.sets()[0].shapes.size() == 2);
  CHECK_FALSE(board.add(DrawBoard::kAgents, point(1)));
  CHECK(board.show(DrawBoard::kAgents, {point(1)}) == 1);
  board.setAgentText(label(3, ""));
  CHECK(shown(board) == Shown{{DrawBoard::kAgents, 4}});
}

TEST_CASE("agents' texts can be added and removed in any order") {
  DrawBoard board;
  std::set<int> there;
  for (int i = 0; i < 3000; ++i) {
    Drawing d = label(i * 37 % 128 + 1, i * 11 % 3 == 0 ? "" : "text");
    d.team = i % 5 == 0;
    const int agent = d.number + 1000 * d.team;
    if (d.text.empty())
      there.erase(agent);
    else
      there.insert(agent);
    board.setAgentText(d);
  }
  std::multiset<int> found;
  for (const Drawing& d : board.sets()[0].shapes) found.insert(d.number + 1000 * d.team);
  CHECK(found == std::multiset<int>(there.begin(), there.end()));
  CHECK(found.size() > 20);
  board.clear();
  board.setAgentText(label(3, "again"));
  CHECK(board.sets()[0].shapes.size() == 1);
}

TEST_CASE("the number of shapes and points is limited, and space is released again") {
  DrawBoard board;
  for (std::size_t i = 0; i < DrawBoard::kMaxShapes; ++i) REQUIRE(board.add("a", point(1)));
  CHECK_FALSE(board.add("a", point(1)));
  CHECK(board.add("b", point(1)));
  Drawing large;
  large.kind = Drawing::Kind::polygon;
  large.points.resize(255);
  std::size_t n = 0;
  while (board.add("c" + std::to_string(n % 5), large)) ++n;
  CHECK(n >= 25);
  CHECK(n <= DrawBoard::kMaxPoints / 255);
  CHECK(board.show("d", std::vector<Drawing>(10, large)) > 0);
  board.swap(""), board.swap("");
  CHECK(board.show("d", std::vector<Drawing>(10, large)) == 0);
  CHECK(board.show("d", std::vector<Drawing>(DrawBoard::kMaxShapes + 5, point(1))) == 5);
}

TEST_CASE("whatever is removed, shown or not, makes room for as many points again") {
  DrawBoard board;
  Drawing large;
  large.kind = Drawing::Kind::polygon;
  large.points.resize(255);
  const auto fill = [&] {  // the number of polygons for which there is room
    std::size_t n = 0;
    while (board.add("set" + std::to_string(n % 5), large)) ++n;
    return n;
  };
  const std::size_t most = fill();
  REQUIRE(most > 20);
  CHECK(fill() == 0);  // it is full
  board.clear();       // what was not shown
  CHECK(fill() == most);
  board.swap("");
  board.clear();  // what was shown
  CHECK(fill() == most);
  board.swap(""), board.swap("");
  CHECK(fill() == most);
  board.clear();
  CHECK(board.show("d", std::vector<Drawing>(most, large)) == 0);
  CHECK(board.show("d", {}) == 0);
  board.setAgentText(label(1, "text"));
  board.setAgentText(label(1, ""));
  CHECK(fill() == most);
}

TEST_CASE("sets that show nothing make room for others") {
  DrawBoard board;
  for (std::size_t i = 0; i < DrawBoard::kMaxSets; ++i) REQUIRE(board.show(std::to_string(i), {point(1)}) == 0);
  CHECK_FALSE(board.add("one more", point(1)));
  board.show("77", {});
  CHECK(board.show("one more", {point(1)}) == 0);
  CHECK(board.sets().size() == DrawBoard::kMaxSets);
}

TEST_CASE("a reader of records has the visible shapes after any full record") {
  DrawBoard board, always, late;
  late.show("old", {point(9)});
  late.add("older", point(9));
  std::uint64_t told = 0;
  const std::string names[] = {"a", "a.b", "a.b.c", "ab", "b", ""};
  for (int i = 0; i < 200; ++i) {
    const std::string& name = names[static_cast<std::size_t>(i * 7 % 6)];
    std::vector<Drawing> shapes;
    for (int k = 0; k < i % 4; ++k) shapes.push_back(point(static_cast<float>(i + k)));
    board.show(name, shapes);
    if (i % 5 == 0) board.setAgentText(label(i % 9 + 120, i % 3 ? "text" : ""));
    std::string record;
    board.record(i % 50 == 0 ? 0 : told, record);
    told = board.version();
    replay(record, always);
    if (i >= 150) replay(record, late);
    REQUIRE(shown(always) == shown(board));
    if (i >= 150) REQUIRE(shown(late) == shown(board));
    record.clear();
    board.record(told, record);
    REQUIRE(record.empty());
  }
}

TEST_CASE("nothing is recorded before the first drawing, and the size of a record is limited") {
  DrawBoard board;
  std::string record;
  board.record(0, record);
  CHECK(record.empty());
  Drawing large = point(1);
  large.kind = Drawing::Kind::text;
  large.text = std::string(drawing::PacketReader::kMaxTextBytes, 'x');
  for (int i = 0; i < 60; ++i) board.show(std::to_string(i), std::vector<Drawing>(100, large));
  board.record(0, record);
  CHECK(record.size() > DrawBoard::kMaxRecordBytes / 2);
  CHECK(record.size() < DrawBoard::kMaxRecordBytes + 100000);
}
