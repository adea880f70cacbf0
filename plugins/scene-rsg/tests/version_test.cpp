// Version 0.2 of the language.

#include <catch2/catch.hpp>

#include "scene_house.h"

using namespace spark;
using namespace spark::test;

namespace {
/// As SceneHost::failure(), in version 0.2.
std::string failureOfOurs(SceneHost& h, const std::string& body, const List& arguments = {}) {
  h.write("test.rsg", "(RSG 0 2)\n(" + body + ")");
  try {
    h.import("test.rsg", arguments);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}
}  // namespace

TEST_CASE("in version 0.2 set sets a property, at the end of the file like a call") {
  SceneHost h;
  CHECK(failureOfOurs(h,
                      "(templ $n)(nd Probe (setName p)(set number $n)(set flag true)(set vector 1 (eval 1 / 3) 1e-30)"
                      "(set integer 7)(tell told))",
                      {0.1}) == "");
  CHECK(h.probe("p").number() == 0.1);
  CHECK(h.probe("p").flag());
  CHECK(h.probe("p").integer() == 7);
  CHECK(h.probe("p").vector() == Vec3(1, 1.0 / 3, 1e-30));
  const std::pair<const char*, const char*> cases[] = {
      {"(set)", "test.rsg:2:13: expected the name of a property"},
      {"(set (eval 1) 2)", "test.rsg:2:13: expected the name of a property"},
      {"(set nummer 1)", "test.rsg:2:13: class Probe has no property 'nummer'. Did you mean 'number'"},
      {"(set vector 1 2)", "test.rsg:2:13: cannot set vector of /usr/scene/Probe"},
      {"(set vector 1 2 3 4)", "test.rsg:2:13: cannot set vector of /usr/scene/Probe: expected"},
      {"(set number many)", "test.rsg:2:13: cannot set number of /usr/scene/Probe"},
      {"(set flag 2)", "test.rsg:2:13: cannot set flag of /usr/scene/Probe"},
  };
  for (const auto& [call, message] : cases)
    CHECK_THAT(failureOfOurs(h, "(nd Probe " + std::string(call) + ")"), Catch::StartsWith(message));
  CHECK_THAT(failureOfOurs(h, "(nd Transform (set worldTransform 1))"),
             Catch::StartsWith("test.rsg:2:17: the property worldTransform of class Transform is read only"));
  CHECK(h.scene->children().size() == 1);
  // In version 0.1 it is a call like any other.
  h.run("(nd Probe (set number 1))");
  CHECK(h.logged("class Probe has no method 'set'"));
}

TEST_CASE("version 0.2 is strict, and what fails leaves nothing behind") {
  SceneHost h;
  h.write("broken.rsg", "(RSG 0 1)((nd Probe)(nd Missing))");
  for (const char* body : {"(nd Probe)(nd Missing)", "(nd Probe (setNumber garbage))", "(nd Probe (setVector 1 2))",
                           "(nd Probe (nothing))", "(nd Probe)(importScene broken.rsg)", "(nd Probe)(sel none)",
                           "(nd Probe)(switch a (b (nd Probe)))", "(nd Transform (unlinkLeaf)(nd Probe))"}) {
    INFO(body);
    CHECK_THAT(failureOfOurs(h, body), Catch::StartsWith("test.rsg:2:"));
    CHECK(h.scene->children().empty());
  }
  h.write("tail.rsg", "(RSG 0 2)((nd Probe)))");
  CHECK_THROWS_AS(h.import("tail.rsg"), Error);
  CHECK(h.scene->children().empty());
  CHECK(failureOfOurs(h, "(nd Probe)") == "");
  CHECK(h.scene->children().size() == 1);
}

TEST_CASE("in version 0.2 transforms stay, and evaluated numbers have all their digits") {
  SceneHost h;
  const std::string body =
      "(nd Transform (setName a)(nd Transform (setName b)(nd Probe (setNumber (eval 1 / 3)))))"
      "(nd Transform (setName empty))";
  h.run(body);
  CHECK(h.scene->find("b/Probe"));
  CHECK_FALSE(h.scene->find("empty"));
  CHECK(h.probe("b/Probe").number() == Approx(0.333333).epsilon(1e-7));
  h.scene->removeChildren();
  CHECK(failureOfOurs(h, body) == "");
  CHECK(h.scene->find("a/b/Probe"));
  CHECK(h.scene->find("empty"));
  CHECK(h.probe("a/b/Probe").number() == 1.0 / 3);
}

TEST_CASE("files of both versions may import each other, each in its own way") {
  SceneHost h;
  h.write("ours.rsg", "(RSG 0 2)((nd Transform (setName ours)))");
  h.write("theirs.rsg", "(RSG 0 1)((nd Transform (setName theirs)(nd Probe (setVector 1 2))))");
  h.run("(importScene ours.rsg)(importScene theirs.rsg)");
  CHECK(h.scene->find("ours"));
  CHECK(h.scene->find("theirs/Probe"));
  CHECK(failureOfOurs(h, "(importScene theirs.rsg)(importScene ours.rsg)") == "");
  CHECK(h.scene->children().size() == 4);
}
