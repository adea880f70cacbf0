// An arm of Webots and the same arm of URDF, which is compared with MuJoCo, have the same masses and move alike.
#include <Eigen/Geometry>

#include "../../physics/tests/physics_house.h"
#include "api/scene.h"
#include "temporary_folder.h"

using namespace spark;
using namespace spark::test;

namespace {

/// "x y z angle" of URDF's roll, pitch and yaw.
std::string turned(double roll, double pitch, double yaw) {
  const Eigen::AngleAxisd a(Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
                            Eigen::AngleAxisd(roll, Vec3::UnitX()));
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", a.axis().x(), a.axis().y(), a.axis().z(), a.angle());
}

const std::string kUrdf = R"(<robot name="arm">
  <link name="world"/>
  <joint name="shoulder" type="revolute"><parent link="world"/><child link="upper"/><origin xyz="0 0 0.22" rpy="0 0.3 0.2"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="150" velocity="3"/><dynamics damping="0.4" friction="0"/></joint>
  <link name="upper"><inertial><origin xyz="0 0.02 0.2"/><mass value="3.5"/>
    <inertia ixx="0.05" ixy="0.002" ixz="-0.001" iyy="0.04" iyz="0.003" izz="0.02"/></inertial></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.01 0 0.4" rpy="0.1 0 -0.2"/>
    <axis xyz="0 0.6 0.8"/><limit lower="-2.5" upper="2.5" effort="80" velocity="3"/><dynamics damping="0.2"/></joint>
  <link name="fore"><inertial><origin xyz="0 0 0.15"/><mass value="1.5"/>
    <inertia ixx="0.012" ixy="0" ixz="0" iyy="0.011" iyz="0" izz="0.004"/></inertial></link>
  <joint name="lift" type="prismatic"><parent link="fore"/><child link="tool"/><origin xyz="0 0 0.3" rpy="0 1.2 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.5" upper="0.5" effort="40" velocity="1"/><dynamics damping="3"/></joint>
  <link name="tool"><inertial><mass value="0.4"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <joint name="flange" type="fixed"><parent link="tool"/><child link="tip"/><origin xyz="0.05 0 0" rpy="0.5 0 0"/></joint>
  <link name="tip"><inertial><origin xyz="0.02 0.01 0"/><mass value="0.1"/>
    <inertia ixx="0.0002" ixy="0" ixz="0" iyy="0.0003" iyz="0" izz="0.0003"/></inertial></link>
</robot>)";

/// The axes of URDF are those of the child, of Webots those of the parent.
std::string axisIn(const std::string& axisAngle, const Vec3& axis) {
  std::istringstream in(axisAngle);
  double x = 0, y = 0, z = 0, angle = 0;
  in >> x >> y >> z >> angle;
  const Vec3 out = Eigen::AngleAxisd(angle, Vec3(x, y, z)) * axis;
  return fmt::format("{:.17g} {:.17g} {:.17g}", out.x(), out.y(), out.z());
}

std::string webotsText() {
  const std::string shoulder = turned(0, 0.3, 0.2), elbow = turned(0.1, 0, -0.2), lift = turned(0, 1.2, 0);
  return "#VRML_SIM R2025a utf8\nWorldInfo { gravity 9.81 }\nRobot { name \"arm\" children HingeJoint {\n"
         "jointParameters HingeJointParameters { anchor 0 0 0.22 minStop -2 maxStop 2 dampingConstant 0.4 axis " +
         axisIn(shoulder, {0, 1, 0}) + "}\ndevice PositionSensor { name \"shoulder\" }\n" +
         "endPoint Solid { name \"upper\" translation 0 0 0.22 rotation " + shoulder + R"(
  physics Physics { mass 3.5 density -1 centerOfMass [ 0 0.02 0.2 ] inertiaMatrix [ 0.05 0.04 0.02 0.002 -0.001 0.003 ] }
  children HingeJoint {
    jointParameters HingeJointParameters { anchor 0.01 0 0.4 minStop -2.5 maxStop 2.5 dampingConstant 0.2 axis )" +
         axisIn(elbow, {0, 0.6, 0.8}) + R"( }
    device PositionSensor { name "elbow" }
    endPoint Solid { name "fore" translation 0.01 0 0.4 rotation )" +
         elbow + R"(
      physics Physics { mass 1.5 density -1 centerOfMass [ 0 0 0.15 ] inertiaMatrix [ 0.012 0.011 0.004 0 0 0 ] }
      children SliderJoint {
        jointParameters JointParameters { minStop -0.5 maxStop 0.5 dampingConstant 3 axis )" +
         axisIn(lift, {1, 0, 0}) + R"( }
        device PositionSensor { name "lift" }
        endPoint Solid { name "tool" translation 0 0 0.3 rotation )" +
         lift + R"(
          physics Physics { mass 0.4 density -1 centerOfMass [ 0 0 0 ] inertiaMatrix [ 0.001 0.001 0.001 0 0 0 ] }
          children Pose { translation 0.05 0 0 children Solid { name "tip" rotation 1 0 0 0.5
            physics Physics { mass 0.1 density -1 centerOfMass [ 0.02 0.01 0 ] inertiaMatrix [ 0.0002 0.0003 0.0003 0 0 0 ] } } }
        } } } } } } })";
}

struct Arm : PhysicsHost {
  TemporaryFolder folder;
  std::vector<IJoint*> joints;
  Arm(const char* importer, const std::string& file, const std::string& text) {
    for (const char* plugin : {"files", "scene-urdf", "scene-webots"}) kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create(importer, "/sys/server/scene/importer");
    folder.write(file, text);
    call(scene, "importScene", List{file});
    scene.collect(joints);
  }
  double mass(const char* link) {
    return getProperty(*scene.child("arm")->asNode()->child(link)->asNode()->child("body"), "mass").toNumber();
  }
};

}  // namespace

TEST_CASE("An arm of Webots has the masses of the same arm in URDF, and falls as it does") {
  Arm urdf("UrdfImporter", "arm.urdf", kUrdf), arm("WebotsImporter", "arm.wbt", webotsText());
  for (const char* link : {"upper", "fore", "tool"}) CHECK(arm.mass(link) == Approx(urdf.mass(link)).epsilon(1e-12));
  REQUIRE(urdf.joints.size() == 3);
  REQUIRE(arm.joints.size() == 3);
  double worst = 0, moved = 0;
  for (int cycle = 0; cycle < 50; ++cycle) {
    urdf.step();
    arm.step();
    for (std::size_t i = 0; i < 3; ++i) {
      REQUIRE(urdf.joints[i]->leaf().name() == arm.joints[i]->leaf().name());
      worst = std::max(worst, std::abs(urdf.joints[i]->angle(0) - arm.joints[i]->angle(0)));
      moved = std::max(moved, std::abs(arm.joints[i]->angle(0)));
    }
  }
  CHECK(moved > 0.5);
  CHECK(worst < 1e-9);
}
