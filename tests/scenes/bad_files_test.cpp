// Files of each language that cannot be imported: the error says where, and the scene is as before.

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "import_house.h"

using namespace spark;
using namespace spark::test;

namespace {

struct BadFile {
  const char* what;
  std::string name, text;
  std::string place;    ///< file:line:column, at which the message begins, or file:line:
  std::string message;  ///< is part of it
};

std::string repeated(int n, const std::string& text) {
  std::string out;
  for (int i = 0; i < n; ++i) out += text;
  return out;
}

/// A robot of the scene language with a body, a collider and a hinge, before `last`.
std::string rsg(const std::string& last, const char* version = "0 2") {
  return fmt::format(
      "(RSG {})\n((nd Space (setName robot)\n(nd Transform (setName a)(setLocalPos 0 0 1)(nd RigidBody (setName body)"
      "(setSphereTotal 1 0.1))(nd SphereCollider (setRadius 0.1)))\n(nd Transform (setName b)(nd RigidBody (setName "
      "body))(nd HingeJoint (attach ../body ../../a/body)(setAxis 0)))\n{}))",
      version, last);
}

std::vector<BadFile> badRsg() {
  return {
      {"truncated", "t.rsg", rsg("").substr(0, 150), "t.rsg:2:1: ", "not closed"},
      {"truncated header", "t.rsg", "(RSG 0 2", "t.rsg:1:", ""},
      {"imports itself", "c.rsg", rsg("(importScene c.rsg)"), "c.rsg:5:2: ", "does a file import itself?"},
      {"missing file", "m.rsg", rsg("(importScene none.rsg)"), "m.rsg:5:2: ", "none.rsg"},
      {"missing mesh", "m.rsg", rsg("(nd TriMeshCollider (set mesh none.obj))"), "m.rsg:5:22: ", "none.obj"},
      {"NaN position", "n.rsg", rsg("(nd Transform (setLocalPos 0 nan 0))"), "n.rsg:5:16: ", "nan"},
      {"NaN by set", "n.rsg", rsg("(nd Transform (set localPos 0 nan 0))"), "n.rsg:5:16: ", "finite"},
      {"infinite anchor", "n.rsg", rsg("(nd HingeJoint (setAnchor 0 0 1e400))"), "n.rsg:5:17: ", "setAnchor"},
      {"absurd radius", "s.rsg", rsg("(nd SphereCollider (setRadius -1))"), "s.rsg:5:21: ", "setRadius"},
      {"absurd position", "s.rsg", rsg("(nd Transform (setLocalPos 1e30 0 0))"), "s.rsg:5:16: ", "1e9"},
      {"unknown class", "u.rsg", rsg("(nd Sphare)"), "u.rsg:5:2: ", "there is no class 'Sphare'"},
      {"unknown method", "u.rsg", rsg("(nd Sphere (setSize 1))"), "u.rsg:5:13: ", "has no method 'setSize'"},
      {"unknown property", "u.rsg", rsg("(nd Sphere (set size 1))"), "u.rsg:5:13: ", "has no property 'size'"},
      {"grows by imports", "g.rsg", rsg(repeated(3, "(importScene h.rsg)")), "g.rsg:5:", "too many imports"},
      {"too deep", "d.rsg", "(RSG 0 2)" + repeated(3000, "(") + repeated(3000, ")"), "d.rsg:1:", ""},
  };
}

std::string mjcf(const std::string& inBody, const std::string& after = "", const std::string& before = "") {
  return "<mujoco model='m'>" + before + "\n<worldbody>\n<body name='b'>" + inBody + "</body></worldbody>" + after +
         "</mujoco>";
}

std::vector<BadFile> badMjcf() {
  const std::string ball = "<freejoint/><geom size='.1'/>";
  return {
      {"truncated", "t.xml", mjcf(ball).substr(0, 60), "t.xml:", "this is not XML"},
      {"only a name", "t.mjcf", "   ", "t.mjcf:1:", "this is not XML"},
      {"includes itself", "c.xml", mjcf(ball, "\n<include file='c.xml'/>"), "c.xml:4:1: ", "c.xml"},
      {"missing mesh", "m.xml",
       mjcf(ball + "<geom type='mesh' mesh='x'/>", "", "<asset>\n<mesh name='x' file='none.stl'/></asset>"),
       "m.xml:4:", "none.stl"},
      {"NaN position", "n.xml", mjcf(ball + "\n<site pos='0 nan 0'/>"), "n.xml:4:1: ", "expected 3 numbers"},
      {"infinite position", "n.xml", mjcf(ball + "\n<site pos='0 1e400 0'/>"), "n.xml:4:1: ", "expected 3 numbers"},
      {"absurd position", "s.xml", mjcf(ball + "\n<body pos='1e200 0 0'><joint/><geom size='1'/></body>"),
       "s.xml:", ""},
      {"absurd size", "s.xml", mjcf("<freejoint/>\n<geom size='-1'/>"), "s.xml:4:1: ", "above 0"},
      {"no mass", "s.xml", mjcf("<freejoint/>"), "s.xml:3:1: ", "has no mass"},
      {"late error", "l.xml", mjcf(ball, "<actuator>\n<motor joint='none'/></actuator>"),
       "l.xml:4:1: ", "there is no joint 'none'"},
      {"too deep", "d.xml", mjcf(repeated(300, "<body>") + repeated(300, "</body>")), "d.xml:3:", "200 elements"},
  };
}

std::string urdf(const std::string& text) {
  return "<robot name='r'>\n<link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
         "izz='1'/></inertial></link>\n" +
         text + "</robot>";
}

std::vector<BadFile> badUrdf() {
  const auto shape = [](const std::string& s) {
    return urdf("<link name='b'><collision><geometry>\n" + s +
                "</geometry></collision></link><joint name='j' type='fixed'>"
                "<parent link='a'/><child link='b'/></joint>");
  };
  const std::string joint = "<link name='b'/><joint name='j' type='fixed'><parent link='a'/><child link='b'/>\n";
  return {
      {"truncated", "t.urdf", urdf("").substr(0, 70), "t.urdf:2:", "this is not XML"},
      {"only a name", "t.urdf", "robot", "t.urdf:1:", "this is not XML"},
      {"links in a circle", "c.urdf",
       urdf(joint + "</joint><joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>"),
       "c.urdf:1:1: ", "each link is the child of a joint"},
      {"missing mesh", "m.urdf", shape("<mesh filename='none.stl'/>"), "m.urdf:4:1: ", "none.stl"},
      {"mesh outside", "m.urdf", shape("<mesh filename='../../etc/passwd'/>"), "m.urdf:4:1: ", "cannot read the mesh"},
      {"NaN position", "n.urdf", urdf(joint + "<origin xyz='0 nan 0'/></joint>"), "n.urdf:4:1: ", "nan"},
      {"infinite position", "n.urdf", urdf(joint + "<origin xyz='0 inf 0'/></joint>"), "n.urdf:4:1: ", "inf"},
      {"absurd size", "s.urdf", shape("<sphere radius='0'/>"), "s.urdf:4:1: ", "above 0"},
  };
}

std::string webots(const std::string& text) {
  return "#VRML_SIM R2023b utf8\nSolid { name \"s\" boundingObject Box { } physics Physics { } }\n" + text;
}

std::vector<BadFile> badWebots() {
  return {
      {"truncated", "t.wbt", webots("Solid { translation 0 "), "t.wbt:3:", "expected"},
      {"only a name", "t.wbt", "Solid { }", "t.wbt:1:1: ", "VRML_SIM"},
      {"PROTO of itself", "c.wbt", webots("PROTO P [ ] { Group { children P { } } }\nP { }"),
       "c.wbt:", "contains itself"},
      {"missing mesh", "m.wbt", webots("Solid { boundingObject Mesh { url \"none.stl\" } }"),
       "m.wbt:3:24: ", "none.stl"},
      {"missing PROTO", "m.wbt", webots("None { }"), "m.wbt:3:1: ", "'None' is empty"},
      {"NaN position", "n.wbt", webots("Solid { translation 0 nan 0 }"), "n.wbt:3:", ""},
      {"infinite position", "n.wbt", webots("Solid { translation 0 1e400 0 }"), "n.wbt:3:", ""},
      {"absurd position", "s.wbt", webots("Solid { translation 1e300 0 0 }"), "s.wbt:3:", "at most 1e+06"},
      {"absurd size", "s.wbt", webots("Solid { boundingObject Sphere { radius -1 } }"), "s.wbt:3:", "above 0"},
      {"too deep", "d.wbt", webots(repeated(500, "Group { children ") + repeated(500, "}")), "d.wbt:3:", ""},
  };
}

/// Each file fails as the table says and leaves the scene as it was.
void checkAll(const std::vector<BadFile>& files, const char* transactional) {
  ImportHost h;
  h.setTransactional(transactional);
  // Otherwise one bad part is left out, and the file is imported.
  for (const char* importer : {"mjcf", "urdf", "webots"})
    setProperty(h.kernel.root().require<Leaf>(std::string("/sys/server/scene/") + importer), "strict", true);
  h.folder.write("h.rsg", "(RSG 0 2)(" + repeated(5000, "(importScene i.rsg)") + ")");
  h.folder.write("i.rsg", "(RSG 0 2)((nd Transform))");
  h.step(20);
  const std::uint64_t hash = h.hash();
  const std::size_t count = countBelow(h.kernel.root().require<Node>("/usr"));
  for (const BadFile& file : files) {
    INFO(file.what << ", " << file.name);
    h.folder.write(file.name, file.text);
    const std::string message = h.failure(file.name);
    CHECK_THAT(message, Catch::StartsWith(file.place) && Catch::Contains(file.message));
    CHECK(countBelow(h.kernel.root().require<Node>("/usr")) == count);
    CHECK(h.hash() == hash);
    std::filesystem::remove(h.folder.path() / file.name);
  }
  h.step(20);
  ImportHost alone;
  alone.step(40);
  CHECK(h.scene.require<IRigidBody>("crate/body").state().position ==
        alone.scene.require<IRigidBody>("crate/body").state().position);
}

}  // namespace

TEST_CASE("bad files of the scene language in our version leave the scene as it was") {
  checkAll(badRsg(), "byLanguage");
}

TEST_CASE("bad MJCF files leave the scene as it was") { checkAll(badMjcf(), "byLanguage"); }

TEST_CASE("bad URDF files leave the scene as it was") { checkAll(badUrdf(), "byLanguage"); }

TEST_CASE("bad Webots files leave the scene as it was") { checkAll(badWebots(), "byLanguage"); }

TEST_CASE("bad files of the installed base leave the scene as it was if transactionalImport is true") {
  const auto base = [](const std::string& last) { return rsg(last, "0 1"); };
  checkAll(
      {{"truncated", "t.rsg", base("").substr(0, 150), "t.rsg:2:1: ", "not closed"},
       {"NaN position", "n.rsg", base("(nd Transform (setLocalPos 0 nan 0))"), "n.rsg:5:16: ", "nan"},
       {"unknown class", "u.rsg", base("(nd Sphare)"), "u.rsg:5:2: ", "there is no class 'Sphare'"},
       {"no case", "w.rsg", base("(switch a (b (nd Transform)))"), "w.rsg:5:2: ", "no case matches"},
       {"renames", "r.rsg", "(RSG 0 1)((setName other)(setLocalPos 1 2 3)\n(nd Sphare))", "r.rsg:2:2: ", "Sphare"},
       {"removes", "r.rsg", "(RSG 0 1)((nd Transform)(sel p)\n(nd Sphare))", "r.rsg:1:", "there is no scene node 'p'"}},
      "true");
}

TEST_CASE("a bad file of the installed base leaves what came before the error, unless transactionalImport is true") {
  ImportHost h;
  h.folder.write("u.rsg", rsg("(nd Sphare)", "0 1"));
  CHECK_THAT(h.failure("u.rsg"), Catch::StartsWith("u.rsg:5:2: "));
  CHECK(h.place.find("robot/a/body"));
  CHECK(h.kernel.root().require<ISceneServer>().imports().size() == 1);
  h.place.removeChildren();
  h.setTransactional("true");
  CHECK_THAT(h.failure("u.rsg"), Catch::StartsWith("u.rsg:5:2: "));
  CHECK(h.place.children().empty());
  CHECK(h.kernel.root().require<ISceneServer>().imports().size() == 1);
  h.setTransactional("false");
  h.folder.write("u.rsg", rsg("(nd Sphare)", "0 2"));
  CHECK_THAT(h.failure("u.rsg"), Catch::StartsWith("u.rsg:5:2: "));
  CHECK(h.place.find("robot/a/body"));
}
