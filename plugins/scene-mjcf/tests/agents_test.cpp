// Names, sensors and actuators of models, as agents use them.

#include <map>
#include <set>

#include "absence.h"
#include "mjcf_host.h"

namespace spark::test {

namespace {

/// A model with an arm that has these names, an actuator, and three sensors.
std::string named(const std::string& name) {
  std::string text = R"(<mujoco model='m'><worldbody><body name='@'><joint name='@' axis='0 1 0'/>
    <geom name='@' size='.1'/><site name='@'/></body></worldbody><actuator><motor name='@' joint='@'/></actuator>
    <sensor><jointpos name='@p' joint='@'/><framepos name='@s' objtype='site' objname='@'/>
    <gyro name='@g' site='@'/></sensor></mujoco>)";
  for (std::size_t at; (at = text.find('@')) != std::string::npos;) text.replace(at, 1, name);
  return text;
}

}  // namespace

TEST_CASE("names may have any character, and agents use those of the file") {
  using Names = std::vector<std::string>;
  struct Case {
    std::string inFile, inTree;
    Names inMessages;  ///< gyro, joint, site, actuator
  };
  const Case cases[] = {
      {"arm/j", "arm_j", {"arm/jp", "arm/jg", "arm/js", "arm/j"}},
      {"a[1]", "a_1_", {"a[1]p", "a[1]g", "a[1]s", "a[1]"}},
      {"a\\b", "a_b", {"a_bp", "a_bg", "a_bs", "a_b"}},
      {"left arm", "left arm", {"left_armp", "left_armg", "left_arms", "left_arm"}},
      {"a(b)", "a(b)", {"a_b_p", "a_b_g", "a_b_s", "a_b_"}},
      {"a&quot;;b", "a\";b", {"a__bp", "a__bg", "a__bs", "a__b"}},
      {"\xc3\xbc", "\xc3\xbc", {"\xc3\xbcp", "\xc3\xbcg", "\xc3\xbcs", "\xc3\xbc"}},
      {"..", ".._", {"..p", "..g", "..s", ".."}},
  };
  for (const Case& c : cases) {
    INFO(c.inFile);
    RobotHost h;
    h.import(named(c.inFile));
    CHECK(h.find("m/" + c.inTree + "/body"));
    CHECK(h.find("m/" + c.inTree + "/" + c.inTree)->classObject()->name() == "HingeJoint");
    Names found = h.messageNames(), expected = c.inMessages;
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    CHECK(found == expected);
  }
}

TEST_CASE("names that become equal are kept apart") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><worldbody><body name='a/b'><joint name='j/1' axis='0 1 0'/><joint name='j_1'/>
    <geom name='body' size='.1'/><geom name='j_1' size='.1'/><site name='body'/></body></worldbody>
    <actuator><motor name='x y' joint='j/1'/><motor name='x_y' joint='j_1'/><motor joint='j_1'/></actuator></mujoco>)");
  std::vector<std::string> names;
  for (const auto& child : h.find("m/a_b")->asNode()->children()) names.push_back(child->name());
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  const std::vector<std::string> messages = h.messageNames();
  CHECK(std::set<std::string>(messages.begin(), messages.end()) == std::set<std::string>{"x_y", "x_y~2", "j_1"});
  CHECK_THAT(h.text, Catch::Contains("<motor> 'x y' is called x_y in messages"));
}

TEST_CASE("sensors and actuators that are not supported are logged with their position") {
  RobotHost h;
  const std::string sensors[] = {"touch site='s'",
                                 "velocimeter site='s'",
                                 "force site='s'",
                                 "magnetometer site='s'",
                                 "ballquat joint='ball'",
                                 "actuatorpos actuator='a'",
                                 "subtreecom body='b'",
                                 "clock",
                                 "framexaxis objtype='body' objname='b'",
                                 "framepos objtype='camera' objname='c'",
                                 "framepos objtype='geom' objname='g' reftype='body' refname='b'",
                                 "user dim='1' objtype='body' objname='b'",
                                 "framequat objtype='geom' objname='seen'"};
  std::string text =
      R"(<mujoco model='m'><asset><mesh name='none' file='none.stl'/></asset><worldbody><camera name='c'/>
    <body name='b'><joint name='j'/><geom name='g' size='.1'/><site name='s'/>
    <geom name='seen' type='mesh' mesh='none' contype='0' conaffinity='0' density='0'/>
    <body name='d'><joint name='ball' type='ball'/><geom size='.1'/></body></body>
    <body name='f' pos='3 0 0'><freejoint name='free'/><geom size='.1'/></body></worldbody>
    <tendon><fixed name='t'><joint joint='j' coef='1'/></fixed></tendon>
    <actuator><motor name='a' joint='j'/>
    <motor name='a1' tendon='t'/><motor name='a2' joint='ball'/><motor name='a3' joint='free'/>
    <muscle name='a4' joint='j'/><general name='a5' joint='j' dyntype='integrator'/>
    <position name='a6' joint='j' kp='-1'/></actuator>
    <sensor>)";
  int line = 12;
  for (const std::string& s : sensors) {
    const std::size_t space = std::min(s.find(' '), s.size());
    text += "\n<" + s.substr(0, space) + " name='s" + std::to_string(line++) + "'" + s.substr(space) + "/>";
  }
  h.import(text + "</sensor></mujoco>");
  for (int i = 12; i < line; ++i) CHECK_THAT(h.text, Catch::Contains(fmt::format("m.xml:{}:1: the sensor <", i)));
  // What no controller can be is MuJoCo's, where its plugin is there.
  const std::vector<std::string> names = h.messageNames();
  for (const char* const name : {"a", "a6"}) CHECK(std::find(names.begin(), names.end(), name) != names.end());
}

TEST_CASE("sensors of positions belong to sites, geoms and both frames of bodies") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><worldbody><site name='w' pos='5 0 0'/><body name='fix' pos='0 4 0'/>
    <body name='b' pos='1 0 0'><freejoint/><geom name='g' size='.1' pos='0 0 2'/><site name='s' pos='0 3 0'/></body>
    </worldbody><sensor><framepos name='site' objtype='site' objname='s'/>
    <framepos name='geom' objtype='geom' objname='g'/><framepos name='body' objtype='body' objname='b'/>
    <framepos name='xbody' objtype='xbody' objname='b'/><framepos name='fixed' objtype='xbody' objname='fix'/>
    <framepos name='world' objtype='body' objname='world'/><framepos objtype='site' objname='w'/>
    <framequat name='turn' objtype='xbody' objname='b'/></sensor></mujoco>)");
  std::map<std::string, Vec3> places;
  std::vector<Perceptor*> perceptors;
  h.scene.collect(perceptors);
  for (Perceptor* p : perceptors) places[p->messageName()] = toPose(p->transform()->worldNow()).position;
  const std::pair<const char*, Vec3> expected[] = {{"site", {1, 3, 0}},  {"geom", {1, 0, 2}},  {"body", {1, 0, 2}},
                                                   {"xbody", {1, 0, 0}}, {"fixed", {0, 4, 0}}, {"world", {0, 0, 0}},
                                                   {"w", {5, 0, 0}},     {"turn", {1, 0, 0}}};
  CHECK(places.size() == std::size(expected));
  for (const auto& [name, place] : expected) {
    INFO(name);
    CHECK((places[name] - place).norm() < 1e-6);
  }
  const std::string before = h.text;
  h.import(R"(<mujoco model='o'><worldbody><body name='b'><freejoint/><geom size='.1'/></body></worldbody>
    <sensor><framepos name='relative' objtype='body' objname='b' reftype='body' refname='b'/></sensor></mujoco>)");
  CHECK(lacks(before, "not supported", h.text));
}

TEST_CASE("agents use MuJoCo's coordinates where a joint has a ref") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><option gravity='0 0 0'/><worldbody><body name='b'>
    <joint name='j' axis='0 0 1' ref='30' damping='1'/><geom size='.1' pos='.5 0 0' mass='1'/></body>
    <body name='c' pos='0 0 3'><joint name='k' axis='0 0 1' ref='30' damping='1'/><geom size='.1' pos='.5 0 0' mass='1'/></body>
    </worldbody><actuator><position name='p' joint='j' kp='20'/>
    <position name='k_pos' joint='k'/><velocity name='k_vel' joint='k'/><motor name='k_tau' joint='k'/></actuator>
    <sensor><jointpos name='q' joint='j'/></sensor></mujoco>)");
  const auto sensed = [&] {
    Predicates out;
    h.at<Perceptor>("m/b/j/q").sense(out, Event{});
    return (*out.begin()).at(2).at(1).number();
  };
  CHECK(sensed() == Approx(30));
  CHECK(h.act("m/b/j/p", "(p 0.8)").empty());
  CHECK(h.act("m/c/k/k", "(k 50 0 20 2 0)").empty());
  h.step(500);
  CHECK(sensed() == Approx(radToDeg(0.8)).margin(0.6));
  CHECK(h.at<IJoint>("m/b/j").angle(0) == Approx(0.8 - degToRad(30)).margin(1e-2));
  CHECK(h.at<IJoint>("m/c/k").angle(0) == Approx(degToRad(20)).margin(1e-2));
}

TEST_CASE("gears and limits of the three parts of a controller count, as in the league's ant") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><default><general gear='15' ctrllimited='true' ctrlrange='-1 1'/></default>
    <worldbody><body name='b'><joint name='j' axis='0 0 1' actuatorfrcrange='-500 500'/><geom size='.1'/></body>
    </worldbody><actuator><motor name='l1e1_tau' joint='j' gear='4' forcelimited='true' forcerange='-.5 .5'/>
    <position name='l1e1_pos' joint='j' kp='1'/><velocity name='l1e1_vel' joint='j' kv='1' ctrlrange='-30 30'/></actuator>
    </mujoco>)");
  Leaf& effector = *h.find("m/b/j/l1e1");
  CHECK(getProperty(effector, "gears") == Value(List{15.0, 15.0, 4.0}));
  CHECK(getProperty(effector, "leastControls") == Value(List{-1.0, -30.0, -0.5}));
  CHECK(getProperty(effector, "mostControls") == Value(List{1.0, 30.0, 0.5}));
  CHECK(getProperty(effector, "maxForce").toNumber() == 500);
  const std::string before = h.text;
  h.import("<mujoco model='o'><sensor><clock name='t'/></sensor></mujoco>");
  CHECK(lacks(before, "m.xml:", h.text));
}

TEST_CASE("the force of an actuator is limited before its gear, and its length is the gear times the coordinate") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><compiler angle='radian'/><worldbody>
    <body><joint name='a' ref='0.5'/><geom size='.1'/></body><body><joint name='b'/><geom size='.1'/></body>
    <body><joint name='c'/><geom size='.1'/></body><body><joint name='d'/><geom size='.1'/></body>
    <body><joint name='e'/><geom size='.1'/></body></worldbody>
    <actuator><position name='pos' joint='a' kp='3' gear='2' forcerange='-7 7' ctrlrange='-1 1'/>
    <motor name='motor' joint='b' gear='2' ctrlrange='-9 9' forcerange='-1 4'/>
    <general name='affine' joint='c' gear='2' gainprm='3' biastype='affine' biasprm='1 -2 -3'/>
    <damper name='damp' joint='d' gear='2' kv='5' ctrlrange='0 4'/>
    <general name='against' joint='e' gainprm='-2' forcerange='-1 4'/></actuator></mujoco>)");
  const auto number = [&](const std::string& path, const char* name) {
    return getProperty(*h.find("m/" + path), name).toNumber();
  };
  CHECK(number("body1/a/pos", "gain") == 6);
  CHECK(number("body1/a/pos", "stiffness") == 12);
  CHECK(number("body1/a/pos", "bias") == -6);  // of the ref
  CHECK(number("body1/a/pos", "maxForce") == 14);
  CHECK(number("body1/a/pos", "most") == 1);
  CHECK(number("body2/b/motor", "least") == -1);
  CHECK(number("body2/b/motor", "most") == 4);
  CHECK(number("body2/b/motor", "gain") == 2);
  CHECK(number("body3/c/affine", "bias") == 2);
  CHECK(number("body3/c/affine", "stiffness") == 8);
  CHECK(number("body3/c/affine", "damping") == 12);
  CHECK(number("body4/d/damp", "gainDamping") == 20);
  CHECK(number("body4/d/damp", "damping") == 0);
  CHECK(number("body5/e/against", "least") == -2);  // a negative gain: the limits change places
  CHECK(number("body5/e/against", "most") == 0.5);
}

TEST_CASE("the forces of several actuators of a joint add up") {
  RobotHost h;
  h.import(R"(<mujoco model='m'><option gravity='0 0 0'/><worldbody>
    <body name='b'><joint name='j' axis='0 0 1'/><geom size='.1' pos='1 0 0' mass='1'/></body></worldbody>
    <actuator><position name='p' joint='j' kp='10'/><velocity name='v' joint='j' kv='5'/><motor name='t' joint='j'/>
    </actuator></mujoco>)");
  CHECK(h.act("m/b/j/p", "(p 0.2)").empty());
  CHECK(h.act("m/b/j/t", "(t 3)").empty());
  setProperty(h.kernel.root().require<Leaf>("/usr/scene/world"), "autoDisableFlag", false);  // as it turns around
  h.step(1000);
  CHECK(h.at<IJoint>("m/b/j").angle(0) == Approx(0.5).margin(1e-6));
}

}  // namespace spark::test
