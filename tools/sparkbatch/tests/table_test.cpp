#include "table.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "spark/error.h"
#include "temporary_folder.h"

using namespace sparkbatch;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
std::string textOf(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

void append(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::app) << text; }

const Json kBatch{{"config", "a.lua"}, {"duration", 5.0}};

Row row(int run, double speed) { return {{"run", run}, {"end", "duration"}, {"speed", speed}, {"cpuSeconds", 0.5}}; }

template <class F>
std::string errorOf(F f) {
  try {
    f();
  } catch (const spark::Error& e) {
    return e.what();
  }
  return "";
}
}  // namespace

TEST_CASE("A row is in the file once it is added, and in order after sort()") {
  const spark::test::TemporaryFolder folder;
  const std::string file = folder.file("t.csv");
  Table table(file, kBatch, Table::Open::fresh);
  table.add(row(2, 0.25));
  REQUIRE(textOf(file) == "run,end,speed,cpuSeconds\n2,duration,0.25,0.5\n");
  table.add(row(1, 0.1));
  REQUIRE(textOf(file) == "run,end,speed,cpuSeconds\n2,duration,0.25,0.5\n1,duration,0.1,0.5\n");
  table.sort();
  REQUIRE(textOf(file) == "run,end,speed,cpuSeconds\n1,duration,0.1,0.5\n2,duration,0.25,0.5\n");
  REQUIRE(table.has(1));
  REQUIRE_FALSE(table.has(3));
}

TEST_CASE("A new column is added later, and error and times remain at the end") {
  const spark::test::TemporaryFolder folder;
  const std::string file = folder.file("t.csv");
  Table table(file, kBatch, Table::Open::fresh);
  table.add({{"run", 2}, {"end", "error"}, {"cpuSeconds", 1}, {"error", "no, \"that\"\nis wrong"}});
  table.add(row(1, 3));
  REQUIRE(textOf(file) ==
          "run,end,speed,cpuSeconds,error\n1,duration,3,0.5,\n2,error,,1,\"no, \"\"that\"\"\\nis wrong\"\n");
}

TEST_CASE("Columns are in the order of the first run that has them, in any order of arrival") {
  const spark::test::TemporaryFolder folder;
  Table table(folder.file("t.csv"), kBatch, Table::Open::fresh),
      other(folder.file("u.csv"), kBatch, Table::Open::fresh);
  const Row first{{"run", 1}, {"a", 1}, {"b", 2}}, second{{"run", 2}, {"b", 3}, {"a", 4}, {"c", 5}};
  table.add(first), table.add(second), table.sort();
  other.add(second), other.add(first), other.sort();
  REQUIRE(textOf(folder.file("t.csv")) == "run,a,b,c\n1,1,2,\n2,4,3,5\n");
  REQUIRE(textOf(folder.file("u.csv")) == textOf(folder.file("t.csv")));
}

TEST_CASE("A table is resumed without an incomplete last line") {
  for (const char* name : {"t.csv", "t.jsonl"}) {
    const spark::test::TemporaryFolder folder;
    const std::string file = folder.file(name);
    {
      Table table(file, kBatch, Table::Open::fresh);
      table.add(row(1, 0.1)), table.add(row(4, 0.2));
    }
    const std::string whole = textOf(file);
    append(file, name == std::string("t.csv") ? "3,dura" : "{\"run\":3,\"en");
    Table table(file, kBatch, Table::Open::resume);
    REQUIRE(table.has(1));
    REQUIRE(table.has(4));
    REQUIRE_FALSE(table.has(3));
    REQUIRE(textOf(file) == whole);
    table.add(row(3, 0.3)), table.sort();
    const spark::test::TemporaryFolder fresh;
    Table straight(fresh.file(name), kBatch, Table::Open::fresh);
    straight.add(row(1, 0.1)), straight.add(row(3, 0.3)), straight.add(row(4, 0.2)), straight.sort();
    REQUIRE(textOf(file) == textOf(fresh.file(name)));
  }
}

TEST_CASE("JSON lines distinguish numbers and text") {
  const spark::test::TemporaryFolder folder;
  const std::string file = folder.file("t.jsonl");
  Table table(file, kBatch, Table::Open::fresh);
  table.add({{"run", 1}, {"a", 1.5}, {"b", "1.5"}, {"c", {1, 2}}});
  REQUIRE(textOf(file) == "{\"run\":1,\"a\":1.5,\"b\":\"1.5\",\"c\":[1,2]}\n");
}

TEST_CASE("Rows with an error are repeated only on request") {
  const spark::test::TemporaryFolder folder;
  const std::string file = folder.file("t.csv");
  {
    Table table(file, kBatch, Table::Open::fresh);
    table.add(row(1, 1)), table.add({{"run", 2}, {"end", "error"}, {"error", "no"}});
  }
  REQUIRE(Table(file, kBatch, Table::Open::resume).has(2));
  Table table(file, kBatch, Table::Open::retry);
  REQUIRE(table.has(1));
  REQUIRE_FALSE(table.has(2));
}

TEST_CASE("A table that does not match the batch is refused with an error") {
  const spark::test::TemporaryFolder folder;
  const std::string file = folder.file("t.csv");
  { Table(file, kBatch, Table::Open::fresh).add(row(1, 1)); }
  REQUIRE_THAT(errorOf([&] { Table(file, kBatch, Table::Open::fresh); }), Contains("--resume"));
  Json other = kBatch;
  other["duration"] = 6.0;
  REQUIRE_THAT(errorOf([&] { Table(file, other, Table::Open::resume); }),
               Contains("duration is 5.0, now it would be 6.0"));
  {
    Table holds(file, kBatch, Table::Open::resume);
    REQUIRE_THAT(errorOf([&] { Table(file, kBatch, Table::Open::resume); }), Contains("in use"));
  }
  append(file, "no number,a,b,c\n");
  REQUIRE_THAT(errorOf([&] { Table(file, kBatch, Table::Open::resume); }),
               Contains("t.csv:3") && Contains("no number"));
  fs::remove(file + ".batch");
  REQUIRE_THAT(errorOf([&] { Table(file, kBatch, Table::Open::resume); }), Contains("t.csv.batch"));
}
