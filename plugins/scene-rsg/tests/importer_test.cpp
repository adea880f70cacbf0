#include <catch2/catch.hpp>

#include "scene_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a file is accepted only with a valid header and version 0 1, or 0 2") {
  SceneHost h;
  for (const char* good :
       {"(RSG 0 1)(nd Probe)", "(RubySceneGraph 0 1)((nd Probe))", "; first\n(RSG 0 1) (nd Probe (setName x))"}) {
    INFO(good);
    h.write("a.rsg", good);
    CHECK_NOTHROW(h.import("a.rsg"));
  }
  CHECK(h.scene->children().size() == 3);
  for (const char* bad : {"(RSG 0 3)(nd Probe)", "(RDS 0 2)()", "(RSG 1 1)()", "(RSG 0)()", "(XSG 0 1)()", "RSG",
                          "()()", "", "<xml/>", "((RSG) 0 1)()"}) {
    INFO(bad);
    h.write("a.rsg", bad);
    CHECK_THROWS_WITH(h.import("a.rsg"), Catch::StartsWith("a.rsg:") && Catch::Contains("expected"));
  }
  CHECK(h.scene->children().size() == 3);
}

TEST_CASE("a file with unbalanced brackets changes nothing, or removes all nodes with unlinkOnUnreadable") {
  SceneHost h;
  h.run("(nd Probe)");
  h.write("broken.rsg", "(RSG 0 1)\n((nd Probe)\n (nd Probe (tell x)\n)");
  CHECK_THROWS_WITH(h.import("broken.rsg"), Catch::StartsWith("broken.rsg:"));
  CHECK(h.scene->children().size() == 1);
  h.set("unlinkOnUnreadable", true);
  CHECK_THROWS_AS(h.import("nowhere.rsg"), Error);
  CHECK(h.scene->children().size() == 1);
  CHECK_THROWS_AS(h.import("broken.rsg"), Error);
  CHECK(h.scene->children().empty());
}

TEST_CASE("a file is parsed again only if it has changed") {
  SceneHost h;
  h.write("leg.rsg", "(RSG 0 1)((templ $n)(nd Probe (setName $n)))");
  h.write("robot.rsg", "(RSG 0 1)((importScene leg.rsg l)(importScene leg.rsg r))");
  h.import("robot.rsg");
  CHECK(h.count("filesParsed") == 2);
  CHECK(h.count("imports") == 3);
  h.import("robot.rsg");
  CHECK(h.count("filesParsed") == 2);
  CHECK(h.scene->children().size() == 4);
  h.write("leg.rsg", "(RSG 0 1)((templ $n)(nd Probe)(nd Probe))");
  h.import("robot.rsg");
  CHECK(h.count("filesParsed") == 3);
  CHECK(h.scene->children().size() == 8);
}

TEST_CASE("errors have file, line and column, and suggest similar names") {
  SceneHost h;
  CHECK(h.failure("(nd\n  Transfrom)").find("test.rsg:2:3: there is no class 'Transfrom'. Did you mean 'Transform'") ==
        0);
  CHECK(h.failure("\n\n   (nd Probe (tell $what))").find("test.rsg:4:20: there is no variable $what here") == 0);
  CHECK(h.failure("(def $size 1)(nd Probe (tell $sise))").find("Did you mean '$size'") != std::string::npos);
  CHECK(h.failure("(templ $a $b)(nd Probe (tell $b))", {1})
            .find("parameter $b was not given: the import passed 1 arguments") != std::string::npos);
  CHECK(h.failure("(nd Probe (tell (eval 1 +)))").find("test.rsg:2:18: expected a number") == 0);
  CHECK(h.failure("(nd Probe (tell (evil 1)))").find("begins with 'evil'") != std::string::npos);
  CHECK(h.failure("(nd (Probe))").find("expected a name after 'node'") != std::string::npos);
  CHECK(h.failure("(nd SceneServer)").find("does not derive from BaseNode") != std::string::npos);
  CHECK(h.failure("(nd $Class)").find("there is no class '$Class'") != std::string::npos);
  CHECK(h.failure("(nd RenderNode)").find("cannot be made itself") != std::string::npos);
  CHECK(h.failure("(templ $a $a)").find("exists already") != std::string::npos);
  CHECK(h.failure("(templ a)").find("expected a parameter") != std::string::npos);
  CHECK(h.failure("(def a 1)").find("expected a variable") != std::string::npos);
  CHECK(h.failure("(def $a)").find("expected a value") != std::string::npos);
  CHECK(h.failure("(sel none)").find("there is no scene node 'none'") != std::string::npos);
  CHECK(h.failure("(nd Probe (tell (eval Socer.X)))").find("there are no variables 'Socer'") != std::string::npos);
  h.run("(nd Probe (tel x))");
  CHECK(h.logged("class Probe has no method 'tel'. Did you mean 'tell'"));
}

TEST_CASE("a failing import within a file fails the outer one, which continues to its end") {
  SceneHost h;
  h.write("c.rsg", "(RSG 0 1)\n((nd Missing))");
  h.write("b.rsg", "(RSG 0 1)\n(\n(importScene c.rsg)(nd Probe (setName inner)))");
  const std::string why = h.failure("(importScene b.rsg)(nd Probe (setName after))(importScene none.rsg)");
  CHECK(why.find("the import of 'b.rsg' failed") != std::string::npos);
  CHECK(why.find("c.rsg:2:3: there is no class 'Missing'") != std::string::npos);
  CHECK(h.scene->child("inner"));
  CHECK(h.scene->child("after"));
  CHECK(h.logged("there is no resource 'none.rsg'"));  // one is thrown, the others are logged
}

TEST_CASE("with looseImports a failing import within a file is logged with the chain of imports") {
  SceneHost h;
  h.set("looseImports", true);
  h.write("c.rsg", "(RSG 0 1)\n((nd Missing))");
  h.write("b.rsg", "(RSG 0 1)\n(\n(importScene c.rsg))");
  h.run("(importScene b.rsg)(nd Probe (setName after))(importScene none.rsg)(importScene)(importScene ../up.rsg)");
  CHECK(h.scene->child("after"));
  CHECK(h.logged("b.rsg:3:2: the import of 'c.rsg' failed, the rest goes on: c.rsg:2:3: there is no class 'Missing'"));
  CHECK(h.logged("(imported from test.rsg:2:3)"));
  CHECK(h.logged("there is no resource 'none.rsg'"));
  CHECK(h.logged("'..'"));
  h.set("strict", true);
  CHECK(h.failure("(importScene b.rsg)").find("c.rsg:2:3: there is no class 'Missing'") != std::string::npos);
}

TEST_CASE("a file beside the importing one has one name, however it is written") {
  SceneHost h;
  h.set("looseImports", true);
  h.write("d/c.rsg", "(RSG 0 1)\n((nd Missing))");
  h.write("d/b.rsg", "(RSG 0 1)\n((importScene ./c.rsg)(importScene x/.././c.rsg)(importScene ././c.rsg))");
  h.run("(importScene d/b.rsg)");
  CHECK(h.logged("the import of 'd/c.rsg' failed"));
  CHECK_FALSE(h.logged("./c.rsg"));
}

TEST_CASE("missing or surplus arguments do not change the values of other parameters and definitions") {
  SceneHost h;
  const std::string body = "(templ $a $b)(def $c 3)(def $d 4)(nd Probe (tell $a)(tell $c)(tell $d))";
  h.run(body, {"1"});
  CHECK(records() == Texts{"link 0 0 0", "1", "3", "4"});
  records().clear();
  h.run(body, {"1", "2", "surplus", "more"});
  CHECK(records() == Texts{"link 0 0 0", "1", "3", "4"});
}

TEST_CASE("without defineByName, missing or surplus arguments shift definitions as in the installed base") {
  SceneHost h;
  h.set("defineByName", false);
  CHECK(h.failure("(templ $a $b)(def $c 3)(def $d 4)(nd Probe (tell $b)(tell $c)(tell $d))", {"1"})
            .find("$d was not given") != std::string::npos);
  CHECK(records() == Texts{"link 0 0 0", "3", "4"});
  records().clear();
  h.run("(templ $a)(def $b 5)(def $a 6)(nd Probe (tell $a)(tell $b))", {"1", "surplus"});
  CHECK(records() == Texts{"link 0 0 0", "6", "surplus"});
}

TEST_CASE("arguments of scripts are converted to text") {
  SceneHost h;
  h.run("(templ $a $b $c)(nd Probe (setName $a)(setNumber $b)(setFlag $c))", {"x", 2.5, true});
  CHECK(h.probe("x").number() == 2.5);
  CHECK(h.probe("x").flag());
  CHECK(h.failure("(templ $a)", {Value(List{1, 2})}).find("argument 1") != std::string::npos);
}

TEST_CASE("join concatenates, and join and eval can be nested in each other") {
  SceneHost h;
  h.run(
      "(def $n 2)(nd Probe (tell (join ../ a $n /b))(tell (join x (eval $n * 2)))(tell (eval (join 1 0) + 1))"
      "(tell (join))(tell a$n)(tell '$n'))");
  CHECK(records() == Texts{"link 0 0 0", "../a2/b", "x4", "11", "", "a$n", "2"});
}

TEST_CASE("sel continues in an existing child, and pwd has no effect") {
  SceneHost h;
  h.run("(nd Transform (setName t)(nd Probe (setName p)))");
  h.run("(sel t pwd (select p (tell selected)))(pwd)");
  CHECK(records().back() == "selected");
}

TEST_CASE("class names may be preceded by a path") {
  SceneHost h;
  h.run("(nd oxygen/Transform (nd kerosin/Box (setName box)))");
  CHECK(h.scene->find("Transform/box"));
}

TEST_CASE("calls on removed nodes are logged, and a scene cannot remove its root") {
  SceneHost h;
  h.run(
      "(nd Transform (nd Probe (tell never)) (unlinkChildren)) (nd Probe (tell before)(unlinkLeaf)) (nd Probe (tell "
      "after))");
  CHECK(h.timesLogged("was removed before it was made") == 2);
  CHECK(records() == Texts{"link 0 0 0", "link 0 0 0", "link 0 0 0", "after"});
  CHECK(h.failure("(nd Transform (unlinkLeaf) (nd Probe))").find("was removed") != std::string::npos);
  CHECK(h.failure("(unlinkLeaf)").find("cannot remove the node") != std::string::npos);
}

TEST_CASE("a delta scene changes the existing children in order") {
  SceneHost h;
  h.run("(nd Transform (setName a)(nd Probe (setName p)))(nd Transform (setName b)(nd Probe))");
  h.write("delta.rsg",
          "(RDS 0 1)((nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1)(nd (setNumber 5)))(nd (SLT 1 0 0 0 0 1 0 0 0 0 1 0 "
          "2 0 0 1)))");
  h.import("delta.rsg");
  CHECK(h.scene->require<Transform>("a").localPos().x() == 1);
  CHECK(h.scene->require<Transform>("b").localPos().x() == 2);
  CHECK(h.probe("a/p").number() == 5);
  h.write("delta.rsg", "(RDS 0 1)((nd)(nd)(nd))");
  CHECK_THROWS_WITH(h.import("delta.rsg"), Catch::Contains("expected at most 2 nodes"));
}

TEST_CASE("with unlinkOnCompleteScenes a complete scene replaces the existing nodes") {
  SceneHost h;
  h.set("unlinkOnCompleteScenes", true);
  h.write("inner.rsg", "(RSG 0 1)((nd Probe))");
  h.run("(nd Probe)(importScene inner.rsg)");
  h.import("test.rsg");
  CHECK(h.scene->children().size() == 2);
}

namespace {
/// An importer of another format: "list", followed by files. Each file is imported below its own probe.
class ListImporter : public Node, public ISceneImporter {
  SPARK_CLASS(ListImporter, Node)
 public:
  static void describe(Description<ListImporter>& d) {
    d.doc("Imports lists of files.");
    d.implements<ISceneImporter>();
  }
  bool recognises(std::string_view text, std::string_view) const override { return text.starts_with("list\n"); }
  void import(std::string_view file, Node& root, const List&) override {
    std::istringstream lines(kernel().root().require<IFileServer>("/sys/server/file").read(file));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
      auto& probe = root.create<Node>("Probe", "of");
      kernel().root().require<ISceneServer>("/sys/server/scene").importScene(line, probe, {});
    }
  }
};
}  // namespace

TEST_CASE("importers of different formats can be nested, and an error has the chain of all files") {
  SceneHost h;
  h.kernel.registerClass<ListImporter>();
  h.kernel.create("ListImporter", "/sys/server/scene/list");
  h.write("inner.toy", "list\nleaf.rsg\nleaf.rsg\n");
  h.write("leaf.rsg", "(RSG 0 1)((nd Transform (setName leaf)(setLocalPos 0 0 1)(nd Probe)))");
  h.run("(nd Transform (setName a)(nd Probe (setName p)(importScene inner.toy)))(nd Probe (setName b))");
  REQUIRE(h.scene->find("a/p/of[2]/leaf/Probe"));
  CHECK(h.scene->find("a/p/of[1]/leaf"));
  CHECK(h.scene->find("b"));
  h.write("inner.toy", "list\nleaf.rsg\ngone.rsg\n");
  h.set("looseImports", true);
  h.run("(nd Transform (setName c)(nd Probe (setName p)(importScene inner.toy)))(nd Probe (setName d))");
  CHECK(h.logged("the import of 'inner.toy' failed"));
  CHECK(h.logged("gone.rsg"));
  CHECK(h.scene->find("c/p/of[1]/leaf"));
  CHECK(h.scene->find("d"));
  h.set("strict", true);
  const std::string text = h.failure("(nd Probe (importScene inner.toy))");
  CHECK(text.find("test.rsg:2:13: ") == 0);
  CHECK(text.find("gone.rsg") != std::string::npos);
}

TEST_CASE("with strict, calls that are otherwise ignored are errors") {
  SceneHost h;
  h.set("strict", true);
  CHECK(h.failure("(nd Probe (setVector 1 2))").find("test.rsg:2:13: ") == 0);
  CHECK(h.failure("(nd Probe (setNumber garbage))").find("expected number") != std::string::npos);
  CHECK(h.failure("(nd Probe (nothing))").find("has no method") != std::string::npos);
  CHECK(h.failure("(nd Probe (setVector 1 2 3)(setFlag true)(setNumber 1e-5)(setName ok))").empty());
}
