// Reads joints, actuators, limits and flags of MJCF models.

#include "read_model.h"

using namespace spark;
using namespace spark::mjcf;
using namespace spark::mjcf::test;

TEST_CASE("actuators are read as gain and bias of a force on a joint") {
  const Read r(R"(<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>
    <motor joint='j' gear='3' forcerange='-2 2'/><position joint='j' kp='7'/>
    <velocity joint='j' kv='5' ctrlrange='-1 1'/>
    <general joint='j' gainprm='4' biastype='affine' biasprm='1 -2 -3'/><muscle joint='j'/></actuator></mujoco>)");
  const std::vector<Actuator>& a = r.model.actuators;
  REQUIRE(a.size() == 5);
  CHECK(a[0].gear == 3);
  CHECK(a[0].forceRange == std::array<double, 2>{-2, 2});
  CHECK(a[1].bias == std::array<double, 3>{0, -7, 0});
  CHECK(a[2].bias == std::array<double, 3>{0, 0, -5});
  CHECK(a[2].controlRange == std::array<double, 2>{-1, 1});
  CHECK(a[3].gain == std::array<double, 3>{4, 0, 0});
  CHECK(a[3].bias == std::array<double, 3>{1, -2, -3});
  CHECK(a[4].engine.dynamics == "muscle");
  CHECK(a[4].engine.gain == std::array<double, 10>{0.75, 1.05, -1, 200, 0.5, 1.6, 1.5, 1.3, 1.2, 0});
  CHECK(a[4].engine.bias == a[4].engine.gain);
  CHECK(a[4].engine.dynamicsNumbers[1] == 0.04);
  CHECK(r.messages().empty());
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

TEST_CASE("a spring may be given by its time constant and damping ratio") {
  // Numbers of MuJoCo 2.2.2.
  const Read r(
      world("<body><joint springdamper='.1 1' axis='0 1 0'/><geom size='.1' pos='.3 0 0'/><body pos='.5 0 0'><joint "
            "springdamper='.2 .5' axis='0 1 0' armature='.1'/><geom size='.1' pos='.1 0 .2'/></body></body>"));
  CHECK(r.body(1).joints[0].stiffness == Approx(150.423).epsilon(1e-5));
  CHECK(r.body(1).joints[0].damping == Approx(30.0845).epsilon(1e-5));
  CHECK(r.body(2).joints[0].stiffness == Approx(23.5219).epsilon(1e-5));
  CHECK(r.body(2).joints[0].damping == Approx(2.35219).epsilon(1e-5));
  CHECK_THAT(named(world("<body><joint springdamper='0 1'/></body>")), Catch::Contains("two numbers above 0"));
}

TEST_CASE("a limit needs a range, and options are checked") {
  for (const char* const bad : {"limited='true'", "range='2 1'", "range='1 1' limited='true'"}) {
    const Read r(world("<body><joint " + std::string(bad) + "/><geom size='1'/></body>"));
    CHECK_FALSE(r.body(1).joints[0].limited);
    CHECK_THAT(r.messages(), Catch::StartsWith("a.xml:1:26: 'range' of <joint> is ignored: expected a lower and a "
                                               "higher number"));
  }
  const Read force(world("<body><joint actuatorfrcrange='3 -3'/><geom size='1'/></body>"));
  CHECK(std::isinf(force.body(1).joints[0].maxForce));
  CHECK_THAT(force.messages(), Catch::Contains("'actuatorfrcrange' of <joint> is ignored"));
  CHECK(Read("<mujoco><option density='-1' timestep='0' impratio='-1'/></mujoco>").model.options.size() == 1);
  CHECK(Read("<mujoco><option gravity='0 0 -9'/></mujoco>").model.options.size() == 1);
}

TEST_CASE("options that no simulation can have are ignored or bounded, and named") {
  const auto of = [](const std::string& option) { return named("<mujoco><option " + option + "/></mujoco>"); };
  CHECK_THAT(of("timestep='0'"), Catch::Contains("'timestep' of <option> is ignored: expected 1e-06 or more, found 0"));
  CHECK_THAT(of("timestep='-0.01'"), Catch::Contains("is ignored"));
  CHECK_THAT(of("impratio='0'"), Catch::Contains("'impratio' of <option> is ignored"));
  CHECK_THAT(of("viscosity='-1'"), Catch::Contains("'viscosity' of <option> is taken as 0"));
  CHECK_THAT(of("tolerance='-1'"), Catch::Contains("'tolerance' of <option> is taken as 0"));
  CHECK_THAT(of("iterations='20000'"), Catch::Contains("'iterations' of <option> is taken as 10000, found 20000"));
  CHECK(of("density='1.2' iterations='-1' o_margin='-1'").empty());
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
    CHECK_THAT(named(model("<joint limited='true'/>", "", "")), Catch::Contains("expected a lower and a higher"));
    CHECK_THAT(named(model("", "", "<motor joint='j' ctrllimited='true'/>")),
               Catch::Contains("expected a lower and a higher number for 'ctrlrange' of <motor>"));
    CHECK_THAT(named(model("", "", "<position joint='j' forcelimited='true'/>")), Catch::Contains("'forcerange'"));
  }
  SECTION("without autolimits a range alone limits nothing") {
    const Read r("<mujoco><compiler autolimits='false'/>" +
                 model("", "range='-1 1'", "<motor joint='j' ctrlrange='-1 1'/>").substr(8));
    CHECK_FALSE(r.body(1).joints[0].limited);
    CHECK(std::isinf(r.model.actuators.at(0).controlRange[0]));
  }
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
  CHECK(filtered.model.actuators.at(0).engine.dynamics == "filter");
  CHECK(filtered.messages().empty());
  const Read exact = read("", "<general name='g' joint='j' dyntype='filterexact'/>");
  CHECK(exact.model.actuators.at(0).engine.dynamics == "filter");
  CHECK_THAT(exact.messages(), Catch::Contains("<general> 'g' has the dyntype filterexact: 'filter' is used"));
  const Read unknown = read("", "<general name='g' joint='j' dyntype='user'/>");
  CHECK(unknown.model.actuators.empty());
  CHECK_THAT(unknown.messages(), Catch::Contains("<general> 'g' has the dyntype 'user', which is not supported"));
}

TEST_CASE("coordinates of joints count from the pose of the file") {
  const Read r(
      world("<body><joint ref='30' range='10 50' springref='20' stiffness='1'/>"
            "<joint type='slide' ref='0.5' range='0 1' springref='0.25' stiffness='1'/><joint range='10 50'/><geom "
            "size='1'/></body>"));
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
  CHECK(read("filterparent='disable' override='enable' refsafe='disable'").messages().empty());
  CHECK(read("midphase='disable'").messages() == "a.xml:1:17: the flag midphase=\"disable\" is not supported\n");
  CHECK_THAT(failure("<mujoco><option><flag contact='off'/></option></mujoco>"), Catch::Contains("expected enable"));
}
