// Reads models from MJCF texts.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <map>

#include "../model.h"

using namespace spark;
using namespace spark::mjcf;

namespace {

using Files = std::map<std::string, std::string>;

struct Read {
  LeftOver leftOver;
  std::unique_ptr<Document> document;
  Model model;
  explicit Read(const std::string& text, Files files = {}) {
    files["a.xml"] = text;
    document = std::make_unique<Document>("a.xml", [files](const std::string& name) {
      const auto found = files.find(name);
      if (found == files.end()) throw Error("there is no file '" + name + "'");
      return found->second;
    });
    model = readModel(
        *document,
        [](const std::string&) {
          // A cube of 1 m.
          engine::ShapeDescription s{.shape = engine::Shape::mesh};
          for (int i = 0; i < 8; ++i)
            for (int k = 0; k < 3; ++k) s.vertices.push_back((i >> k) & 1);
          s.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
          return s;
        },
        leftOver);
  }
  const Body& body(std::size_t i) const { return model.bodies.at(i); }
  /// The messages about unsupported elements and attributes, one per line.
  std::string messages() const {
    std::string out;
    for (const std::string& s : leftOver.sentences()) out += s + "\n";
    return out;
  }
};

std::string world(const std::string& content) { return "<mujoco><worldbody>" + content + "</worldbody></mujoco>"; }
std::string failure(const std::string& text, Files files = {}) {
  try {
    Read(text, std::move(files));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("angles are in degrees unless the compiler element says otherwise, and orientations have five notations") {
  const Mat3 quarter = Read(world("<body euler='0 0 90'/>")).body(1).pose.rotation;
  CHECK(quarter.col(0).isApprox(Vec3::UnitY()));
  for (const char* notation : {"quat='2 0 0 2'", "axisangle='0 0 3 90'", "xyaxes='0 2 0 -1 1 0'", "euler='0 0 90'"})
    CHECK(Read(world("<body " + std::string(notation) + "/>")).body(1).pose.rotation.isApprox(quarter, 1e-12));
  CHECK(Read(world("<body zaxis='1 0 0'/>")).body(1).pose.rotation.col(2).isApprox(Vec3::UnitX()));
  const std::string radian =
      "<mujoco><compiler angle='radian' eulerseq='XYZ'/><worldbody><body euler='0.1 0.2 0.3'/></worldbody></mujoco>";
  const Mat3 fixed = (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(0.2, Vec3::UnitY()) *
                      Eigen::AngleAxisd(0.1, Vec3::UnitX()))
                         .toRotationMatrix();
  CHECK(Read(radian).body(1).pose.rotation.isApprox(fixed));
}

TEST_CASE("default classes can be nested, and child bodies inherit their parent's class") {
  const Read r(R"(<mujoco><default><geom size='1' friction='0.5'/><joint damping='3'/>
    <default class='leg'><joint armature='0.2'/><default class='toe'><joint damping='4'/></default></default></default>
    <worldbody><body childclass='leg'><joint name='a'/><geom/><body><joint class='toe'/><geom size='2'/>
    <body childclass='toe'><joint/><geom/></body></body></body></worldbody></mujoco>)");
  CHECK(r.body(1).joints[0].damping == 3);
  CHECK(r.body(1).joints[0].armature == 0.2);
  CHECK(r.body(2).joints[0].damping == 4);
  CHECK(r.body(2).joints[0].armature == 0.2);
  CHECK(r.body(3).joints[0].damping == 4);
  CHECK(r.body(1).geoms[0].shape.radius == 1);
  CHECK(r.body(2).geoms[0].shape.radius == 2);
  CHECK(r.body(2).geoms[0].contact.friction == Vec3(0.5, 0.005, 0.0001));
  CHECK(r.messages() == "");
}

TEST_CASE("a body without an inertial element has the mass and inertia of its geoms") {
  const Read r(world(
      "<body><joint/><geom type='box' size='0.5 0.5 0.5' pos='1 0 0' density='10'/>"
      "<geom type='box' size='0.5 0.5 0.5' pos='-1 0 0' mass='30'/><geom size='1' group='4' density='0'/></body>"));
  const engine::Mass& m = r.body(1).mass;
  CHECK(m.mass == Approx(40));
  CHECK(m.center.isApprox(Vec3(-0.5, 0, 0)));
  CHECK(m.inertia(0, 0) == Approx(40 / 6.0));
  CHECK(m.inertia(1, 1) == Approx(40 / 6.0 + 10 * 1.5 * 1.5 + 30 * 0.5 * 0.5));
  const Read mesh(
      "<mujoco><asset><mesh name='cube' file='c.stl' scale='2 1 1'/></asset><worldbody><body><joint/>"
      "<geom type='mesh' mesh='cube' density='12'/></body></worldbody></mujoco>");
  CHECK(mesh.body(1).mass.mass == Approx(24));
  CHECK(mesh.body(1).mass.center.isApprox(Vec3(1, 0.5, 0.5)));
  CHECK(mesh.body(1).mass.inertia.isApprox(Mat3(Vec3(4, 10, 10).asDiagonal()), 1e-9));
}

TEST_CASE("a capsule can be given by its end points, and a joint's range limits the joint") {
  const Read r(
      world("<body><joint range='-90 45'/><joint range='1 2' limited='false'/><geom type='capsule' size='0.1' "
            "fromto='0 0 0 0 0 -2'/></body>"));
  const Geom& g = r.body(1).geoms[0];
  CHECK(g.shape.length == Approx(2));
  CHECK(g.pose.position.isApprox(Vec3(0, 0, -1)));
  CHECK(r.body(1).joints[0].limited);
  CHECK(r.body(1).joints[0].range[1] == Approx(kPi / 4));
  CHECK_FALSE(r.body(1).joints[1].limited);
}

TEST_CASE("actuators are read as gain and bias of a force on a joint") {
  const Read r(R"(<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>
    <motor joint='j' gear='3' forcerange='-2 2'/><position joint='j' kp='7'/>
    <velocity joint='j' kv='5' ctrlrange='-1 1'/>
    <general joint='j' gainprm='4' biastype='affine' biasprm='1 -2 -3'/><muscle joint='j'/></actuator></mujoco>)");
  const std::vector<Actuator>& a = r.model.actuators;
  REQUIRE(a.size() == 4);
  CHECK(a[0].gear == 3);
  CHECK(a[0].maxForce == 6);
  CHECK(a[1].bias == std::array<double, 3>{0, -7, 0});
  CHECK(a[2].bias == std::array<double, 3>{0, 0, -5});
  CHECK(a[2].controlRange == std::array<double, 2>{-1, 1});
  CHECK(a[3].gain == 4);
  CHECK(r.messages() == "a.xml:4:73: the element <muscle> is left out\n");
}

TEST_CASE("a file can include others but not itself") {
  const Files files{{"arm.xml", "<mujoco><worldbody><body name='arm'/></worldbody></mujoco>"},
                    {"loop.xml", "<mujoco><include file='loop.xml'/></mujoco>"},
                    {"self.xml", "<mujoco><include file='a.xml'/></mujoco>"}};
  const Read r("<mujoco><include file='arm.xml'/><worldbody><body name='leg'/></worldbody></mujoco>", files);
  CHECK(r.model.bodies.size() == 3);
  CHECK(r.body(1).name == "arm");
  CHECK(failure("<mujoco>\n <include file='loop.xml'/></mujoco>", files).find("loop.xml:1:9: a file includes itself") !=
        std::string::npos);
  CHECK(failure("<mujoco><include file='self.xml'/></mujoco>", files).find("includes itself") != std::string::npos);
  CHECK(failure("<mujoco>\n <include file='no.xml'/></mujoco>").find("a.xml:2:2: cannot include 'no.xml'") == 0);
}

TEST_CASE("an unsupported element or attribute is reported once, with its first position") {
  const Read r(
      "<mujoco><worldbody>\n<body colour='red'><joint/><geom size='1' rgba='1 1 1 1' wings='1'/><geom size='1' "
      "wings='1'/></body>\n"
      "</worldbody><tendon/><keyframe/></mujoco>");
  CHECK(r.messages() ==
        "a.xml:2:1: the attribute 'colour' of <body> is left out\n"
        "a.xml:2:28: the attribute 'wings' of <geom> is left out (and 1 more)\n"
        "a.xml:3:13: the element <tendon> is left out\n");
}

TEST_CASE("errors have the position, what was expected, and what was found") {
  const std::pair<const char*, const char*> cases[] = {
      {"<mujoco><worldbody><body></worldbody></mujoco>", "a.xml:1:28: this is not XML: "},
      {"<robot/>", "a.xml:1:1: expected the element <mujoco>, found <robot>"},
      {"", "a.xml:1:1: this is not XML: No document element found"},
      {"<mujoco><worldbody><body pos='1 2'/></worldbody></mujoco>",
       "a.xml:1:20: expected 3 numbers for 'pos' of <body>, found '1 2'"},
      {"<mujoco><worldbody><body pos='1 2 nan'/></worldbody></mujoco>",
       "a.xml:1:20: expected 3 numbers for 'pos' of <body>, found '1 2 nan'"},
      {"<mujoco><worldbody><geom type='cone'/></worldbody></mujoco>", "a.xml:1:20: expected plane or hfield or sphere"},
      {"<mujoco><worldbody><geom type='box' size='1 1'/></worldbody></mujoco>",
       "a.xml:1:20: the 'size' of a box needs 3 lengths above 0"},
      {"<mujoco><worldbody><geom class='x'/></worldbody></mujoco>", "a.xml:1:20: there is no default class 'x'"},
      {"<mujoco><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>", "a.xml:1:20: there is no <mesh> 'm'"},
      {"<mujoco><worldbody><joint/></worldbody></mujoco>", "a.xml:1:20: the world has no joints"},
      {"<mujoco><compiler eulerseq='xyw'/></mujoco>",
       "a.xml:1:9: expected three of x y z X Y Z for 'eulerseq', found 'xyw'"},
  };
  for (const auto& [text, message] : cases) CHECK_THAT(failure(text), Catch::StartsWith(message));
}

TEST_CASE("a model that is nested too deeply is refused") {
  std::string text;
  for (int i = 0; i < 300; ++i) text += "<body>";
  for (int i = 0; i < 300; ++i) text += "</body>";
  CHECK_THAT(failure(world(text)), Catch::Contains("expected at most 200 elements in each other"));
}

TEST_CASE("a short list of numbers replaces only the first numbers of the default") {
  const Read r(
      "<mujoco><default><geom solimp='.8 .9 .002 .4 3' size='.3 .3 .3'/></default><worldbody>"
      "<geom type='box' solimp='.7' size='.1 .15'/></worldbody></mujoco>");
  const Geom& g = r.body(0).geoms[0];
  CHECK(g.contact.solimp == std::array<double, 5>{.7, .9, .002, .4, 3});
  CHECK(g.shape.lengths.isApprox(Vec3(.2, .3, .6)));
}

TEST_CASE("all types of actuators share one default") {
  const Read r(R"(<mujoco><default><motor gear='2'/><position kp='55'/></default>
    <worldbody><body><joint name='j'/><geom size='1'/></body></worldbody>
    <actuator><position joint='j' kp='100'/><general joint='j'/><motor joint='j'/></actuator></mujoco>)");
  const std::vector<Actuator>& a = r.model.actuators;
  CHECK(a[0].gear == 2);
  CHECK(a[0].bias[1] == -100);
  CHECK(a[1].gain == 55);
  CHECK(a[1].bias[1] == -55);
  CHECK(a[2].gain == 1);
  CHECK(a[2].bias[1] == 0);
}

TEST_CASE("an ellipsoid has a mass but does not collide, and a box can be given by its end points") {
  const Read r(
      world("<body><joint/><geom type='ellipsoid' size='.1 .2 .3' density='1000'/></body>"
            "<body><joint/><geom type='box' size='.1' fromto='0 0 0 0 0 1'/></body>"));
  CHECK(r.body(1).mass.mass == Approx(1000 * 4.0 / 3 * kPi * .006));
  CHECK_FALSE(r.body(1).geoms[0].collides());
  CHECK(r.body(2).geoms[0].shape.lengths.isApprox(Vec3(.2, .2, 1)));
  CHECK_THAT(r.messages(), Catch::Contains("the shape of an ellipsoid is left out"));
}

TEST_CASE("the mass of an ellipsoid is added only if its group is in inertiagrouprange") {
  const std::string start = "<mujoco><compiler inertiagrouprange='0 4'/><worldbody><body><joint/>";
  const std::string box = "<geom type='box' size='.5 .5 .5' density='1'/>", end = "</body></worldbody></mujoco>";
  const auto mass = [&](const std::string& ellipsoid) { return Read(start + box + ellipsoid + end).body(1).mass.mass; };
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='2'/>") == Approx(3));
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='2' group='5'/>") == Approx(1));
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='0'/>") == Approx(1));
  CHECK_THAT(failure(world("<body><geom type='ellipsoid'/></body>")), Catch::Contains("the 'size' of an ellipsoid"));
}

TEST_CASE("a flat mesh is refused only if its mass is needed") {
  const auto read = [](const std::string& content) {
    LeftOver leftOver;
    const std::string text =
        "<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody>" + content + "</worldbody></mujoco>";
    Document document("a.xml", [&](const std::string&) { return text; });
    const auto triangle = [](const std::string&) {
      engine::ShapeDescription s{.shape = engine::Shape::mesh};
      s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
      s.triangles = {0, 1, 2};
      return s;
    };
    return readModel(document, triangle, leftOver).bodies.back().mass.mass;
  };
  const std::string mesh = "<geom type='mesh' mesh='m'/>";
  CHECK(read("<body><joint/><inertial pos='0 0 0' mass='3' diaginertia='1 1 1'/>" + mesh + "</body>") == 3);
  CHECK(read("<body><joint/><geom size='1' mass='2'/><geom type='mesh' mesh='m' mass='0'/></body>") == Approx(2));
  CHECK_THROWS_WITH(read("<body><joint/>" + mesh + "</body>"), Catch::Contains("the mesh has no volume"));
}

TEST_CASE("unsupported attributes of a default are reported too") {
  const Read r(
      "<mujoco><default>\n<joint springdamper='.1 1'/></default><worldbody><body><joint/><geom "
      "size='1'/></body></worldbody></mujoco>");
  CHECK(r.messages() == "a.xml:2:1: the attribute 'springdamper' of <joint> is left out\n");
}

TEST_CASE("the total number of elements in included files is limited") {
  Files files;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<include file='" + std::to_string(i + 1) + ".xml'/>";
    files[std::to_string(i) + ".xml"] = i == 39 ? "<mujoco/>" : "<mujoco>" + next + next + "</mujoco>";
  }
  CHECK_THAT(failure("<mujoco><include file='0.xml'/></mujoco>", files),
             Catch::Contains("expected at most 1000000 elements"));
}

TEST_CASE("a limit needs a range, and options are checked") {
  CHECK_THAT(failure(world("<body><joint limited='true'/></body>")),
             Catch::StartsWith("a.xml:1:26: expected a lower and a higher number for 'range'"));
  CHECK_THAT(failure(world("<body><joint range='2 1'/></body>")), Catch::StartsWith("a.xml:1:26: expected a lower"));
  CHECK_THAT(failure("<mujoco><option density='-1'/></mujoco>"),
             Catch::StartsWith("a.xml:1:9: expected at least 0 for 'density'"));
  CHECK(Read("<mujoco><option gravity='0 0 -9'/></mujoco>").model.options.size() == 1);
}
