#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "../urdf_reader.h"
#include "../vocabulary.h"
#include "robots.h"

using namespace spark;
using namespace spark::urdf;
using namespace spark::urdf::test;
using Catch::Contains;
using mjcf::JointKind;

namespace {

struct Read {
  mjcf::Unsupported unsupported;
  Document document;
  mjcf::Model model;
  explicit Read(const std::string& text, Base base = Base::byFile)
      : document("a.urdf", text), model(readModel(document, base, cube, unsupported)) {}
  /// A cube of 1 m.
  static engine::Mesh cube(const std::string& file) {
    if (file.ends_with("missing.stl")) throw Error("there is no such file");
    engine::Mesh s;
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k) s.vertices.push_back((i >> k) & 1);
    return s;
  }
  const mjcf::Body& body(std::string_view name) const {
    for (const mjcf::Body& b : model.bodies)
      if (b.name == name) return b;
    FAIL("no body " << name);
    return model.bodies[0];
  }
  std::vector<std::string> actuators() const {
    std::vector<std::string> out;
    for (const mjcf::Actuator& a : model.actuators) out.push_back(a.name);
    return out;
  }
  std::string messages() const { return fmt::format("{}", fmt::join(unsupported.sentences(), "\n")); }
};

std::string failure(const std::string& text) {
  try {
    Read r(text);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

std::string robot(const std::string& content) { return "<robot name=\"r\">\n" + content + "\n</robot>"; }
const std::string kMass =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";

}  // namespace

TEST_CASE("An arm stands on its base; its interfaces say how its joints are driven") {
  const Read r(kArm);
  CHECK(r.messages() == "");
  CHECK(r.model.name == "arm");
  CHECK(r.body("world").joints.empty());
  CHECK(r.body("base").joints.empty());
  const mjcf::Body& upper = r.body("upper");
  REQUIRE(upper.joints.size() == 1);
  const mjcf::Joint& shoulder = upper.joints[0];
  CHECK(shoulder.kind == JointKind::hinge);
  CHECK(shoulder.axis == Vec3(0, 1, 0));
  CHECK(shoulder.limited);
  CHECK(shoulder.range == std::array{-2.0, 2.0});
  CHECK(shoulder.maxForce == 150);
  CHECK(shoulder.damping == 0.4);
  CHECK(r.body("tool").joints.at(0).kind == JointKind::slide);
  CHECK(r.actuators() == std::vector<std::string>{"shoulder", "elbow_pos", "elbow_vel", "elbow_tau"});
  CHECK(r.model.actuators[0].controlRange == std::array{-150.0, 150.0});
  CHECK(r.model.sensors.size() == 3);
  // The visual shape has its colour and does not collide; the other collides and is not shown.
  REQUIRE(upper.geoms.size() == 2);
  CHECK(upper.geoms[0].color == std::array{0.8, 0.1, 0.1, 1.0});
  CHECK_FALSE(upper.geoms[0].collides());
  CHECK(upper.geoms[1].collides());
  CHECK_FALSE(upper.geoms[1].visible());
  CHECK(r.body("base").geoms[0].color == std::array{0.7, 0.7, 0.75, 1.0});
}

TEST_CASE("A robot whose root link has a mass moves freely, unless it is told otherwise") {
  const auto isFree = [](const Read& r, const char* root) {
    const auto& joints = r.body(root).joints;
    return joints.size() == 1 && joints[0].kind == JointKind::free;
  };
  CHECK(isFree(Read(kQuadruped), "trunk"));
  CHECK_FALSE(isFree(Read(kQuadruped, Base::fixed), "trunk"));
  CHECK(isFree(Read(kCar), "base_footprint"));  // what is fixed to it has a mass
  CHECK_FALSE(isFree(Read(kArm), "world"));
  CHECK(isFree(Read(robot("<link name='a'>" + kMass + "</link>")), "a"));
  CHECK_FALSE(isFree(Read(robot("<link name='world'>" + kMass + "</link>")), "world"));
  CHECK_FALSE(isFree(Read(robot("<link name='a'/>")), "a"));
}

TEST_CASE("A quadruped has meshes, an inertial sensor, and a controller for each joint") {
  const Read r(kQuadruped);
  CHECK(r.messages() == "");
  REQUIRE(r.body("trunk").geoms.size() == 2);
  const engine::ShapeDescription& hull = r.body("trunk").geoms[1].shape;
  CHECK(hull.shape == engine::Shape::convex);
  CHECK(hull.mesh->vertices.size() == 24);
  CHECK(*std::max_element(hull.mesh->vertices.begin(), hull.mesh->vertices.end()) == 0.5);
  REQUIRE(r.body("imu_link").sites.size() == 1);
  CHECK(r.model.actuators.size() == 6);
  std::vector<std::string> sensors;
  for (const mjcf::Sensor& s : r.model.sensors) sensors.push_back(s.kind + " " + s.name);
  CHECK(sensors ==
        std::vector<std::string>{"jointpos FL_hip", "jointpos FL_knee", "gyro imu_gyro", "accelerometer imu_acc"});
}

TEST_CASE("What a file leaves out or gets wrong is mended, and said") {
  const Read r(kGripper);
  CHECK(r.body("turner").mass.mass == Approx(0.01));
  CHECK(r.body("left_finger").mass.inertia(0, 0) > 0);
  CHECK(r.body("right_finger").mass.inertia.isApprox(0.4 * Mat3::Identity()));
  CHECK_THAT(r.messages(), Contains("a.urdf:3:3: a <link> that moves and has no mass gets 10 g"));
  CHECK_THAT(r.messages(), Contains("moments of inertia that are not above 0"));
  CHECK_THAT(r.messages(), Contains("moments of inertia that no body can have"));
  // The finger that follows is not driven.
  REQUIRE(r.model.equalities.size() == 1);
  CHECK(r.model.equalities[0].first == "right_joint");
  CHECK(r.model.equalities[0].second == "left_joint");
  CHECK(r.model.equalities[0].polynomial == std::array{0.0, 1.0, 0.0, 0.0, 0.0});
  CHECK(r.actuators().back() == "left_joint_tau");
}

TEST_CASE("Masses and moments of inertia that are next to nothing are mended, and said") {
  const auto inertial = [](const std::string& mass, const std::string& moments) {
    return robot("<link name='w'/><link name='a'><inertial><mass value='" + mass + "'/><inertia " + moments +
                 "/></inertial></link><joint name='j' type='continuous'><parent link='w'/><child link='a'/></joint>");
  };
  const double ofWater = 0.4 * std::cbrt(std::pow(0.75 / (1000 * M_PI), 2));  // of a sphere of 1 kg [kg m^2]
  // A plate of one direction, a product that leaves no moment about one axis, and a point.
  for (const char* moments : {"ixx='1e-13' iyy='1e-3' izz='1e-3'", "ixx='1' iyy='1' izz='1' ixy='1'",
                              "ixx='1e-11' iyy='1e-11' izz='1e-11'"}) {
    INFO(moments);
    const Read r(inertial("1", moments));
    CHECK(r.body("a").mass.inertia.isApprox(ofWater * Mat3::Identity(), 1e-9));
    CHECK_THAT(r.messages(), Contains("moments of inertia that are not above 0 gets those of a sphere of water"));
  }
  const Read light(inertial("1e-9", "ixx='1e-12' iyy='1e-12' izz='1e-12'"));
  CHECK(light.body("a").mass.mass == Approx(0.01));
  CHECK_THAT(light.messages(), Contains("a <link> that moves and has next to no mass gets 10 g"));
  const Read small(inertial("1e-6", "ixx='1e-12' iyy='1e-12' izz='1e-12'"));
  CHECK(small.body("a").mass.inertia.isApprox(1e-12 * Mat3::Identity()));
  CHECK(small.messages().empty());
}

TEST_CASE("Planar and floating joints") {
  const std::string links = "<link name='world'/><link name='a'>" + kMass + "</link>";
  const std::string ends = "<parent link='world'/><child link='a'/><axis xyz='0 0 2'/></joint>";
  const Read planar(robot(links + "<joint name='j' type='planar'>" + ends));
  const auto& joints = planar.body("a").joints;
  REQUIRE(joints.size() == 3);
  CHECK(joints[0].name == "j_1");
  CHECK(std::abs(joints[0].axis.z()) < 1e-15);
  CHECK(joints[0].axis.dot(joints[1].axis) == Approx(0).margin(1e-15));
  CHECK(joints[2].axis == Vec3(0, 0, 1));
  const Read floating(robot(links + "<joint name='j' type='floating'><origin xyz='1 0 0'/>" + ends));
  CHECK(floating.body("a").parent == 0);
  CHECK(floating.body("a").pose.position == Vec3(1, 0, 0));
  CHECK(floating.body("a").joints.at(0).kind == JointKind::free);
  // Below a link that moves it is free all the same, in the place that the file gives it.
  const Read deep(robot("<link name='r'>" + kMass + "</link>" + links +
                        "<joint name='k' type='continuous'><origin xyz='0 0 2'/><parent link='r'/><child link='world'/>"
                        "</joint><joint name='j' type='floating'><origin xyz='1 0 0'/>" +
                        ends));
  CHECK(deep.body("a").parent == 0);
  CHECK(deep.body("a").pose.position == Vec3(1, 0, 2));
  const Read ball(robot(links + "<joint name='j' type='spherical'>" + ends));
  CHECK(ball.body("a").joints.at(0).kind == JointKind::ball);
}

TEST_CASE("What is no robot is refused, with the place") {
  const std::string a = "<link name='a'>" + kMass + "</link>", b = "<link name='b'>" + kMass + "</link>";
  const auto joint = [](const std::string& rest, const std::string& type = "fixed", const std::string& name = "j") {
    return "<joint name='" + name + "' type='" + type + "'>" + rest + "</joint>";
  };
  const std::string ab = "<parent link='a'/><child link='b'/>", ba = "<parent link='b'/><child link='a'/>";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"<robot", "a.urdf:1:"},
      {"<mujoco/>", "a.urdf:1:1: expected the element <robot>, found <mujoco>"},
      {robot(""), "a.urdf:1:1: expected a <link>, found none"},
      {robot("<xacro:macro name='leg'/>"), "this is xacro; expand it first"},
      {robot("<link/>"), "a.urdf:2:1: expected an attribute 'name' of <link>"},
      {robot(a + "\n" + a), "a.urdf:3:1: there are two links 'a'"},
      {robot(a + b + joint(ab) + "\n" + joint(ba, "fixed", "k")), "a.urdf:1:1: each link is the child of a joint"},
      {robot("<link name='w'/>" + a + b + joint(ab) + "\n" + joint(ba, "fixed", "k")),
       "a.urdf:1:1: expected links that all hang on one root, found joints that go round in a circle"},
      {robot(a + b + "\n" + joint(ab, "hinge")), "a.urdf:3:1: expected revolute, continuous"},
      {robot(a + "\n" + joint("<parent link='a'/>\n<child link='c'/>")), "a.urdf:4:1: there is no link 'c'"},
      {robot(a + "\n" + joint("<parent link='a'/>")), "a.urdf:3:1: expected an element <child> in <joint> 'j'"},
      {robot(a + b + joint(ab) + "\n" + joint(ab)), "a.urdf:3:1: there are two joints 'j'"},
  };
  for (const auto& [text, expected] : cases) {
    INFO(text);
    CHECK_THAT(failure(text), Contains(expected));
  }
}

TEST_CASE("One bad part is left out or mended, and named with its place") {
  const std::string a = "<link name='a'>" + kMass + "</link>", b = "<link name='b'>" + kMass + "</link>";
  const auto joint = [&](const std::string& type, const std::string& rest, const std::string& name = "j") {
    return a + b + "<joint name='" + name + "' type='" + type + "'><parent link='a'/><child link='b'/>\n" + rest +
           "</joint>";
  };
  const auto shape = [](const std::string& s) {
    return "<link name='a'>" + kMass + "<collision><geometry>\n" + s + "</geometry></collision></link>";
  };
  const std::string limit = "<limit lower='0' upper='1'/>";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"<link name='a'>\n<collision/></link>",
       "a.urdf:3:1: a <collision> is left out: expected an element <geometry> in <collision>"},
      {"<link name='a'><visual>\n<geometry/></visual></link>", "a.urdf:3:1: a <visual> is left out: expected <box>"},
      {shape("<cone/>"), "a.urdf:2:"},
      {shape("<box size='1 0 1'/>"), "a.urdf:3:1: a <collision> is left out: expected three lengths above 0"},
      {shape("<box/>"), "found ''"},
      {shape("<sphere radius='-1'/>"), "a.urdf:3:1: a <collision> is left out: expected a length above 0 for 'radius'"},
      {shape("<cylinder radius='1' length='0'/>"), "expected a length above 0 for 'length' of <cylinder>, found '0'"},
      {shape("<mesh filename='missing.stl'/>"),
       "a.urdf:3:1: a <collision> is left out: cannot read the mesh 'missing.stl': there is no such file"},
      {shape("<mesh filename='a.stl' scale='1 0 0'/>"), "the mesh 'a.stl' has no convex hull"},
      {shape("<mesh/>"), "expected an attribute 'filename' of <mesh>"},
      {shape("<mesh filename='a.stl' scale='0.001'/>"), "a 'scale' of one number counts for all three directions"},
      {shape("<box size='1 1 1'/><sphere radius='1'/>"), "a <geometry> with several shapes has the first alone"},
      {"<link name='a'><inertial>\n<mass value='-1'/></inertial></link>", "a.urdf:3:1: a mass below 0 counts as none"},
      {"<link name='a'><inertial>\n<mass value='1kg'/></inertial></link>",
       "a.urdf:3:1: the attribute 'value' of <mass> is ignored: expected a number, found '1kg'"},
      {"<link name='a'><visual><geometry><box size='1 1 1'/></geometry>\n<material name='gold'/></visual></link>",
       "a.urdf:3:1: there is no material 'gold' with a colour: it is grey"},
      {joint("fixed", "<origin xyz='0 nan 0'/>"),
       "a.urdf:3:1: the attribute 'xyz' of <origin> is ignored: expected 3 numbers, found '0 nan 0'"},
      {joint("fixed", "<origin xyz='0 0' rpy=''/>"), "the attribute 'rpy' of <origin> is ignored"},
      {joint("fixed", "<origin xyz='${x} 0 0'/>"), "found '${x} 0 0'"},
      {joint("continuous", "<axis xyz='0 0 0'/>"), "a.urdf:3:1: an axis of length 0 counts as '1 0 0'"},
      {joint("revolute", ""), "a.urdf:2:"},
      {joint("revolute", "<limit lower='1' upper='-1'/>"), "a.urdf:3:1: a <limit> whose 'lower' is not below"},
      {joint("revolute", limit + "<mimic joint='x'/>"),
       "a.urdf:3:29: the <mimic> of the joint 'j' is left out: there is no joint 'x'"},
      {joint("revolute", limit + "<mimic joint='j'/>"), "expected another joint of one axis, found 'j'"},
      {joint("prismatic", "<limit lower='0' upper='1' effort='-1'/>"), "an 'effort' that is not above 0"},
      {joint("continuous", "<dynamics damping='-1'/>"), "a 'damping' below 0 counts as 0"},
      {joint("fixed", "") + "<joint name='k' type='fixed'><parent link='a'/><child link='b'/></joint>",
       "the joint 'k' is left out: its child, the link 'b', is that of the joint 'j' already"},
      {joint("fixed", "") + "\n<link name='c'/>",
       "a.urdf:4:1: the link 'c' is left out: it does not hang on the root link 'a'"},
      {a + "\n<joint name='j' type='fixed'><parent link='world'/><child link='a'/></joint>",
       "there is no link 'world': the world itself is meant"},
      {a + "\n<transmission name='t'><joint name='gone'/></transmission>",
       "a.urdf:3:24: the <transmission> 't' is left out: there is no joint 'gone'"},
      {a + "\n<transmission name='t'><joint/></transmission>",
       "a.urdf:3:24: the <transmission> 't' is left out: expected an attribute 'name' of <joint>"},
      {a + "\n<transmission name='t'/>", "a.urdf:3:1: the <transmission> 't' is left out: expected an element <joint>"},
      {joint("fixed", "") + "\n<transmission name='t'><joint name='j'/></transmission>",
       "a.urdf:4:24: the <transmission> 't' is left out: the joint 'j' is none of one axis"},
      {joint("continuous", "") + "<transmission name='t'><joint name='j'/></transmission>\n" +
           "<transmission name='u'><joint name='j'/></transmission>",
       "a.urdf:4:24: the <transmission> 'u' is left out: the joint 'j' has one already"},
      {a + "\n<gazebo reference='gone'/>", "a.urdf:3:1: <gazebo> is ignored: there is no link or joint 'gone'"},
  };
  for (const auto& [text, expected] : cases) {
    INFO(text);
    const Read r(robot(text));
    CHECK_THAT(r.messages(), Contains(expected));
    CHECK(r.body("a").geoms.size() <= 1);
    CHECK(r.model.equalities.empty());
  }
}

TEST_CASE("A part that is left out costs nothing else") {
  const Read r(robot("<link name='a'>" + kMass +
                     "<collision><geometry><box size='0 0 0'/></geometry></collision>"
                     "<collision><geometry><box size='1 2 3'/></geometry></collision></link>"));
  REQUIRE(r.body("a").geoms.size() == 1);
  CHECK(r.body("a").geoms[0].shape.lengths == Vec3(1, 2, 3));
}

TEST_CASE("A joint whose limits are the same, or which has none, turns freely") {
  const std::string links = "<link name='a'>" + kMass + "</link><link name='b'>" + kMass + "</link>";
  for (const char* limit :
       {"", "<limit lower='0' upper='0'/>", "<limit effort='3'/>", "<limit lower='2' upper='-2'/>"}) {
    INFO(limit);
    const Read r(
        robot(links + "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>" + limit + "</joint>"));
    CHECK_FALSE(r.body("b").joints.at(0).limited);
  }
}

TEST_CASE("What Gazebo says about links and joints acts") {
  const std::string box =
      "<collision><geometry><box size='1 1 1'/></geometry></collision>"
      "<visual><geometry><box size='1 1 1'/></geometry></visual>";
  const std::string links = "<link name='a'>" + kMass + box + "</link><link name='b'>" + kMass + box +
                            "</link><link name='c'>" + kMass + box + "</link>";
  const std::string joints =
      "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='continuous'><parent link='b'/><child link='c'/></joint>";
  const Read r(robot(links + joints +
                     "<gazebo reference='a'><mu1>0.25</mu1><mu2 value='0.5'/><material>Gazebo/Red</material></gazebo>"
                     "<gazebo reference='b'><turnGravityOff>true</turnGravityOff></gazebo>"
                     "<gazebo reference='c'><selfCollide>1</selfCollide><gravity>maybe</gravity></gazebo>"
                     "<gazebo reference='k'><springStiffness>3</springStiffness></gazebo>\n"
                     "<gazebo reference='a'><kp>1e6</kp></gazebo><gazebo><plugin name='p'/></gazebo>"));
  CHECK(r.body("a").geoms.at(0).contact.friction[0] == 0.25);
  CHECK(r.body("a").geoms.at(1).color == std::array{1.0, 0.0, 0.0, 1.0});
  CHECK(r.body("b").gravityCompensation == 1);
  CHECK(r.body("c").joints.at(0).stiffness == 3);
  // c collides with a; a and b do not.
  CHECK(r.model.selfCollides);
  REQUIRE(r.model.exclusions.size() == 1);
  CHECK(r.model.exclusions[0].body1 + r.model.exclusions[0].body2 == "ab");
  for (const char* said : {"a <mu2> other than <mu1> is ignored", "<gravity> is ignored: expected true or false",
                           "a.urdf:3:23: the element <kp> is not supported", "the element <plugin> is not supported"})
    CHECK_THAT(r.messages(), Contains(said));
  const Read still(robot("<link name='a'>" + kMass + "</link><gazebo><static>true</static></gazebo>"));
  CHECK(still.body("a").joints.empty());
}

TEST_CASE("Every kind of sensor of Gazebo has the rate of its file, and none without one") {
  for (const char* type : {"imu", "ray", "gpu_ray", "lidar", "gpu_lidar", "camera", "depth", "depth_camera", "rgbd",
                           "rgbd_camera", "contact", "sonar", "gps", "navsat"}) {
    CAPTURE(type);
    const auto rates = [&](const std::string& content) {
      const Read r(robot("<link name='a'>" + kMass + "</link><gazebo reference='a'><sensor name='s' type='" + type +
                         "'>" + content + "</sensor></gazebo>"));
      CHECK(r.messages() == "");
      std::vector<double> all;
      for (const mjcf::Sensor& s : r.model.sensors) all.push_back(s.rate);
      return all;
    };
    const std::vector<double> with = rates("<update_rate>10</update_rate>"), without = rates("");
    REQUIRE(!with.empty());
    CHECK(with == std::vector<double>(with.size(), 10));
    CHECK(without == std::vector<double>(with.size(), 0));
  }
}

namespace {

std::string first(std::string_view words) { return std::string(words.substr(0, words.find(' '))); }

/// The elements around one in `place`, such as "link/visual": the tags that open them in a robot, and close them.
std::pair<std::string, std::string> around(const std::string& place) {
  const std::size_t slash = place.find('/');
  if (slash == std::string::npos) return {};  // the robot itself
  const std::string parent = place.substr(0, slash), tag = place.substr(slash + 1);
  std::pair<std::string, std::string> outer;
  if (parent != "robot")
    for (const Word& w : vocabulary())
      if (w.element == parent) {
        const std::string in = first(w.in);
        outer = around(in.substr(in.find('/') + 1) + "/" + parent);
      }
  return {outer.first + "<" + tag + ">", "</" + tag + ">" + outer.second};
}

}  // namespace

TEST_CASE("Every element and attribute that URDF does not have is named, in every kind of element") {
  for (const Word& word : vocabulary()) {
    if (word.content == Word::foreign) continue;
    const std::string tag(word.element), content = " oddity='1'>\n<peculiar/></" + tag + ">";
    const auto [open, close] = around(first(word.in));
    const std::string text =
        word.in.empty() ? "<robot" + content : "<robot>" + open + "<" + tag + content + close + "</robot>";
    INFO(text);
    Unsupported unsupported;
    const Document document("a.urdf", text);
    nameUnknown(document.root(), unsupported);
    CHECK(unsupported.sentences() ==
          std::vector<std::string>{fmt::format("a.urdf:1:{}: the attribute 'oddity' of <{}> is not supported",
                                               text.find("<" + tag + " ") + 1, tag),
                                   "a.urdf:2:1: the element <peculiar> is not supported"});
  }
}

TEST_CASE("What is there twice, and text where none is expected, is named") {
  const Read r(robot("<link name='a'>" + kMass + "\n" + kMass + "</link>hello\n<wheel/>\n<wheel/>"));
  CHECK_THAT(r.messages(), Contains("a.urdf:3:1: a second <inertial> in <link> is ignored"));
  CHECK_THAT(r.messages(), Contains("a.urdf:1:1: text in <robot> is ignored"));
  CHECK_THAT(r.messages(), Contains("a.urdf:4:1: the element <wheel> is not supported (and 1 more)"));
}

TEST_CASE("The README has the table of what is read") {
  std::ifstream in(SPARK_SOURCES "/plugins/scene-urdf/README.md");
  const std::string readme{std::istreambuf_iterator(in), {}};
  const auto code = [](std::string_view words) {
    std::string out;
    for (const char c : words) out += c == ' ' ? "` `" : std::string(1, c);
    return out.empty() ? out : "`" + out + "`";
  };
  std::size_t rows = 0;
  for (const Word& w : vocabulary()) {
    const std::string row = fmt::format("| `{}` | {} | {} | {} |\n", w.element, code(w.in), code(w.read), code(w.idle));
    INFO(row);
    CHECK(readme.find(row) != std::string::npos);
    ++rows;
  }
  const std::size_t begin = readme.find("| element | in |");
  REQUIRE(begin != std::string::npos);
  const std::string table = readme.substr(begin, readme.find("\n\n", begin) - begin);
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) == rows + 1);
}

TEST_CASE("Meshes are looked for around the file") {
  using Names = std::vector<std::string>;
  CHECK(meshNames("dog_description/urdf/dog.urdf", "package://dog_description/meshes/a.stl").front() ==
        "dog_description/urdf/dog_description/meshes/a.stl");
  const Names package = meshNames("dog_description/urdf/dog.urdf", "package://dog_description/meshes/a.stl");
  CHECK(std::find(package.begin(), package.end(), "dog_description/meshes/a.stl") != package.end());
  CHECK(std::find(package.begin(), package.end(), "meshes/a.stl") != package.end());
  CHECK(meshNames("robots/dog.urdf", "../meshes/a.stl").front() == "meshes/a.stl");
  CHECK(meshNames("dog.urdf", "meshes/a.stl") == Names{"meshes/a.stl"});
  CHECK(meshNames("dog.urdf", "file://$(find cat)/a.stl") == meshNames("dog.urdf", "package://cat/a.stl"));
  CHECK(meshNames("dog.urdf", "meshes\\a.stl") == Names{"meshes/a.stl"});
  CHECK(partsOf("package://cat/meshes/a.stl") == Names{"cat", "meshes", "a.stl"});
  // None is absolute or leads out of the folder of files.
  for (const char* name : {"../../../etc/passwd", "package://", ""}) CHECK(meshNames("a/b.urdf", name) == Names{});
  for (const char* name : {"/etc/passwd", "file:///etc/passwd"})
    CHECK(meshNames("a/b.urdf", name) == Names{"a/etc/passwd", "etc/passwd"});
  CHECK(meshNames("a/b.urdf", "package://../../etc/passwd") == Names{"etc/passwd"});
}
