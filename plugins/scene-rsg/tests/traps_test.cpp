// One test for each pitfall of the installed base's scene language.

#include <catch2/catch.hpp>

#include "scene_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a semicolon inside an atom does not start a comment, and quotes do not join atoms") {
  SceneHost h;
  h.run("(nd Probe (tell a;b) ; a comment ) here\n (tell \"with blank\")(tell 'single')(tell x)) ;; end\n");
  CHECK(records() == Texts{"link 0 0 0", "a;b", "with blank", "single", "x"});
  records().clear();
  h.run("(def $t 1)(nd Probe (tell (join \"A[\"$t\"]\")))");
  CHECK(records() == Texts{"link 0 0 0", "A[1]"});
}

TEST_CASE("text after the body is ignored, unless looseTrailingParen is off or strict is on") {
  SceneHost h;
  h.write("extra.rsg", "(RSG 0 1)\n((nd Probe))\n)");
  CHECK_NOTHROW(h.import("extra.rsg"));
  h.set("looseTrailingParen", false);
  CHECK_THROWS_WITH(h.import("extra.rsg"), Catch::Contains("expected nothing after the body"));
  h.set("looseTrailingParen", true);
  h.set("strict", true);
  CHECK_THROWS_AS(h.import("extra.rsg"), Error);
}

TEST_CASE("a definition is valid from its position to the end of the file, across lists, and not in imported files") {
  SceneHost h;
  h.run("(nd Transform (def $x inner) (nd Probe)) (nd Probe (setName p)(tell $x)) (def $x outer) (nd Probe (tell $x))");
  CHECK(records() == Texts{"link 0 0 0", "link 0 0 0", "link 0 0 0", "inner", "outer"});
  h.write("inner.rsg", "(RSG 0 1)((nd Probe (tell $x)))");
  CHECK(h.failure("(def $x 1)(importScene inner.rsg)").find("there is no variable $x here") != std::string::npos);
}

TEST_CASE("queued calls use the value that a definition had at their position") {
  SceneHost h;
  h.run("(def $x 1)(nd Probe (tell $x)(def $x 2)(tell $x))");
  CHECK(records() == Texts{"link 0 0 0", "1", "2"});
}

TEST_CASE("calls are deferred to the end of the file, except those of Transform, which act at once") {
  SceneHost h;
  h.run(
      "(nd Probe (tell first)(setName a)(attach ../b)) (nd Transform (setLocalPos 1 2 3)(nd Probe (setName b))) (nd "
      "Probe (setName b))");
  CHECK(records() == Texts{"link 0 0 0", "link 1 2 3", "link 0 0 0", "first", "../b is there"});
}

TEST_CASE("the name of a call decides whether it is deferred, not the class of the node") {
  SceneHost h;
  h.run("(nd Probe (tell queued)(setLocalPos 1 2 3)(tell too))");
  CHECK(records() == Texts{"link 0 0 0", "queued", "too"});
  CHECK(h.logged("test.rsg:2:26: class Probe has no method 'setLocalPos'"));
}

TEST_CASE("calls of an imported file run at its own end, before those of the importing file") {
  SceneHost h;
  h.write("inner.rsg", "(RSG 0 1)((nd Probe (tell inner)(attach ../before)(attach ../after)))");
  h.run("(nd Probe (setName before)(tell outer)) (importScene inner.rsg) (nd Probe (setName after))");
  CHECK(records() ==
        Texts{"link 0 0 0", "link 0 0 0", "inner", "../before is there", "../after is missing", "link 0 0 0", "outer"});
}

TEST_CASE("a node is linked at the pose that its transform has at this position in the file") {
  SceneHost h;
  h.run("(nd Transform (setLocalPos 1 0 0) (nd Probe) (setLocalPos 2 0 0) (nd Probe))");
  CHECK(records() == Texts{"link 1 0 0", "link 2 0 0"});
}

TEST_CASE("each eval rounds to six digits, which can be switched off") {
  SceneHost h;
  h.run("(def $pi 3.14159265)(nd Probe (tell (eval $pi * (eval 351.77 / 180.0)))(tell (eval 1.0 / 3 * 3)))");
  CHECK(records() == Texts{"link 0 0 0", "6.13955", "1"});
  records().clear();
  h.run("(nd Probe (tell (eval (eval 1.0 / 3) * 3)))");
  CHECK(records().back() == "0.999999");
  h.set("evalDigits6", false);
  h.run("(nd Probe (tell (eval (eval 1.0 / 3) * 3)))");
  CHECK(records().back() == "1");
}

TEST_CASE("lists in variables are indexed from 0 and may contain texts") {
  SceneHost h;
  Leaf& types = h.kernel.create("Variables", "/sys/variables/NaoType");
  setProperty(types, "value",
              List{List{List{"UseToe", "false"}}, List{List{"UseToe", "true"}, List{"Length", 0.0477}}});
  h.run(
      "(templ $type)(nd Probe (tell (eval \"NaoType[\"$type\"]['UseToe']\"))(tell (eval NaoType[ 1 \"]['Length']\")))",
      {1});
  CHECK(records() == Texts{"link 0 0 0", "true", "0.0477"});
}

TEST_CASE("the only bools are true and false, and an invalid number is 0") {
  SceneHost h;
  h.run("(nd Probe (setName p)(setNumber 3)(setNumber garbage)(setFlag true)(setFlag 0)(setInteger 60.9))");
  CHECK(h.probe("p").number() == 0);
  CHECK(h.probe("p").flag());
  CHECK(h.probe("p").integer() == 60);
  CHECK(h.logged("setFlag of Probe is skipped"));
}

TEST_CASE("a call with a wrong number of arguments is skipped, with one warning for its position") {
  SceneHost h;
  const std::string body = "(nd Probe (setName p)(setSlip 0.1 0.1)(setVector 1 2)(setVector 4 5 6)(setNumber))";
  h.run(body);
  CHECK(h.probe("p").slip() == 0.005);
  CHECK(h.probe("p").vector() == Vec3(4, 5, 6));
  h.import("test.rsg");
  CHECK(h.timesLogged("setSlip of Probe is skipped") == 1);
  CHECK(h.timesLogged("test.rsg:2:24") == 1);
  h.set("looseArguments", false);
  CHECK_THROWS_WITH(h.import("test.rsg"), Catch::Contains("setSlip") && Catch::StartsWith("test.rsg:2:24: "));
}

TEST_CASE("switch runs only the first list of the first case that matches, and fails if no case matches") {
  SceneHost h;
  h.run(
      "(def $v b)(switch $v (a (nd Probe (setName a))) (b (nd Probe (setName b)) (nd Probe (setName c))) (b (nd Probe "
      "(setName d))))");
  CHECK(h.scene->child("b"));
  CHECK_FALSE(h.scene->child("a"));
  CHECK_FALSE(h.scene->child("c"));
  CHECK_FALSE(h.scene->child("d"));
  h.run("(switch 1 (1))(switch x)(switch (eval 1 + 1) ((join 2) (nd Probe (setName two))))");
  CHECK(h.scene->child("two"));
  CHECK(h.failure("(switch 1 (1.0 (nd Probe)))(nd Probe (setName never))") ==
        "test.rsg:2:3: no case matches '1', there are '1.0'");
  CHECK_FALSE(h.scene->child("never"));
  CHECK(h.failure("(switch x y)").find("expected a case") != std::string::npos);
}

TEST_CASE("an error in a case does not stop the file, unless strict is on") {
  SceneHost h;
  h.run("(switch 1 (1 (nd Nothing)))(nd Probe (setName after))");
  CHECK(h.scene->child("after"));
  CHECK(h.logged("there is no class 'Nothing'"));
  h.set("strict", true);
  CHECK(h.failure("(switch 1 (1 (nd Nothing)))").find("there is no class 'Nothing'") != std::string::npos);
}

TEST_CASE("a file that fails keeps its nodes, and its queued calls run") {
  SceneHost h;
  CHECK(h.failure("(nd Probe (setName kept)(tell queued)) (nd Transform (nd Missing)) (nd Probe (tell never))")
            .find("test.rsg:2:") == 0);
  CHECK(h.scene->child("kept"));
  CHECK(records() == Texts{"link 0 0 0", "queued"});
}

TEST_CASE("transforms that contain only transforms are removed, and world poses stay the same") {
  SceneHost h;
  h.run(
      "(nd Transform (setName outer)(setLocalPos 0 0 1)(setLocalRotation 0 0 90)"
      " (nd Transform (setName a)(setLocalPos 1 0 0)(nd Probe)) (nd Transform (setName b)(setLocalPos 2 0 0)(nd Probe))"
      " (nd Transform (setName empty)))"
      "(nd Transform (setName alone))");
  CHECK(h.scene->children().size() == 2);
  CHECK_FALSE(h.scene->child("outer"));
  CHECK_FALSE(h.scene->child("alone"));
  const Vec3f b = positionOf(h.scene->require<Transform>("b").worldNow());
  CHECK((b - Vec3f(0, 2, 1)).norm() < 1e-6f);
  setProperty(*h.kernel.root().find("/sys/server/scene"), "flattenTransforms", false);
  h.run("(nd Transform (setName kept)(nd Transform))");
  CHECK(h.scene->child("kept"));
}

TEST_CASE("an import below a transform moves its transforms up before the outer file continues") {
  SceneHost h;
  h.write("walls.rsg", "(RSG 0 1)((nd Transform (setName wall)(nd Probe)))");
  h.run("(nd Transform (setName holder)(setLocalPos 0 0 2)(importScene walls.rsg))(nd Probe (attach ../wall))");
  CHECK_FALSE(h.scene->child("holder"));
  REQUIRE(h.scene->child("wall"));
  CHECK(records().back() == "../wall is there");
  CHECK(positionOf(h.scene->require<Transform>("wall").worldNow()).z() == 2);
}

TEST_CASE("transforms that existed before an import are kept, with the nodes imported into them") {
  SceneHost h;
  h.write("room.rsg",
          "(RSG 0 1)((nd Transform (nd Transform (setName chair)(nd Probe))) (nd Transform (setName table)(setLocalPos "
          "2 0 0)(nd Probe)))");
  auto& room = h.scene->create<Transform>("Transform", "room");
  h.scene->create("Transform", "marker");
  callMethod(room, "importScene", List{"room.rsg"});
  CHECK(room.children().size() == 2);  // the file's own outer transform is removed
  REQUIRE(room.child("chair"));
  room.setLocalPos({10, 0, 0});
  CHECK(positionOf(room.require<Transform>("table").worldNow()).x() == 12);
  h.run("(nd Transform (setName more)(nd Transform (setName shelf)(nd Probe)))");
  CHECK(h.scene->child("room"));
  CHECK(h.scene->child("marker"));
  CHECK(h.scene->child("shelf"));
  CHECK_FALSE(h.scene->child("more"));
}

TEST_CASE("an invalid position ends the import with file, line and column, with and without strict") {
  SceneHost h;
  const bool strict = GENERATE(false, true);
  setProperty(*h.kernel.root().find("/sys/server/scene/rsg"), "strict", strict);
  h.write("nowhere.rsg", "(RSG 0 1)\n((nd Transform (setName t)\n  (setLocalPos nan 0 1)))");
  h.write("far.rsg", "(RSG 0 1)\n((nd Transform (setLocalPos 1e300 0 0)))");
  CHECK_THROWS_WITH(callMethod(*h.scene, "importScene", List{"nowhere.rsg"}),
                    Catch::Contains("nowhere.rsg:3:4: ") &&
                        Catch::Contains("expected a position of finite numbers from -1e9 to 1e9, found nan 0.0 1.0"));
  CHECK_THROWS_WITH(callMethod(*h.scene, "importScene", List{"far.rsg"}),
                    Catch::Contains("far.rsg:2:17: ") && Catch::Contains("found inf 0.0 0.0"));
}

TEST_CASE("methods and classes have short names") {
  SceneHost h;
  h.run(
      "(nd Probe (sSc 2)(sMat matRed)(att ../x)) (node TRF (setName t)(SLT 1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1)(nd Probe)) "
      "(nd BN (setName b)) (nd SMN (setName s))");
  CHECK(records() == Texts{"link 0 0 0", "link 7 8 9", "scale 2", "material matRed", "../x is missing"});
  CHECK(h.scene->require<Transform>("t").localPos() == Vec3f(7, 8, 9));
  CHECK(h.scene->child("b")->classObject()->name() == "BaseNode");
  CHECK(h.scene->child("s")->classObject()->name() == "SingleMatNode");
}

TEST_CASE("atoms after a class name are a call with the rest of the list") {
  SceneHost h;
  h.run("(nd Probe setVector 1 2 3)(nd Probe (setName p) setNumber 4)(nd Transform nd Probe setName deep)");
  CHECK(dynamic_cast<Probe&>(*h.scene->children()[0]).vector() == Vec3(1, 2, 3));
  CHECK(h.probe("p").number() == 4);
  CHECK(h.scene->find("Transform/deep"));
}
