// Scene names and arguments come from agents. Invalid ones must cause an Error, not a crash or an endless import.

#include <catch2/catch.hpp>

#include "scene_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("scene names that do not exist, leave the folder or are absolute are refused") {
  SceneHost h;
  for (const char* name : {"none.rsg", "", "/etc/passwd", "../x.rsg", "a/../../x", "rsg\\x.rsg", "."}) {
    INFO(name);
    CHECK_THROWS_AS(h.import(name), Error);
  }
  CHECK(h.scene->children().empty());
  h.write("good.rsg", "(RSG 0 1)((nd Probe))");
  h.import("good.rsg");
  CHECK(h.scene->children().size() == 1);
}

TEST_CASE("a file that imports itself is stopped at the depth limit") {
  SceneHost h;
  CHECK(h.failure("(nd Probe)(importScene test.rsg)").find("deep: does a file import itself?") != std::string::npos);
  CHECK(h.scene->children().size() == 32);
  CHECK(h.failure("(importScene test.rsg)(importScene test.rsg)").find("too many imports") != std::string::npos);
  h.set("strict", true);
  CHECK(h.failure("(importScene test.rsg)").find("deep: does a file import itself?") != std::string::npos);
}

TEST_CASE("the numbers of imports and of nodes are limited") {
  SceneHost h;
  h.set("maxImports", 50);
  h.set("maxNodes", 100);
  std::string many;
  for (int i = 0; i < 40; ++i) many += "(importScene b.rsg)";
  h.write("b.rsg", "(RSG 0 1)((nd Probe)(nd Probe)(nd Probe))");
  CHECK(h.failure(many + many).find("too many nodes: one import may make at most 100") != std::string::npos);
  CHECK(h.scene->children().size() == 100);
  h.set("maxNodes", 1000);
  CHECK(h.failure(many + many).find("too many imports: at most 50") != std::string::npos);
  CHECK(h.failure("(importScene b.rsg)").empty());
}

TEST_CASE("compiled files are cached up to a limit, and always during the running import") {
  SceneHost h;
  const std::string text = "(RSG 0 1)((nd Probe))" + std::string(979, ' ');
  for (const char* name : {"a.rsg", "b.rsg", "c.rsg"}) h.write(name, text);
  const auto parsed = [&](const char* name) {
    const std::int64_t before = h.count("filesParsed");
    h.import(name);
    return h.count("filesParsed") - before;
  };
  h.set("keptBytes", 2000);
  for (const char* name : {"a.rsg", "b.rsg"}) CHECK(parsed(name) == 1);
  for (const char* name : {"a.rsg", "b.rsg", "a.rsg"}) CHECK(parsed(name) == 0);
  CHECK(parsed("c.rsg") == 1);
  CHECK(parsed("a.rsg") == 0);
  CHECK(parsed("b.rsg") == 1);
  h.set("keptBytes", 0);
  h.write("d.rsg", "(RSG 0 1)((importScene a.rsg)(importScene b.rsg)(importScene a.rsg)(importScene b.rsg))");
  const std::int64_t before = h.count("filesParsed");
  h.import("d.rsg");
  CHECK(h.count("filesParsed") - before == 3);
  h.write("d.rsg", "(RSG 0 1)((importScene c.rsg)(importScene c.rsg) )");
  CHECK(parsed("d.rsg") == 2);
}

TEST_CASE("the length of texts is limited") {
  SceneHost h;
  std::string body = "(def $a 0123456789)";
  for (int i = 0; i < 60; ++i) body += "(def $a (join $a $a $a))";
  CHECK(h.failure(body).find("at most 4096 bytes") != std::string::npos);
}

TEST_CASE("deep nesting is refused without recursion") {
  SceneHost h;
  CHECK(h.failure(std::string(200000, '(')) != "");
  CHECK(h.failure(std::string(200000, '(') + std::string(200000, ')')) != "");
  std::string eval = "1";
  for (int i = 0; i < 1000; ++i) eval = "(eval " + eval + ")";
  CHECK(h.failure("(nd Probe (tell " + eval + "))") != "");
}

TEST_CASE("arguments that are infinite, NaN or huge numbers are refused, but similar texts are not") {
  SceneHost h;
  for (const char* bad : {"nan", "inf", "-inf", "infinity", "+inf", "1e999", "-1e999", "1e12", "nan(7)"}) {
    INFO(bad);
    CHECK(h.failure("(templ $x)(nd Probe (tell $x))", {bad}).find("argument 1 is '" + std::string(bad) + "'") !=
          std::string::npos);
  }
  CHECK(h.failure("(templ $x)(nd Probe (tell $x))", {std::string(5000, 'x')}).find("at most 4096 bytes") !=
        std::string::npos);
  CHECK(h.failure("(templ $x)(nd Probe (tell $x))", {"nano"}).empty());
  CHECK(records().back() == "nano");
  CHECK(h.failure("(templ $x)(nd Probe (tell (eval $x)))", {"1; os.exit()"}).find("test.rsg:2:") == 0);
}

TEST_CASE("arguments with special characters are refused as names or used literally") {
  SceneHost h;
  h.run("(templ $x)(nd Probe (setName $x)(tell $x))", {"a/b"});
  CHECK(h.logged("must not hold '/'"));
  CHECK_NOTHROW(h.run("(templ $x)(nd Probe (setName $x))", {std::string("\xff\x01\n[", 4)}));
}
