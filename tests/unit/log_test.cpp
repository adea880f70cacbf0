#include "spark/log.h"

#include <catch2/catch.hpp>

#include "spark/error.h"

using spark::Level;
using spark::Log;

TEST_CASE("Only messages that pass the level are formatted and written") {
  Log log;
  std::string text;
  log.setSink([&](Level, std::string_view line) { text.append(line).append("|"); });
  log.setLevel(Level::warning);
  log.info("not {}", "this");
  log.warning("this {}", 1);
  log.error("and {}", "that");
  CHECK(text == "this 1|and that|");
  log.setLevel(Level::off);
  log.error("nothing");
  CHECK(text == "this 1|and that|");
  CHECK_FALSE(log.enabled(Level::error));
  CHECK(log.errors() == 2);  // errors are counted at any level
}

TEST_CASE("Text from outside cannot forge lines or control a terminal") {
  Log log;
  std::string text;
  log.setSink([&](Level, std::string_view line) { text = line; });
  log.info("agent {}", "x\n12:00:00 error all is lost\x1b[2J\x7f\r");
  CHECK(text == "agent x\n  12:00:00 error all is lost\\x1b[2J\\x7f\\x0d");
  log.info("outer\n  because: inner");
  CHECK(text == "outer\n  because: inner");
  log.info("{}", std::string("a\0b", 3));
  CHECK(text == "a\\x00b");
  log.info("\u00e9 \u009b2J \u20ac");
  CHECK(text == "\u00e9 \\xc2\\x9b2J \u20ac");
}

TEST_CASE("Further sinks have levels of their own") {
  Log log;
  std::string text, one, two;
  log.setSink([&](Level, std::string_view line) { text.append(line).append("|"); });
  const int first = log.addSink(Level::debug, [&](Level, std::string_view line) { one.append(line).append("|"); });
  const int second = log.addSink(Level::error, [&](Level, std::string_view line) { two.append(line).append("|"); });
  CHECK(log.enabled(Level::debug));
  CHECK_FALSE(log.enabled(Level::trace));
  CHECK(log.level() == Level::info);
  log.debug("a");
  log.info("b");
  log.error("c");
  log.setLevel(first, Level::off);
  CHECK_FALSE(log.enabled(Level::debug));
  log.setLevel(second, Level::trace);
  log.setLevel(Level::off);
  log.trace("d");
  log.removeSink(second);
  log.removeSink(second);
  log.setLevel(second, Level::trace);
  CHECK_FALSE(log.enabled(Level::error));
  log.error("e");
  CHECK(text == "b|c|");
  CHECK(one == "a|b|c|");
  CHECK(two == "c|d|");
}

TEST_CASE("Levels have names") {
  CHECK(spark::nameOf(Level::warning) == "warning");
  CHECK(spark::levelNames().size() == 6);
  CHECK(spark::levelFromName("debug") == Level::debug);
  CHECK_THROWS_WITH(spark::levelFromName("warnin"),
                    Catch::Contains("expected a log level") && Catch::Contains("'warning'"));
}

TEST_CASE("A text is shortened in whole characters, with a mark") {
  CHECK(spark::shortened("short", 5) == "short");
  CHECK(spark::shortened("longer", 5) == "longe ... (1 bytes were cut)");
  // Umlauts have two bytes.
  CHECK(spark::shortened("a\xc3\xbc\xc3\xbc", 4) == "a\xc3\xbc ... (2 bytes were cut)");
  CHECK(spark::shortened("\xc3\xbc", 1) == " ... (2 bytes were cut)");
}
