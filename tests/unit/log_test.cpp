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
}

TEST_CASE("Levels have names") {
  CHECK(spark::levelFromName("debug") == Level::debug);
  CHECK_THROWS_WITH(spark::levelFromName("warnin"),
                    Catch::Contains("expected a log level") && Catch::Contains("'warning'"));
}
