// Reads models from MJCF texts.

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "../vocabulary.h"
#include "read_model.h"

using namespace spark;
using namespace spark::mjcf;
using namespace spark::mjcf::test;

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
  CHECK(r.body(2).geoms[0].contact.friction == std::array<double, 3>{0.5, 0.005, 0.0001});
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
      "</worldbody><extension/><keyframe/></mujoco>");
  CHECK(r.messages() ==
        "a.xml:2:1: the attribute 'colour' of <body> is not supported\n"
        "a.xml:2:28: the attribute 'wings' of <geom> is not supported (and 1 more)\n"
        "a.xml:3:13: the element <extension> is not supported\n");
}

TEST_CASE("errors have the position, what was expected, and what was found") {
  const std::pair<const char*, const char*> cases[] = {
      {"<mujoco><worldbody><body></worldbody></mujoco>", "a.xml:1:28: this is not XML: "},
      {"<robot/>", "a.xml:1:1: expected the element <mujoco>, found <robot>"},
      {"", "a.xml:1:1: this is not XML: No document element found"},
      {"<mujoco><worldbody><joint/></worldbody></mujoco>", "a.xml:1:20: the world has no joints"},
      {"<mujoco><compiler eulerseq='xy'/></mujoco>",
       "a.xml:1:9: expected three of x y z X Y Z for 'eulerseq', found 'xy'"},
      {"<mujoco><compiler eulerseq='xyw'/><worldbody><body euler='1 2 3'/></worldbody></mujoco>",
       "a.xml:1:46: expected an 'eulerseq' of x y z X Y Z in <compiler>, found 'xyw'"},
  };
  for (const auto& [text, message] : cases) CHECK_THAT(failure(text), Catch::StartsWith(message));
}

TEST_CASE("a number that cannot be read, or with which no engine computes, costs itself, and is named") {
  const std::pair<const char*, const char*> cases[] = {
      {"<body pos='1 2'/>", "a.xml:1:20: 'pos' of <body> is ignored: expected 3 numbers, found '1 2'"},
      {"<body pos='1 2 nan'/>", "a.xml:1:20: 'pos' of <body> is ignored: expected 3 numbers, found '1 2 nan'"},
      {"<body pos='1e300 0 0'/>", "'pos' of <body> is ignored: expected a place at most 1e+06 m away"},
      {"<body><joint damping='x'/><geom size='1'/></body>",
       "a.xml:1:26: 'damping' of <joint> is ignored: expected a number, found 'x'"},
      {"<body><joint range='0 inf' limited='true'/><geom size='1'/></body>",
       "'range' of <joint> is ignored: expected 2 numbers, found '0 inf'"},
      {"<body><joint axis='0 0 0'/><geom size='1'/></body>", "an 'axis' of 0 in <joint> is taken as '0 0 1'"},
      {"<body><joint stiffness='1e300'/><geom size='1'/></body>", "<joint>, a stiffness of 1e+300 is taken as 1e+12"},
      {"<body><joint/><inertial pos='0 0 0' mass='1e300' diaginertia='1 1 1'/></body>",
       "<body>, a mass of 1e+300 is taken as 1e+15"},
      {"<body><joint/><inertial pos='0 0 0' mass='0' diaginertia='0 0 0'/></body>",
       "a <body> that moves and has no mass gets 10 g"},
      {"<body><joint/><geom size='1'/><geom size='1e8'/></body>",
       "<geom>, a mass of 4.18879e+27 kg is taken as 2.5e+14 kg: expected at most 1e+15 kg and 1e+30 kg m^2"},
      {"<body><joint/><geom size='1' density='1e300'/></body>", "is taken as 1e+15 kg: expected at most"},
      {"<body><joint/><geom size='1e200' mass='1'/></body>",
       "<geom> adds no mass to its body: expected at most 1e+15 kg"},
      {"<body><joint/><geom size='1' fromto='0 0 0 0 0 1e200' type='capsule'/></body>",
       "<geom> is left out: expected places at most 1e+06 m away for 'fromto'"},
      {"<body><joint/><geom size='1' mass='0'/></body>", "a <body> that moves and has no mass gets 10 g"},
      {"<body zaxis='0 0 0'/>", "'zaxis' of <body> is ignored: expected a direction that is not 0"},
      {"<body axisangle='0 0 0 1'/>", "'axisangle' of <body> is ignored: expected an axis that is not 0"},
      {"<frame xyaxes='1 0 0 -2 0 0'/>", "'xyaxes' of <frame> is ignored: expected two different directions"},
      {"<body><freejoint/><joint type='free' damping='1e10'/></body>", "a damping of 1e+10 is taken as 1e+09"},
  };
  for (const auto& [content, message] : cases) {
    const std::string messages = named(world(content));
    INFO(content << messages);
    CHECK(messages.find(message) != std::string::npos);
  }
  CHECK(Read(world("<body><joint axis='0 1e308 0'/><geom size='1'/></body>")).body(1).joints[0].axis.y() == 1);
  for (const char* const half : {"quat='0 0 1e300 0'", "axisangle='0 1e300 0 180'", "zaxis='1e-300 0 -1e300'"})
    CHECK(Read(world("<body " + std::string(half) + "/>")).body(1).pose.rotation(2, 2) == Approx(-1));
}

TEST_CASE("a value that MuJoCo takes does not cost the model; what is made of it is named") {
  const std::pair<const char*, const char*> cases[] = {
      {"<body quat='0 0 0 0'/>", "a.xml:1:20: a 'quat' of 0 in <body> is taken as no rotation"},
      {"<geom size='1' group='1.5'/>", "'group' of <geom> is taken without its fraction: expected a whole number"},
      {"<body><joint type='ball' limited='true' range='0 0'/><geom size='1'/></body>",
       "a ball <joint> that is limited to 0 has no limit"},
      {"<body><joint/><inertial pos='0 0 0' mass='1' diaginertia='1 0.1 0.1'/></body>",
       "the <inertial> of a <body> with moments of inertia that no body can have gets their mean about each axis"},
      {"<body><inertial pos='0 0 0' mass='0' diaginertia='0 0 0'/></body>", ""},
      {"<body><joint damping='-2'/><geom size='1'/></body>",
       "'damping' of <joint> is taken as 0: expected 0 to inf, found -2"},
      {"<geom size='1' solmix='-1'/>", "'solmix' of <geom> is taken as 0"},
      {"<geom size='1' friction='1 -1 0'/>", "'friction' of <geom> below 0 is taken as 0"},
      {"<geom size='1' margin='-0.1' gap='-0.1'/><body><joint margin='-0.1' limited='true' range='0 1'/><geom "
       "size='1'/></body>",
       ""},
      {"<body><joint damping='1e-400'/><geom size='1'/></body>", ""},
      {"<body quat='0 0 0 2'/>", ""},
  };
  for (const auto& [content, message] : cases) {
    const std::string messages = named(world(content));
    INFO(content << messages);
    CHECK((*message ? messages.find(message) != std::string::npos : messages.empty()));
  }
  CHECK(Read("<mujoco><compiler eulerseq='xyw'/></mujoco>").messages().empty());
  CHECK(Read(world("<body><joint/><inertial pos='0 0 0' mass='1' diaginertia='1 0.1 0.1'/></body>"))
            .body(1)
            .mass.inertia.isApprox(0.4 * Mat3::Identity()));
}

TEST_CASE("a part that is bad is left out, and named with its place, what was expected, and what was found") {
  const std::pair<const char*, const char*> cases[] = {
      {"<mujoco><worldbody><geom type='cone'/></worldbody></mujoco>",
       "a.xml:1:20: <geom> is left out: expected plane or hfield or sphere"},
      {"<mujoco><worldbody><geom type='box' size='1 1'/></worldbody></mujoco>",
       "a.xml:1:20: <geom> is left out: the 'size' of a box needs 3 lengths above 0"},
      {"<mujoco><worldbody><geom class='x'/></worldbody></mujoco>",
       "a.xml:1:20: <geom> is left out: there is no default class 'x'"},
      {"<mujoco><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>",
       "a.xml:1:20: <geom> is left out: there is no <mesh> 'm'"},
      {"<mujoco><equality><joint/></equality></mujoco>",
       "a.xml:1:19: <joint> is left out: expected an attribute 'joint1'"},
      {"<mujoco><equality><connect body1='a'/></equality></mujoco>",
       "a.xml:1:19: <connect> is left out: expected an attribute 'anchor'"},
      {"<mujoco><equality><weld body1='a' relpose='1 2'/></equality></mujoco>",
       "a.xml:1:19: <weld> is left out: expected 7 numbers for 'relpose' of <weld>, found '1 2'"},
      {"<mujoco><tendon><fixed/></tendon></mujoco>",
       "a.xml:1:17: <fixed> is left out: expected at least one joint in a tendon"},
      {"<mujoco><tendon><spatial><site site='a'/></spatial></tendon></mujoco>",
       "a.xml:1:17: <spatial> is left out: expected at least two sites in a tendon"},
      {"<mujoco><worldbody><geom size='1' condim='2'/></worldbody></mujoco>",
       "a.xml:1:20: <geom> is left out: expected 1, 3, 4 or 6 for 'condim', found 2"},
      {"<mujoco><worldbody><site name='s' pos='0 nan 0'/></worldbody></mujoco>",
       "a.xml:1:20: <site> 's' is left out: expected 3 numbers for 'pos' of <site>, found '0 nan 0'"},
      {"<mujoco><actuator><motor joint='j' ctrlrange='2 1'/></actuator></mujoco>",
       "a.xml:1:19: <motor> is left out: expected a lower and a higher number for 'ctrlrange' of <motor>"},
      {"<mujoco><sensor><gyro site='s' noise='x'/></sensor></mujoco>",
       "a.xml:1:17: <gyro> is left out: expected a number for 'noise' of <gyro>, found 'x'"},
      {"<mujoco><contact><pair geom1='a' geom2='b' margin='x'/></contact></mujoco>",
       "a.xml:1:18: <pair> is left out: expected a number for 'margin' of <pair>, found 'x'"},
      {"<mujoco><asset><mesh name='m' vertex='1 2'/></asset><worldbody><geom type='mesh' "
       "mesh='m'/></worldbody></mujoco>",
       "a.xml:1:16: <mesh> 'm' is left out: expected 12 to"},
  };
  for (const auto& [text, message] : cases) CHECK_THAT(named(text), Catch::StartsWith(message));
}

TEST_CASE("a body has the mass of what is not left out, or 10 g") {
  const auto body = [](const std::string& content) { return Read(world("<body><joint/>" + content + "</body>")); };
  const std::string bad = "<geom type='box' size='1 0 1'/>";
  CHECK(body(bad + "<geom size='1' mass='3'/>").body(1).mass.mass == Approx(3));
  CHECK(body(bad + "<body><geom size='1' mass='3'/></body>").body(1).mass.mass == 0);  // that of its part
  CHECK(body("<inertial pos='0 0 0' diaginertia='1 1 1'/><geom size='1' mass='3'/>").body(1).mass.mass == Approx(3));
  for (const char* const inertia :
       {"mass='-1' diaginertia='1 1 1'", "mass='1' diaginertia='1 1 -1'", "mass='1' fullinertia='1 1 1 0 0 2'"}) {
    const Read r = body("<geom size='1' mass='3'/><inertial pos='0 0 0' " + std::string(inertia) + "/>");
    CHECK(r.body(1).mass.mass == Approx(3));
    CHECK_THAT(r.messages(), Catch::StartsWith("a.xml:1:59: <inertial> is left out: expected a mass and moments of "
                                               "inertia of 0 or more, found "));
  }
  CHECK(body("<geom size='1' mass='3'/><geom size='1' mass='-2'/>").body(1).mass.mass == Approx(3));
  const Read light = body(bad);
  CHECK(light.body(1).mass.mass == Approx(0.01));
  CHECK_THAT(light.messages(), Catch::Contains("a.xml:1:20: a <body> that moves and has no mass gets 10 g"));
  CHECK(body("<geom size='1' mass='0'/>").body(1).mass.mass == Approx(0.01));
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

TEST_CASE("an ellipsoid is a convex shape with half axes, and a box can be given by its end points") {
  const Read r(
      world("<body><joint/><geom type='ellipsoid' size='.1 .2 .3' density='1000'/></body>"
            "<body><joint/><geom type='box' size='.1' fromto='0 0 0 0 0 1'/></body>"));
  CHECK(r.body(1).mass.mass == Approx(1000 * 4.0 / 3 * kPi * .006));
  CHECK(r.body(1).geoms[0].collides());
  CHECK(r.body(1).geoms[0].ellipsoid == Vec3(.1, .2, .3));
  const std::vector<double>& corners = r.body(1).geoms[0].shape.mesh->vertices;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    CHECK(Vec3(corners[i] / .1, corners[i + 1] / .2, corners[i + 2] / .3).norm() == Approx(1));
  CHECK(r.body(2).geoms[0].shape.lengths.isApprox(Vec3(.2, .2, 1)));
  CHECK(r.messages().empty());
}

TEST_CASE("the mass of an ellipsoid is added only if its group is in inertiagrouprange") {
  const std::string start = "<mujoco><compiler inertiagrouprange='0 4'/><worldbody><body><joint/>";
  const std::string box = "<geom type='box' size='.5 .5 .5' density='1'/>", end = "</body></worldbody></mujoco>";
  const auto mass = [&](const std::string& ellipsoid) { return Read(start + box + ellipsoid + end).body(1).mass.mass; };
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='2'/>") == Approx(3));
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='2' group='5'/>") == Approx(1));
  CHECK(mass("<geom type='ellipsoid' size='.1 .2 .3' mass='0'/>") == Approx(1));
  CHECK_THAT(named(world("<body><geom type='ellipsoid'/></body>")), Catch::Contains("the 'size' of an ellipsoid"));
}

TEST_CASE("unsupported attributes of a default are reported too") {
  const Read r(
      "<mujoco><default>\n<joint wings='.1 1'/></default><worldbody><body><joint/><geom "
      "size='1'/></body></worldbody></mujoco>");
  CHECK(r.messages() == "a.xml:2:1: the attribute 'wings' of <joint> is not supported\n");
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

TEST_CASE("a pair names geoms that are only seen otherwise") {
  const auto read = [](const std::string& geoms) {
    return Read("<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody>" + geoms +
                "</worldbody><contact><pair geom1='a' geom2='b'/></contact></mujoco>");
  };
  const std::string mesh = "<geom name='a' type='mesh' mesh='m' contype='0' conaffinity='0'/>";
  const Read r = read(mesh + "<geom name='b' size='1'/>");
  CHECK(r.body(0).geoms.size() == 2);
  CHECK(r.model.unsupportedGeoms.empty());
  CHECK(read(mesh + "<geom name='b' type='sdf'/>").model.unsupportedGeoms.contains("b"));
}

TEST_CASE("elements and attributes that MJCF does not have are named, wherever they are") {
  for (const Word& w : vocabulary()) {
    if (w.content == Word::foreign || w.element == "mujoco") continue;
    // The element in those around it, up to the root, with an attribute and a child of no language.
    std::string text = fmt::format("<{0} unheard='1'><unknown/></{0}>", w.element);
    for (std::string_view in = w.in.substr(0, w.in.find(' ')); in != "mujoco";) {
      text = fmt::format("<{0}>{1}</{0}>", in, text);
      const auto around = std::find_if(vocabulary().begin(), vocabulary().end(),
                                       [&](const Word& other) { return other.element == in; });
      REQUIRE(around != vocabulary().end());
      in = around->in.substr(0, around->in.find(' '));
    }
    Document document("a.xml", [&](const std::string&) { return "<mujoco>" + text + "</mujoco>"; });
    Unsupported unsupported;
    nameUnknown(document, unsupported);
    const std::vector<std::string> sentences = unsupported.sentences();
    INFO(text);
    REQUIRE(sentences.size() == 2);
    CHECK_THAT(sentences[0],
               Catch::StartsWith("a.xml:1:") && Catch::Contains(fmt::format("'unheard' of <{}> is not", w.element)));
    CHECK_THAT(sentences[1], Catch::Contains("the element <unknown> is not supported"));
  }
}

TEST_CASE("The README has the table of elements and attributes") {
  std::ifstream in(SPARK_SOURCES "/plugins/scene-mjcf/README.md");
  const std::string readme{std::istreambuf_iterator(in), {}};
  const auto code = [](std::string_view words) {
    std::string out;
    for (const char c : words) out += c == ' ' ? "` `" : std::string(1, c);
    return out.empty() ? out : "`" + out + "`";
  };
  for (const Word& w : vocabulary()) {
    const std::string row = fmt::format("| `{}` | {} | {} | {} |\n", w.element, code(w.in), code(w.read), code(w.idle));
    INFO(row);
    CHECK(readme.find(row) != std::string::npos);
  }
  const std::size_t begin = readme.find("| element | in |");
  REQUIRE(begin != std::string::npos);
  const std::string table = readme.substr(begin, readme.find("\n\n", begin) - begin);
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) == vocabulary().size() + 1);
}
