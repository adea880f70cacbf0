#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include "../urdf_reader.h"
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
}

TEST_CASE("Errors of a file are told with their place") {
  const std::string a = "<link name='a'>" + kMass + "</link>", b = "<link name='b'>" + kMass + "</link>";
  const auto joint = [](const std::string& rest, const std::string& type = "fixed", const std::string& name = "j") {
    return "<joint name='" + name + "' type='" + type + "'>" + rest + "</joint>";
  };
  const std::string ab = "<parent link='a'/><child link='b'/>", ba = "<parent link='b'/><child link='a'/>";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"<robot", "a.urdf:1:"},
      {"<mujoco/>", "a.urdf:1:1: expected the element <robot>, found <mujoco>"},
      {robot(""), "a.urdf:1:1: expected a <link>, found none"},
      {robot("<link/>"), "a.urdf:2:1: expected an attribute 'name' of <link>"},
      {robot(a + "\n" + a), "a.urdf:3:1: there are two links 'a'"},
      {robot(a + "\n" + b), "a.urdf:3:1: expected one link that is no child of a joint, found two, 'a' and 'b'"},
      {robot(a + b + joint(ab) + "\n" + joint(ba, "fixed", "k")), "a.urdf:1:1: each link is the child of a joint"},
      {robot(a + b + "\n" + joint(ab, "hinge")), "a.urdf:3:1: expected revolute, continuous"},
      {robot(a + "\n" + joint("<parent link='a'/>\n<child link='c'/>")), "a.urdf:4:1: there is no link 'c'"},
      {robot(a + "\n" + joint("<parent link='a'/>")), "a.urdf:3:1: expected an element <child> in <joint> 'j'"},
      {robot(a + b + joint(ab) + "\n" + joint(ab, "fixed", "k")),
       "the link 'b' is the child of two joints, 'j' and 'k'"},
      {robot(a + b + "\n" + joint(ab, "revolute")), "a.urdf:3:1: expected an element <limit> in <joint> 'j'"},
      {robot(a + b + joint(ab + "\n<limit lower='1' upper='-1'/>", "revolute")),
       "a.urdf:3:1: expected 'lower' not above"},
      {robot(a + b + joint(ab + "\n<axis xyz='0 0 0'/>", "continuous")), "a.urdf:3:1: expected an axis that is not 0"},
      {robot(a + b + joint(ab + "\n<origin xyz='0 nan 0'/>")), "a.urdf:3:1: "},
      {robot(a + b + joint(ab + "\n<origin xyz='0 0'/>")), "a.urdf:3:1: "},
      {robot(a + b + joint(ab + "<limit lower='0' upper='1'/>\n<mimic joint='x'/>", "revolute")),
       "a.urdf:3:1: there is no joint 'x'"},
      {robot(a + b + joint(ab + "<limit lower='0' upper='1'/>\n<mimic joint='j'/>", "revolute")),
       "a.urdf:3:1: expected another joint"},
      {robot(a + b + joint(ab, "floating")), "a floating joint is supported only below a root link without a mass"},
      {robot("<link name='a'>\n<collision/></link>"), "a.urdf:3:1: expected an element <geometry> in <collision>"},
      {robot("<link name='a'><collision>\n<geometry/></collision></link>"), "a.urdf:3:1: expected <box>"},
      {robot("<link name='a'><collision><geometry>\n<box size='1 0 1'/></geometry></collision></link>"),
       "a.urdf:3:1: expected three lengths above 0"},
      {robot("<link name='a'><collision><geometry>\n<sphere radius='-1'/></geometry></collision></link>"),
       "a.urdf:3:1: expected a length above 0"},
      {robot("<link name='a'><collision><geometry>\n<mesh filename='missing.stl'/></geometry></collision></link>"),
       "a.urdf:3:1: cannot read the mesh 'missing.stl'"},
      {robot("<link name='a'><inertial>\n<mass value='-1'/></inertial></link>"),
       "a.urdf:3:1: expected a mass of 0 or more"},
  };
  for (const auto& [text, expected] : cases) {
    INFO(text);
    CHECK_THAT(failure(text), Contains(expected));
  }
}

TEST_CASE("What is not supported is named once for each kind") {
  const Read r(robot("<link name='a'>" + kMass + "<contact/></link>\n<wheel/>\n<wheel/>"));
  CHECK_THAT(r.messages(), Contains("a.urdf:3:1: the element <wheel> is not supported (and 1 more)"));
  CHECK_THAT(r.messages(), Contains("the element <contact> is not supported"));
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
  for (const char* name :
       {"../../../etc/passwd", "/etc/passwd", "package://../../etc/passwd", "file:///etc/passwd", "package://", ""})
    for (const std::string& candidate : meshNames("a/b.urdf", name)) {
      INFO(name << " as " << candidate);
      CHECK_FALSE(candidate.starts_with("/"));
      CHECK(candidate.find("..") == std::string::npos);
    }
}
