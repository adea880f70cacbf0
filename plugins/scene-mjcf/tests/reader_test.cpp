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
  Unsupported unsupported;
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
        unsupported);
  }
  const Body& body(std::size_t i) const { return model.bodies.at(i); }
  /// The messages about unsupported elements and attributes, one per line.
  std::string messages() const {
    std::string out;
    for (const std::string& s : unsupported.sentences()) out += s + "\n";
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
  CHECK(a[0].forceRange == std::array<double, 2>{-2, 2});
  CHECK(a[1].bias == std::array<double, 3>{0, -7, 0});
  CHECK(a[2].bias == std::array<double, 3>{0, 0, -5});
  CHECK(a[2].controlRange == std::array<double, 2>{-1, 1});
  CHECK(a[3].gain == std::array<double, 3>{4, 0, 0});
  CHECK(a[3].bias == std::array<double, 3>{1, -2, -3});
  CHECK(r.messages() == "a.xml:4:73: the actuator <muscle> is not supported\n");
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
        "a.xml:2:1: the attribute 'colour' of <body> is not supported\n"
        "a.xml:2:28: the attribute 'wings' of <geom> is not supported (and 1 more)\n"
        "a.xml:3:13: the element <tendon> is not supported\n");
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
  CHECK(a[1].gain[0] == 55);
  CHECK(a[1].bias[1] == -55);
  CHECK(a[2].gain[0] == 1);
  CHECK(a[2].bias[1] == 0);
}

TEST_CASE("an ellipsoid has a mass but does not collide, and a box can be given by its end points") {
  const Read r(
      world("<body><joint/><geom type='ellipsoid' size='.1 .2 .3' density='1000'/></body>"
            "<body><joint/><geom type='box' size='.1' fromto='0 0 0 0 0 1'/></body>"));
  CHECK(r.body(1).mass.mass == Approx(1000 * 4.0 / 3 * kPi * .006));
  CHECK_FALSE(r.body(1).geoms[0].collides());
  CHECK(r.body(2).geoms[0].shape.lengths.isApprox(Vec3(.2, .2, 1)));
  CHECK_THAT(r.messages(), Catch::Contains("the shape of an ellipsoid is not supported"));
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
    Unsupported unsupported;
    const std::string text =
        "<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody>" + content + "</worldbody></mujoco>";
    Document document("a.xml", [&](const std::string&) { return text; });
    const auto triangle = [](const std::string&) {
      engine::ShapeDescription s{.shape = engine::Shape::mesh};
      s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
      s.triangles = {0, 1, 2};
      return s;
    };
    return readModel(document, triangle, unsupported).bodies.back().mass.mass;
  };
  const std::string mesh = "<geom type='mesh' mesh='m'/>";
  CHECK(read("<body><joint/><inertial pos='0 0 0' mass='3' diaginertia='1 1 1'/>" + mesh + "</body>") == 3);
  CHECK(read("<body><joint/><geom size='1' mass='2'/><geom type='mesh' mesh='m' mass='0'/></body>") == Approx(2));
  CHECK_THROWS_WITH(read("<body><joint/>" + mesh + "</body>"), Catch::Contains("the mesh has no volume"));
}

TEST_CASE("unsupported attributes of a default are reported too") {
  const Read r(
      "<mujoco><default>\n<joint wings='.1 1'/></default><worldbody><body><joint/><geom "
      "size='1'/></body></worldbody></mujoco>");
  CHECK(r.messages() == "a.xml:2:1: the attribute 'wings' of <joint> is not supported\n");
}

TEST_CASE("a spring may be given by its time constant and damping ratio") {
  // Numbers of MuJoCo 2.2.2.
  const Read r(
      world("<body><joint springdamper='.1 1' axis='0 1 0'/><geom size='.1' pos='.3 0 0'/><body pos='.5 0 0'><joint "
            "springdamper='.2 .5' axis='0 1 0' armature='.1'/><geom size='.1' pos='.1 0 .2'/></body></body>"));
  CHECK(r.body(1).joints[0].stiffness == Approx(150.423).epsilon(1e-5));
  CHECK(r.body(1).joints[0].damping == Approx(30.0845).epsilon(1e-5));
  CHECK(r.body(2).joints[0].stiffness == Approx(23.5219).epsilon(1e-5));
  CHECK(r.body(2).joints[0].damping == Approx(2.35219).epsilon(1e-5));
  CHECK_THAT(failure(world("<body><joint springdamper='0 1'/></body>")), Catch::Contains("two numbers above 0"));
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

TEST_CASE("limits are checked once all default classes are applied") {
  const auto model = [](const std::string& defaults, const std::string& joint, const std::string& actuator) {
    return "<mujoco><default>" + defaults + "</default><worldbody><body><joint name='j' " + joint +
           "/><geom size='1'/></body></worldbody><actuator>" + actuator + "</actuator></mujoco>";
  };
  SECTION("a default without a range, for any tag of actuators") {
    for (const std::string tag : {"general", "motor", "position", "velocity"}) {
      const Read r(model("<" + tag + " ctrllimited='true' forcelimited='true'/>", "",
                         "<motor joint='j' ctrlrange='-1 2' forcerange='-3 4'/>"));
      CHECK(r.model.actuators.at(0).controlRange == std::array<double, 2>{-1, 2});
      CHECK(r.model.actuators.at(0).forceRange == std::array<double, 2>{-3, 4});
    }
  }
  SECTION("a range in an outer class, and the limit in an inner one") {
    const Read r(
        model("<joint range='-90 90' limited='false'/><motor ctrlrange='-1 2' ctrllimited='false'/>"
              "<default class='x'><joint limited='true'/><motor ctrllimited='true'/></default>",
              "class='x'", "<motor joint='j' class='x'/><motor joint='j'/>"));
    CHECK(r.body(1).joints[0].limited);
    CHECK(r.model.actuators.at(0).controlRange[1] == 2);
    CHECK(std::isinf(r.model.actuators.at(1).controlRange[1]));
  }
  SECTION("joints") {
    CHECK(Read(model("<joint limited='true'/>", "range='-1 1'", "")).body(1).joints[0].limited);
    CHECK_FALSE(Read(model("<joint limited='true'/>", "limited='false'", "")).body(1).joints[0].limited);
    CHECK_FALSE(Read(model("", "range='0 0'", "")).body(1).joints[0].limited);
    CHECK_FALSE(Read(model("", "limited='false' range='2 1'", "")).body(1).joints[0].limited);
    CHECK_THAT(failure(model("<joint limited='true'/>", "", "")), Catch::Contains("expected a lower and a higher"));
    CHECK_THAT(failure(model("", "", "<motor joint='j' ctrllimited='true'/>")),
               Catch::Contains("expected a lower and a higher number for 'ctrlrange' of <motor>"));
    CHECK_THAT(failure(model("", "", "<position joint='j' forcelimited='true'/>")), Catch::Contains("'forcerange'"));
  }
  SECTION("without autolimits a range alone limits nothing") {
    const Read r("<mujoco><compiler autolimits='false'/>" +
                 model("", "range='-1 1'", "<motor joint='j' ctrlrange='-1 1'/>").substr(8));
    CHECK_FALSE(r.body(1).joints[0].limited);
    CHECK(std::isinf(r.model.actuators.at(0).controlRange[0]));
  }
}

TEST_CASE("the outermost default class is called main") {
  for (const std::string name : {"", " class='main'", " class='all'"}) {
    const std::string start =
        "<mujoco><default" + name + "><geom size='1'/><default class='x'><geom size='2'/></default>";
    const Read r(start +
                 "</default><worldbody><body childclass='x'><geom/><geom class='main'/></body>"
                 "<body childclass='main'><geom/></body></worldbody></mujoco>");
    CHECK(r.body(1).geoms[0].shape.radius == 2);
    CHECK(r.body(1).geoms[1].shape.radius == 1);
    CHECK(r.body(2).geoms[0].shape.radius == 1);
  }
  CHECK(Read(world("<geom class='main' size='1'/>")).body(0).geoms.size() == 1);
}

TEST_CASE("types of actuators change functions of their defaults as in MuJoCo 2.2.2") {
  const auto read = [](const std::string& defaults, const std::string& actuator) {
    return Read("<mujoco><default>" + defaults +
                "</default><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>" + actuator +
                "</actuator></mujoco>");
  };
  const auto first = [&](const std::string& defaults, const std::string& actuator) {
    return read(defaults, actuator).model.actuators.at(0);
  };
  using Three = std::array<double, 3>;
  CHECK(first("<position kp='5'/><velocity kv='3'/>", "<position joint='j'/>").bias == Three{0, -3, 0});
  CHECK(first("<position kp='5'/><velocity kv='3'/>", "<velocity joint='j'/>").bias == Three{0, 0, -3});
  CHECK(first("<position kp='5'/>", "<general joint='j'/>").bias == Three{0, -5, 0});
  CHECK(first("<motor gear='3'/>", "<general joint='j'/>").gear == 3);
  CHECK(first("", "<general joint='j' gainprm='3' biasprm='1 2 3'/>").bias == Three{0, 0, 0});
  CHECK(first("", "<general joint='j' gaintype='affine' gainprm='3 1 2'/>").gain == Three{3, 1, 2});
  CHECK(first("", "<general joint='j' gainprm='3 1 2'/>").gain == Three{3, 0, 0});
  const Actuator damper = first("", "<damper joint='j' kv='2' ctrlrange='0 3'/>");
  CHECK(damper.gain == Three{0, 0, -2});
  CHECK(damper.controlRange == std::array<double, 2>{0, 3});
  CHECK(first("", "<motor jointinparent='j'/>").joint == "j");
  // Dynamics are inherited too, and the shortcuts have none.
  CHECK(first("<general dyntype='filter'/>", "<motor joint='j'/>").joint == "j");
  const Read filtered = read("<general dyntype='filter'/>", "<general name='g' joint='j'/>");
  CHECK(filtered.model.actuators.empty());
  CHECK_THAT(filtered.messages(), Catch::Contains("<general> 'g' has the dyntype 'filter', which is not supported"));
}

TEST_CASE("coordinates of joints count from the pose of the file") {
  const Read r(
      world("<body><joint ref='30' range='10 50' springref='20' stiffness='1'/>"
            "<joint type='slide' ref='0.5' range='0 1' springref='0.25' stiffness='1'/><joint range='10 50'/></body>"));
  const std::vector<Joint>& j = r.body(1).joints;
  CHECK(j[0].reference == Approx(degToRad(30)));
  CHECK(j[0].range[0] == Approx(degToRad(-20)));
  CHECK(j[0].range[1] == Approx(degToRad(20)));
  CHECK(j[0].springPosition == Approx(degToRad(-10)));
  CHECK(j[1].range == std::array<double, 2>{-0.5, 0.5});
  CHECK(j[1].springPosition == -0.25);
  CHECK(j[2].range[0] == Approx(degToRad(10)));
  CHECK(r.messages().empty());
}

TEST_CASE("a mesh can be written in the model, and collides as its convex hull") {
  const auto mesh = [](const std::string& attributes) {
    return "<mujoco><asset><mesh name='m' " + attributes +
           "/></asset><worldbody><body><joint/><geom type='mesh' mesh='m' density='6'/></body></worldbody></mujoco>";
  };
  const std::string tetrahedron = "vertex='0 0 0 1 0 0 0 1 0 0 0 1'";
  SECTION("without faces") {
    const Read r(mesh(tetrahedron));
    CHECK(r.body(1).mass.mass == Approx(1));
    CHECK(r.body(1).geoms[0].shape.triangles.size() == 12);
  }
  SECTION("vertices inside the hull count for the mass of faces alone") {
    // A tetrahedron with a dent.
    const std::string dented = "vertex='0 0 0 1 0 0 0 1 0 0 0 1 .1 .1 .1' ";
    const Read hull(mesh(dented));
    CHECK(hull.body(1).mass.mass == Approx(1));
    CHECK(hull.body(1).geoms[0].shape.vertices.size() == 12);
    const Read faces(mesh(dented + "face='0 2 1 0 1 3 0 3 2 1 2 4 2 3 4 3 1 4'"));
    CHECK(faces.body(1).mass.mass == Approx(0.3));
    CHECK(faces.body(1).geoms[0].shape.triangles.size() == 12);
  }
  SECTION("a cube has two triangles on each side, which point outwards") {
    const Read r(mesh("vertex='0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 .5 .5 .5'"));
    const engine::ShapeDescription& s = r.body(1).geoms[0].shape;
    CHECK(s.vertices.size() == 24);
    REQUIRE(s.triangles.size() == 36);
    double volume = 0;
    for (std::size_t t = 0; t < 36; t += 3) {
      Mat3 corners;
      for (int i = 0; i < 3; ++i)
        corners.col(i) = Eigen::Map<const Vec3>(s.vertices.data() + 3 * s.triangles[t + std::size_t(i)]);
      volume += corners.determinant() / 6;
    }
    CHECK(volume == Approx(1));
  }
  SECTION("reference frame, then scale") {
    const Read r(
        mesh("vertex='0 0 0 1 0 0 1 1 0 0 1 0 0 0 2 1 0 2 1 1 2 0 1 2' refpos='1 2 3' refquat='1 1 0 0' "
             "scale='2 3 4'"));
    CHECK(r.body(1).mass.mass == Approx(6 * 48));
    CHECK(r.body(1).mass.center.isApprox(Vec3(-1, -6, 6)));
  }
  SECTION("what is no mesh is refused") {
    for (const auto& [attributes, message] :
         {std::pair{"vertex='0 0 0 1 0 0 0 1 0'", "expected 12 to"},
          {"vertex='0 0 0 1 0 0 0 1 0 1 1 0'", "the mesh has no convex hull"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1 2'", "expected three numbers for each vertex, found 13"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 4'", "expected indices of the 4 vertices for 'face', found 4"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 2 3'", "expected three numbers for each triangle"},
          {"", "expected an attribute 'file' or 'vertex'"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' refquat='0 0 0 0'", "expected a quaternion that is not 0"}})
      CHECK_THAT(failure(mesh(attributes)), Catch::Contains(message));
  }
}

TEST_CASE("masses can be scaled to a total") {
  const std::string bodies =
      "<worldbody><body><joint/><geom size='1' mass='1'/></body><body><geom size='1' "
      "mass='3'/></body></worldbody></mujoco>";
  const Read r("<mujoco><compiler settotalmass='8'/>" + bodies);
  CHECK(r.body(1).mass.mass == Approx(2));
  CHECK(r.body(1).mass.inertia(0, 0) == Approx(0.8));
  CHECK(r.body(2).mass.mass == Approx(6));
  CHECK(Read("<mujoco><compiler settotalmass='-1'/>" + bodies).body(2).mass.mass == Approx(3));
}

TEST_CASE("flags of the options are read") {
  const auto read = [](const std::string& flag) {
    return Read("<mujoco><option><flag " + flag + "/></option></mujoco>");
  };
  const Flags none = read(
                         "contact='disable' limit='disable' frictionloss='disable' passive='disable' "
                         "actuation='disable' clampctrl='disable'")
                         .model.flags;
  CHECK_FALSE((none.contact || none.limit || none.frictionLoss || none.passive || none.actuation || none.clampControl));
  const Flags constraint = read("constraint='disable'").model.flags;
  CHECK_FALSE((constraint.contact || constraint.limit || constraint.frictionLoss));
  CHECK(constraint.passive);
  CHECK(read("gravity='disable'").model.options.at(0).value == Value(List{0.0, 0.0, 0.0}));
  CHECK(read("equality='disable' energy='enable' contact='enable' filterparent='enable'").messages().empty());
  CHECK(read("filterparent='disable' override='enable'").messages() ==
        "a.xml:1:17: the flag filterparent=\"disable\" is not supported\n"
        "a.xml:1:17: the flag override=\"enable\" is not supported\n");
  CHECK_THAT(failure("<mujoco><option><flag contact='off'/></option></mujoco>"), Catch::Contains("expected enable"));
}

TEST_CASE("poses may be given in the world frame") {
  const auto read = [](const std::string& content) {
    return Read("<mujoco><compiler coordinate='global'/><worldbody>" + content + "</worldbody></mujoco>");
  };
  SECTION("bodies with a frame") {
    const Read r(
        read("<body pos='0 0 1' euler='0 0 90'><joint axis='0 1 0' pos='0.1 0 1'/><site pos='1 1 1'/>"
             "<geom type='box' size='.1 .2 .3' pos='.2 0 1'/><body pos='0 3 1'><inertial pos='0 4 1' mass='1' "
             "diaginertia='1 2 3'/></body></body>"));
    CHECK(r.body(1).joints[0].position.isApprox(Vec3(0, -0.1, 0)));
    CHECK(r.body(1).joints[0].axis.isApprox(Vec3::UnitX()));
    CHECK(r.body(1).sites[0].pose.position.isApprox(Vec3(1, -1, 0)));
    CHECK(r.body(1).mass.center.isApprox(Vec3(0, -0.2, 0)));
    CHECK(r.body(2).pose.position.isApprox(Vec3(3, 0, 0)));
    CHECK(compose(r.body(1).pose, r.body(2).pose).rotation.isApprox(Mat3(Mat3::Identity())));
    CHECK(r.body(2).mass.center.isApprox(Vec3(0, 1, 0)));
  }
  SECTION("a body without a position has its frame at its centre of mass") {
    const Read r(
        read("<body euler='0 0 30'><joint pos='0 0 1'/><geom type='capsule' size='.05' fromto='0 0 1 .4 0 1'/>"
             "<body><joint pos='.4 0 1'/><geom size='.1' pos='.4 .3 1'/></body></body>"));
    CHECK(r.body(1).pose.position.isApprox(Vec3(0.2, 0, 1)));
    CHECK(r.body(1).mass.center.norm() < 1e-12);
    CHECK(r.body(1).joints[0].position.isApprox(Vec3(-0.2, 0, 0)));
    CHECK(r.body(2).pose.position.isApprox(Vec3(0.2, 0.3, 0)));
    CHECK(r.body(2).joints[0].position.isApprox(Vec3(0, -0.3, 0)));
  }
  CHECK_THAT(failure("<mujoco><compiler coordinate='x'/></mujoco>"), Catch::Contains("expected local or global"));
}

TEST_CASE("shapes can be fitted to meshes by their inertia") {
  // A cuboid of 1 m x 2 m x 3 m, turned so that its longest edge is along x.
  const auto read = [](const std::string& geom) {
    return Read(
        "<mujoco><asset><mesh name='m' vertex='0 0 0 3 0 0 3 0 1 0 0 1 0 2 0 3 2 0 3 2 1 0 2 1'/></asset>"
        "<worldbody><body><joint/><geom mesh='m' " +
        geom + "/></body></worldbody></mujoco>");
  };
  const auto shape = [&](const std::string& geom) { return read(geom).body(1).geoms.at(0).shape; };
  const Read box = read("type='box' pos='1 0 0'");
  const Geom& g = box.body(1).geoms.at(0);
  CHECK(g.shape.lengths.isApprox(Vec3(1, 2, 3)));
  CHECK(g.pose.position.isApprox(Vec3(2.5, 1, 0.5)));
  CHECK(std::abs(g.pose.rotation(0, 2)) == Approx(1));
  CHECK(box.body(1).mass.mass == Approx(6000));
  CHECK(shape("").radius == Approx(1));
  CHECK(shape("type='sphere' fitscale='2'").radius == Approx(2));
  CHECK(shape("type='capsule'").radius == Approx(0.75));
  CHECK(shape("type='capsule'").length == Approx(2.25));
  CHECK(shape("type='cylinder'").length == Approx(3));
  CHECK(read("type='ellipsoid'").body(1).mass.mass == Approx(kPi * 1000));
}

TEST_CASE("file names can be stripped of their folders") {
  std::string opened;
  Unsupported unsupported;
  const std::string text =
      "<mujoco><compiler meshdir='m' strippath='true'/><asset><mesh name='c' file='C:\\x\\y/z/cube.stl'/></asset>"
      "<worldbody><geom type='mesh' mesh='c'/></worldbody></mujoco>";
  Document document("a.xml", [&](const std::string&) { return text; });
  const auto read = [&](const std::string& file) {
    opened = file;
    engine::ShapeDescription s{.shape = engine::Shape::mesh};
    s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    return s;
  };
  readModel(document, read, unsupported);
  CHECK(opened == "m/cube.stl");
}

TEST_CASE("a pair names geoms that are only seen otherwise") {
  const auto read = [](const std::string& geoms) {
    return Read("<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody>" + geoms +
                "</worldbody><contact><pair geom1='a' geom2='b'/></contact></mujoco>");
  };
  const std::string mesh = "<geom name='a' type='mesh' mesh='m' contype='0' conaffinity='0'/>";
  const Read r = read(mesh + "<geom name='b' size='1'/>");
  CHECK(r.body(0).geoms.size() == 2);
  CHECK(r.model.unsupportedGeoms.empty());
  CHECK(read(mesh + "<geom name='b' type='ellipsoid' size='1 1 1'/>").model.unsupportedGeoms.contains("b"));
}
