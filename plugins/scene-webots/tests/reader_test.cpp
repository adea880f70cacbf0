#include <Eigen/Geometry>

#include "absence.h"
#include "read_world.h"
#include "robots.h"

using namespace spark;
using namespace spark::webots::test;
using namespace spark::webots;
using Catch::Contains;
using mjcf::JointKind;
using spark::test::lacks;

namespace {
std::string warnings(const std::string& nodes) { return Read(world(nodes)).messages(); }
}  // namespace

TEST_CASE("A solid with a box hangs on a hinge") {
  const Read r(world(R"(Solid { children [ HingeJoint {
    jointParameters HingeJointParameters { axis 0 1 0 anchor 0 0 1 }
    endPoint Solid { translation 0 0 0.5 rotation 0 0 1 1.5707963267948966 name "bob"
      boundingObject Box { size 0.1 0.2 0.3 } physics Physics { density 1000 } } } ] })"));
  CHECK(r.messages() == "");
  REQUIRE(r.world.models.size() == 1);
  const mjcf::Body& bob = r.body("bob");
  CHECK(bob.mass.mass == Approx(6));
  CHECK(bob.mass.inertia(0, 0) == Approx(6.0 / 12 * (0.2 * 0.2 + 0.3 * 0.3)));
  REQUIRE(bob.joints.size() == 1);
  CHECK(bob.joints[0].kind == JointKind::hinge);
  CHECK(bob.joints[0].axis.isApprox(Vec3(1, 0, 0)));  // in the frame of the solid
  CHECK(bob.joints[0].position.isApprox(Vec3(0, 0, 0.5)));
  CHECK_FALSE(bob.joints[0].limited);
  CHECK(r.body("solid").joints.empty());
}

TEST_CASE("A car has its wheels from a PROTO, and the world a floor, walls, gravity and a lamp") {
  const Read r(kCar);
  CHECK(r.messages() == "a.wbt:33:3: hidden fields, the state of a simulation that ran, are not supported");
  const mjcf::Model& car = r.model("car");
  CHECK_FALSE(car.selfCollides);
  REQUIRE(car.bodies.size() == 6);
  CHECK(r.body("car").joints.at(0).kind == JointKind::free);
  CHECK(r.body("car").mass.mass == 2);
  CHECK(r.body("car").pose.position == Vec3(0, 0, 0.05));
  const mjcf::Body& wheel = r.body("left wheel");
  CHECK(wheel.mass.mass == 0.1);
  CHECK(wheel.mass.inertia(2, 2) == Approx(0.5 * 0.1 * 0.05 * 0.05));
  CHECK(wheel.joints.at(0).name == "left motor");
  CHECK(wheel.joints.at(0).axis.isApprox(Vec3(0, 0, -1)));
  CHECK(wheel.joints.at(0).position.norm() < 1e-12);
  CHECK(wheel.joints.at(0).maxForce == 0.5);
  REQUIRE(wheel.geoms.size() == 2);
  CHECK(wheel.geoms[1].color == std::array{0.2, 0.2, 0.2, 1.0});
  CHECK(r.body("right wheel").geoms[1].color == std::array{1.0, 1.0, 1.0, 1.0});
  REQUIRE(car.actuators.size() == 6);
  CHECK(car.actuators[1].name == "left motor_vel");
  CHECK(car.actuators[1].controlRange == std::array{-6.28, 6.28});
  std::vector<std::string> sensors;
  for (const mjcf::Sensor& s : car.sensors) sensors.push_back(s.name);
  CHECK(sensors == std::vector<std::string>{"left sensor", "right sensor", "ds0", "gps"});
  // A device looks along x, a perceptor along y.
  const mjcf::Site& site = r.body("ds0").sites.at(0);
  CHECK((site.pose.rotation * Vec3::UnitY()).isApprox(Vec3::UnitX()));
  CHECK(r.model("scenery").bodies[0].geoms.size() == 5);
  const auto& options = r.world.models.back().options;
  REQUIRE(options.size() == 1);
  CHECK(options[0].value == spark::Value(List{0.0, 0.0, -9.8}));
  CHECK(r.world.basicTimeStep == 16);
  REQUIRE(r.world.lights.size() == 1);
  CHECK(r.world.lights[0].name == "LAMP");
  CHECK(r.world.lights[0].diffuse == std::array{0.5, 0.5, 0.25});
}

TEST_CASE("A PROTO file is a robot with the defaults of its fields") {
  const Read r(kHumanoid);
  CHECK(r.messages() == "");
  const mjcf::Model& walker = r.model("walker");
  CHECK(walker.selfCollides);
  CHECK(r.body("walker").mass.mass == Approx(500 * 0.1 * 0.15 * 0.2));
  const mjcf::Joint& hip = r.body("LThigh").joints.at(0);
  CHECK(hip.reference == 0.25);
  CHECK(hip.range == std::array{-1.75, 0.25});  // its coordinate is 0 in the pose of the file
  CHECK(hip.maxForce == 12);
  CHECK(hip.damping == 0.1);
  const mjcf::Joint& knee = r.body("LShin").joints.at(0);
  CHECK(knee.range == std::array{-2.2, 0.1});
  CHECK(knee.stiffness == 2);
  CHECK(knee.springPosition == 0);
  CHECK(knee.dryFriction == 0.3);
  CHECK(r.body("LThigh").mass.inertia(0, 2) == 0.0001);
  CHECK(r.body("LThigh").mass.center == Vec3(0.01, 0, -0.1));
  CHECK(walker.actuators[0].controlRange == std::array{-1.2, 0.4});
  CHECK(walker.actuators[3].controlRange == std::array{-2.2, 0.1});
  std::vector<std::string> kinds;
  for (const mjcf::Sensor& s : walker.sensors) kinds.push_back(s.perceptor ? s.perceptor : s.kind);
  CHECK(kinds ==
        std::vector<std::string>{"accelerometer", "gyro", "framequat", "jointpos", "jointpos", "TouchPerceptor"});
  CHECK(walker.sensors[2].name == "inertial unit");
}

TEST_CASE("A world gives a PROTO of another file its fields") {
  const std::string text = world(R"(EXTERNPROTO "protos/Walker.proto"
    Walker { translation 1 2 3 name "w" kneeStop -1 headSlot [ Solid { name "head" } Solid { name "head" } ] })");
  const Read r(text, Base::byFile, {{"protos/Walker.proto", kHumanoid}});
  CHECK(r.messages() == "");
  CHECK(r.body("w").pose.position == Vec3(1, 2, 3));
  CHECK(r.body("LShin").joints.at(0).range[0] == -1);
  CHECK(r.body("head").parent == r.body("head~2").parent);
  const Read web(
      world(R"(EXTERNPROTO "https://raw.githubusercontent.com/a/b/R2023b/projects/robots/w/protos/Walker.proto"
    Walker { speed 3 })"),
      Base::byFile, {{"projects/robots/w/protos/Walker.proto", kHumanoid}});
  CHECK_THAT(web.messages(), Contains("a.wbt:3:5: the PROTO 'Walker' has no field 'speed', which is ignored"));
}

TEST_CASE("An arm without a Physics stands; its meshes collide as their hulls") {
  const Read r(kArm);
  CHECK(r.messages() == "");
  CHECK(r.body("arm").joints.empty());
  const mjcf::Body& upper = r.body("upper");
  CHECK(upper.mass.mass == 3.5);
  CHECK(upper.mass.center.isApprox(Vec3(0.5, 0.5, 0.5)));
  CHECK(upper.geoms.at(0).shape.mesh->triangles.size() == 36);
  const mjcf::Body& tool = r.body("tool");
  CHECK(tool.mass.mass == Approx(1000 * 0.001 / 6));
  CHECK(tool.joints.at(0).kind == JointKind::slide);
  CHECK(tool.joints.at(0).axis == Vec3(1, 0, 0));
  CHECK(tool.joints.at(0).range == std::array{0.0, 0.2});
  const Read free(kArm, Base::free);
  CHECK(free.body("arm").joints.at(0).kind == JointKind::free);
  CHECK_THAT(free.messages(), Contains("a solid that moves and has no mass gets 10 g"));
  const Read fixed(kCar, Base::fixed);
  CHECK(fixed.body("car").joints.empty());
}

TEST_CASE("A joint of two axes is two hinges; the first one turns the second") {
  const Read r(kBuggy);
  CHECK(r.messages() == "");
  const mjcf::Body& wheel = r.body("wheel");
  REQUIRE(wheel.joints.size() == 2);
  CHECK(wheel.joints[0].name == "steer");
  CHECK(wheel.joints[1].name == "roll");
  CHECK(wheel.joints[0].axis.isApprox(Vec3::UnitZ()));
  CHECK(wheel.joints[1].axis.isApprox(Vec3::UnitY()));  // it turns with the wheel
  CHECK(wheel.joints[0].range[0] == Approx(-0.9));
  CHECK(r.body("trailer").joints.at(0).kind == JointKind::ball);
  CHECK(r.body("trailer").joints.at(0).position == Vec3(0.4, 0, 0));
}

TEST_CASE("A scale makes solids, joints and shapes larger") {
  const Read r(world(R"(Transform { scale 2 2 2 children [ Solid { translation 1 0 0 children [ HingeJoint {
    jointParameters HingeJointParameters { anchor 1 0 0 }
    endPoint Solid { translation 2 0 0 name "b" boundingObject Sphere { radius 1 } physics Physics { mass 1 } } } ] } ] })"));
  CHECK(r.body("solid").pose.position == Vec3(2, 0, 0));
  CHECK(r.body("b").pose.position == Vec3(4, 0, 0));
  CHECK(r.body("b").joints[0].position == Vec3(-2, 0, 0));
  CHECK(r.body("b").geoms[0].shape.radius == 2);
  CHECK_THAT(warnings("Transform { scale 1 2 1 children Solid { } }"),
             Contains("expected one scale in all directions for a Solid; its mean is taken"));
  CHECK_THAT(warnings("Transform { scale 0 1 1 }"),
             Contains("a.wbt:2:13: expected three numbers that are not 0 for 'scale'; 1 is taken"));
  CHECK_THAT(warnings("Solid { boundingObject Transform { scale 1 1 2 children Sphere { } } }"),
             Contains("a bounding object is left out: expected one scale in all directions for a Sphere"));
}

TEST_CASE("A mirror turns rotations and axes, and leaves shapes as they are") {
  const Read r(world(R"(Robot { children [ Transform { scale 1 -1 1 children [
    Shape { geometry Box { size 0.1 0.2 0.3 } }
    Pose { translation 0 1 0 rotation 0 0 1 0.5 children Shape { geometry Capsule { radius 0.1 height 1 } } }
    HingeJoint { jointParameters HingeJointParameters { axis 0 0 1 anchor 0 2 0 }
      endPoint Solid { translation 0 2 0 name "arm" boundingObject Box { size 1 1 1 } physics Physics { } } }
    SliderJoint { jointParameters JointParameters { axis 0 1 0 }
      endPoint Solid { name "tray" boundingObject Box { size 1 1 1 } physics Physics { } } } ] } ] })"));
  CHECK(r.messages() == "");
  const mjcf::Body& robot = r.body("robot");
  REQUIRE(robot.geoms.size() == 2);
  CHECK(robot.geoms[0].shape.lengths == Vec3(0.1, 0.2, 0.3));
  CHECK(robot.geoms[1].pose.position == Vec3(0, -1, 0));
  CHECK(robot.geoms[1].pose.rotation.isApprox(Eigen::AngleAxisd(-0.5, Vec3::UnitZ()).toRotationMatrix()));
  CHECK(r.body("arm").pose.position == Vec3(0, -2, 0));
  CHECK(r.body("arm").joints.at(0).position.norm() < 1e-12);
  CHECK(r.body("arm").joints[0].axis == Vec3(0, 0, -1));
  CHECK(r.body("tray").joints.at(0).axis == Vec3(0, -1, 0));
}

TEST_CASE("What is not supported is named with its place") {
  const Read r(world(R"(WorldInfo { contactProperties [ ContactProperties { bounce 0.5 } ] colour 1 }
Robot { children [
  LED { } LED { }
  Lidar { maxRange 5 }
  HingeJoint { device Brake { } endPoint Solid { boundingObject Plane { } physics Physics { mass 1 damping Damping { } } } }
  HingeJoint { endPoint SolidReference { solidName "x" } }
  HingeJoint { }
  TouchSensor { type "force" }
  Shape { appearance Parquetry { } geometry Cone { } }
] })"));
  const std::string m = r.messages();
  for (const char* text :
       {"a.wbt:2:53: the field 'bounce' of ContactProperties is not supported",
        "the field 'colour' of WorldInfo is not supported",
        "a.wbt:4:3: the device LED is not supported: only its body and its shapes are read (and 1 more)",
        "a Lidar has one layer", "a Brake in a joint is not supported", "the damping of a Physics is not supported",
        "a Plane that moves is not supported", "the loop is open", "a HingeJoint without an endPoint is ignored",
        "a TouchSensor of type 'force' is not supported", "the appearance Parquetry is a PROTO that is not there",
        "the geometry Cone is not supported",
        "a Physics with a mass and no volume has the inertia of a sphere of water"})
    CHECK_THAT(m, Contains(text));
}

TEST_CASE("A part that means nothing is left out, and named with its place") {
  const auto names = [](const std::string& nodes, const std::string& text) {
    INFO(nodes);
    CHECK_THAT(warnings(nodes), Contains(text));
  };
  names("Solid { translation 1 2 }",
        "a.wbt:2:9: expected 3 numbers for 'translation' of Solid, found 2 numbers; it is ignored");
  names("Solid { rotation 0 0 0 1 }", "expected an axis that is not 0");
  names("Solid { children 3 }", "expected nodes for 'children' of Solid, found one number");
  names("Solid { name 3 }", "expected a text in quotes for 'name' of Solid");
  names("Solid { boundingObject Box { size 1 0 1 } }",
        "a.wbt:2:24: a bounding object is left out: expected three lengths above 0");
  names("Solid { boundingObject Sphere { radius -1 } }", "expected a length above 0 for 'radius' of Sphere");
  names("Solid { boundingObject Physics { } }", "a.wbt:2:24: a node Physics cannot be here");
  names("Solid { physics Box { } }", "a.wbt:2:17: a node Box cannot be here");
  names("Solid { physics Physics { mass -3 } }", "expected a mass of 0 or more, or -1, found -3");
  names("Solid { physics Physics { inertiaMatrix [ 1 1 1 ] mass 1 } }",
        "expected two vectors for 'inertiaMatrix', found 3");
  names("Solid { physics Physics { inertiaMatrix [ 1 1 1 0 0 0 ] } }", "expected a 'mass' beside 'inertiaMatrix'");
  names("Solid { boundingObject Mesh { url \"missing.stl\" } }",
        "a.wbt:2:24: a bounding object is left out: cannot read the mesh 'missing.stl'");
  names("Solid { boundingObject IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 ] } } }",
        "expected points of 3 numbers");
  names("Robot { children HingeJoint { device LinearMotor { } endPoint Solid { } } }",
        "expected a RotationalMotor in this joint");
  names(
      "Robot { children HingeJoint { jointParameters HingeJointParameters { minStop 1 maxStop -1 } endPoint Solid { } "
      "} }",
      "expected 'minStop' not above 'maxStop', found 1 and -1");
  names("Robot { children HingeJoint { jointParameters HingeJointParameters { axis 0 0 0 } endPoint Solid { } } }",
        "expected an axis that is not 0");
  names("WorldInfo { coordinateSystem \"XYZ\" }", "expected \"ENU\", \"NUE\" or \"EUN\" for 'coordinateSystem'");
  names("WorldInfo { gravity -1 }", "expected a number of 0 or more for 'gravity' of WorldInfo, found -1");
  names("Robot { children Camera { width 0 } }", "expected a whole number from 1 to 4096 for 'width', found 0");
  names("Solid { children USE A }", "a.wbt:2:18: expected the name of a node that a DEF before this place ends");
  names("Solid { name IS x }", "a.wbt:2:9: expected the name of a field of a PROTO behind IS, found 'x'");
  names("Solid { translation 1e300 0 0 }", "expected a place at most 1e+06 m away; 0 0 0 is taken");
}

TEST_CASE("A motor's targets count as in the file, whatever the position of its joint there is") {
  const auto ranges = [](const std::string& parameters, const std::string& motor) {
    const Read r(world("Robot { children HingeJoint { jointParameters HingeJointParameters { " + parameters +
                       " } device RotationalMotor { " + motor +
                       " } endPoint Solid { name \"arm\" physics Physics { "
                       "mass 1 } boundingObject Box { } } } physics Physics { mass 1 } boundingObject Box { } }"));
    const mjcf::Model& m = r.model("robot");
    REQUIRE(m.actuators.size() == 3);
    return std::array{m.actuators[0].controlRange, r.body("arm").joints.at(0).range};
  };
  using Range = std::array<double, 2>;
  const Range all{-HUGE_VAL, HUGE_VAL};
  // Stops bound the targets; the joint's coordinate is 0 in the pose of the file, a target is not.
  CHECK(ranges("minStop -1 maxStop 2", "")[0] == Range{-1, 2});
  CHECK(ranges("position 0.5 minStop -1 maxStop 2", "") == std::array{Range{-1, 2}, Range{-1.5, 1.5}});
  CHECK(ranges("position 0.5 minStop -1 maxStop 2", "minPosition -0.25 maxPosition 1")[0] == Range{-0.25, 1});
  CHECK(ranges("position 0.5", "minPosition -0.25 maxPosition 1")[0] == Range{-0.25, 1});
  CHECK(ranges("position 0.5", "")[0] == all);
}

TEST_CASE("Fields and nodes that nothing has heard of are named") {
  // "..." is where the field stands.
  for (const std::string around :
       {"WorldInfo { ... }",
        "WorldInfo { contactProperties ContactProperties { ... } }",
        "Viewpoint { ... }",
        "Background { ... }",
        "Fog { ... }",
        "PointLight { ... }",
        "SpotLight { ... }",
        "DirectionalLight { ... }",
        "Solid { ... }",
        "Robot { ... }",
        "Group { ... }",
        "Pose { ... }",
        "Transform { ... }",
        "Shape { ... }",
        "Floor { ... }",
        "RectangleArena { ... }",
        "CircleArena { ... }",
        "Shape { geometry Box { ... } }",
        "Shape { geometry Mesh { ... } }",
        "Shape { geometry Sphere { ... } }",
        "Shape { geometry IndexedFaceSet { ... } }",
        "Shape { appearance Appearance { material Material { } ... } geometry Sphere { } }",
        "Shape { appearance Appearance { material Material { ... } } geometry Sphere { } }",
        "Shape { appearance PBRAppearance { ... } geometry Sphere { } }",
        "Solid { physics Physics { ... } }",
        "Solid { boundingObject Cylinder { ... } }",
        "Solid { boundingObject Capsule { ... } }",
        "Solid { boundingObject Plane { ... } }",
        "Solid { boundingObject Mesh { url \"a.stl\" ... } }",
        "Solid { boundingObject ElevationGrid { xDimension 2 yDimension 2 height [ 0 0 0 1 ] ... } }",
        "Solid { boundingObject Shape { geometry Box { } ... } }",
        "Solid { boundingObject Pose { ... } }",
        "Solid { children [ Pose { ... } ] }",
        "Solid { children [ Slot { ... } ] }",
        "Robot { children HingeJoint { endPoint Solid { } ... } }",
        "Robot { children BallJoint { endPoint Solid { } ... } }",
        "Robot { children HingeJoint { jointParameters HingeJointParameters { ... } endPoint Solid { } } }",
        "Robot { children BallJoint { jointParameters BallJointParameters { ... } endPoint Solid { } } }",
        "Robot { children HingeJoint { device RotationalMotor { ... } endPoint Solid { } } }",
        "Robot { children HingeJoint { device PositionSensor { ... } endPoint Solid { } } }",
        "Robot { children SliderJoint { device LinearMotor { ... } endPoint Solid { } } }"}) {
    INFO(around);
    const std::size_t at = around.find("...");
    const std::string text = around.substr(0, at) + "unheard 1" + around.substr(at + 3);
    CHECK_THAT(warnings(text), Contains(fmt::format("a.wbt:2:{}: the field 'unheard' of", at + 1)));
  }
  for (const std::string around :
       {"...", "Group { children ... }", "Robot { children [ ... ] }", "Solid { boundingObject ... }",
        "Solid { physics ... }", "Shape { geometry ... }", "Shape { appearance ... geometry Sphere { } }",
        "Robot { children HingeJoint { endPoint ... } }",
        "Robot { children HingeJoint { device ... endPoint Solid { } } }",
        "Robot { children HingeJoint { jointParameters ... endPoint Solid { } } }",
        "Robot { children [ Slot { endPoint ... } ] }"}) {
    INFO(around);
    const std::size_t at = around.find("...");
    const std::string text = around.substr(0, at) + "Unheard { }" + around.substr(at + 3);
    CHECK_THAT(warnings(text), Contains(fmt::format("a.wbt:2:{}: ", at + 1)) && Contains("Unheard"));
  }
}

TEST_CASE("Materials have the friction that contactProperties give their pairs") {
  const Read r(world(R"(Solid { name "shoe" contactMaterial "rubber" boundingObject Sphere { } }
Solid { name "floor" boundingObject Sphere { } } Solid { name "skate" contactMaterial "steel" boundingObject Sphere { } }
Solid { name "toy" contactMaterial "wood" boundingObject Sphere { } }
WorldInfo { contactProperties [ ContactProperties { material1 "rubber" coulombFriction 3 bumpSound "" }
  ContactProperties { material1 "ice" material2 "steel" coulombFriction [ 0.25 0.25 ] } ContactProperties { }
  ContactProperties { material1 "default" material2 "ice" coulombFriction 0.5 }
  ContactProperties { material1 "steel" coulombFriction 0.1 }
  ContactProperties { material2 "steel" coulombFriction 0.1 } ] })"));
  const auto contact = [&](const char* name) { return r.body(name).geoms[0].contact; };
  CHECK(contact("floor").friction[0] == 1);
  CHECK(contact("shoe").friction[0] == 3);
  CHECK(contact("skate").friction[0] == 0.1);
  CHECK(contact("toy").friction[0] == 1);
  // Beside the floor the other surface counts alone.
  CHECK(contact("floor").priority == 0);
  CHECK(contact("shoe").priority == 1);
  CHECK(contact("skate").priority == 1);
  CHECK(contact("toy").priority == 0);
  CHECK_THAT(r.messages(), Contains("a.wbt:6:3: the friction of \"ice\" on \"steel\" is 0.3, not 0.25: two surfaces") &&
                               Contains("a.wbt:9:3: a second ContactProperties for two materials is ignored"));
}

TEST_CASE("Materials that are not beside the default have the mean of their pairs") {
  const auto with = [](const std::string& more) {
    return world(R"(WorldInfo { contactProperties [ ContactProperties { material1 "a" material2 "b" coulombFriction 2 }
  ContactProperties { material1 "b" material2 "c" coulombFriction 3 } ContactProperties { coulombFriction 0.5 } )" +
                 more + R"( ] }
Solid { name "a" contactMaterial "a" boundingObject Sphere { } } Solid { name "b" contactMaterial "b" boundingObject Sphere { } }
Solid { name "c" contactMaterial "c" boundingObject Sphere { } } Solid { name "d" contactMaterial "d" boundingObject Sphere { } }
Solid { name "e" boundingObject Sphere { } })");
  };
  const Read r(with(""));
  const Read against(with(R"(ContactProperties { material1 "a" material2 "c" coulombFriction 9 })"));
  CHECK(lacks(r.messages(), "friction", against.messages()));
  const auto contact = [&](const char* name) { return r.body(name).geoms[0].contact; };
  CHECK(contact("a").friction[0] == 2);
  CHECK(contact("b").friction[0] == 2);
  CHECK(contact("c").friction[0] == 4);
  CHECK(contact("d").friction[0] == 1);
  CHECK(contact("d").priority == 1);
  CHECK(contact("e").friction[0] == 0.5);
}

TEST_CASE("Friction that makes no sense is 1, and named") {
  const auto names = [](const std::string& fields, const std::string& text) {
    CHECK_THAT(warnings("WorldInfo { contactProperties ContactProperties { " + fields + " } }"), Contains(text));
  };
  names("coulombFriction -3", "expected a coulombFriction of 0 or more, or -1, found -3; 1 is taken");
  names("coulombFriction [ 1 2 ]", "a coulombFriction that differs in its directions is not supported");
  CHECK(warnings("WorldInfo { contactProperties ContactProperties { material1 \"a\" coulombFriction -1 } }").empty());
  CHECK_THAT(warnings("WorldInfo { contactProperties Box { } }"), Contains("a node Box cannot be here"));
}

TEST_CASE("An elevation grid is a mesh of its heights, in old files over x and z") {
  const char* const kGrid =
      "Solid { boundingObject ElevationGrid { xDimension 3 %cDimension 2 xSpacing 2 %cSpacing 5 "
      "height [ 0 1 2 3 4 ] } physics NULL }";
  const auto with = [&](char axis) {
    std::string text = kGrid;
    for (std::size_t at = 0; (at = text.find("%c")) != std::string::npos;) text.replace(at, 2, 1, axis);
    return text;
  };
  const Read now(world(with('y')));
  const Read old("#VRML_SIM R2019a utf8\n" + with('z'));
  for (const Read* const r : {&now, &old}) {
    INFO(r->messages());
    const mjcf::Model& m = r->model("solid");
    const mjcf::Geom& g = m.bodies[1].geoms.at(0);
    REQUIRE(g.shape.shape == engine::Shape::convex);
    const engine::Mesh& surface = *m.surfaces.at(g.shape.mesh.get());
    REQUIRE(surface.triangles.size() == 12);
    CHECK_FALSE(g.mass);
    // The fifth point, of 4 m, and the direction in which the triangles look.
    const bool isOld = r == &old;
    const Pose pose = compose(m.bodies[1].pose, g.pose);
    const Vec3 at = pose.position + pose.rotation * surface.vertex(4);
    CHECK((at - (isOld ? Vec3(5, 2, 4) : Vec3(2, 5, 4))).norm() == Approx(0).margin(1e-9));
    const auto corner = [&](std::size_t i) { return surface.vertex(surface.triangles[i]); };
    for (std::size_t t = 0; t < 12; t += 3) CHECK((corner(t + 1) - corner(t)).cross(corner(t + 2) - corner(t)).z() > 0);
  }
  CHECK_THAT(warnings("Solid { boundingObject ElevationGrid { xDimension 3 } }"),
             Contains("expected a whole number from 2 to 4096 for 'yDimension', found 0"));
  CHECK_THAT(warnings("Solid { boundingObject ElevationGrid { xDimension 2 yDimension 2 xSpacing 0 } }"),
             Contains("expected distances above 0 between the points of an ElevationGrid"));
  CHECK_THAT(warnings("Solid { boundingObject ElevationGrid { xDimension 2 yDimension 2 height [ 1 2 3 4 5 ] } }"),
             Contains("expected 4 numbers for 'height', found 5"));
}

TEST_CASE("A mesh weighs what it encloses, one that is open as its hull") {
  // A beam of 1 x 1 m, 3 m long, without the middle third of its upper half.
  const std::string points =
      "0 0 0 3 0 0 3 0 1 2 0 1 2 0 0.5 1 0 0.5 1 0 1 0 0 1 0 1 0 3 1 0 3 1 1 2 1 1 2 1 0.5 1 1 0.5 1 1 1 0 1 1";
  const std::string sides =
      "0 1 4 5 -1 1 2 3 4 -1 0 5 6 7 -1 9 8 13 12 -1 10 9 12 11 -1 13 8 15 14 -1 1 0 8 9 -1 2 1 9 10 -1 3 2 10 11 -1 "
      "4 3 11 12 -1 5 4 12 13 -1 6 5 13 14 -1 7 6 14 15 -1";
  const auto solid = [&](const std::string& faces, const std::string& physics) {
    return world("Robot { boundingObject IndexedFaceSet { coord Coordinate { point [ " + points + " ] } coordIndex [ " +
                 faces + " ] } physics Physics { " + physics + " } }");
  };
  const Read closed(solid(sides + " 0 7 15 8 -1", "density 2"));
  const engine::Mass& m = closed.body("robot").mass;
  CHECK(m.mass == Approx(2 * 2.5));
  CHECK((m.center - Vec3(1.5, 0.5, (3 * 0.5 - 0.5 * 0.75) / 2.5)).norm() == Approx(0).margin(1e-12));
  const Read open(solid(sides, "density 2"));
  CHECK(open.body("robot").mass.mass == Approx(2 * 3.0));
  CHECK_THAT(open.messages(), Contains("a.wbt:2:24: the surface of this IndexedFaceSet is not closed"));
  CHECK(lacks(closed.messages(), "not closed", open.messages()));
  const Read given(solid(sides, "mass 7 density -1 centerOfMass 0 0 0 inertiaMatrix [ 1 1 1 0 0 0 ]"));
  CHECK(given.body("robot").mass.mass == 7);
  CHECK(lacks(given.messages(), "not closed", open.messages()));
}

TEST_CASE("A node whose PROTO is not there is empty, at its place and with its name") {
  const Read r(world(R"(Robot { children [ Chair { translation 1 2 3 name "seat" legs 4 }
    HingeJoint { endPoint Wheel { translation 0 1 0 } } Shape { geometry Gear { } } Solid { physics Heavy { } } ] }
    Tree { translation 5 0 0 })"));
  CHECK(r.body("seat").pose.position == Vec3(1, 2, 3));
  CHECK(r.body("seat").geoms.empty());
  CHECK(r.body("Wheel").joints.size() == 1);
  CHECK(r.body("Tree").pose.position == Vec3(5, 0, 0));
  const std::string m = r.messages();
  for (const char* text : {"a.wbt:2:20: a node 'Chair' is empty: its PROTO is not there: looked for Chair.proto, "
                           "protos/Chair.proto. What to do:",
                           "a node 'Wheel' is empty", "a node 'Gear' is empty", "a node 'Heavy' is empty",
                           "a.wbt:4:5: a node 'Tree' is empty"})
    CHECK_THAT(m, Contains(text));
  const Read broken(world("Broken { }\nSolid { name \"other\" }"), Base::byFile,
                    {{"Broken.proto", "#VRML_SIM R2023b utf8\nPROTO Broken [ ] { Solid { name } }"}});
  CHECK_THAT(broken.messages(), Contains("a node 'Broken' is empty: Broken.proto:2:33: expected a value"));
  CHECK(broken.world.models.size() == 2);
}

TEST_CASE("In files before R2022a y is up, and primitives stand along it") {
  const Read r(R"(#VRML_SIM R2021a utf8
WorldInfo { gravity 3.7 }
Solid { translation 1 2 3 name "post" boundingObject Group { children [ Cylinder { radius 0.1 height 3 }
  Transform { translation 0 1 0 children Capsule { radius 0.2 height 1 } } Box { size 1 2 3 } ] } }
Robot { children Camera { name "eye" } }
Solid { boundingObject Plane { } name "ground" })");
  // North is x in the file and y here, up is y in the file and z here.
  CHECK(r.body("post").pose.position.isApprox(Vec3(3, 1, 2)));
  CHECK((r.body("post").pose.rotation * Vec3::UnitY()).isApprox(Vec3::UnitZ()));
  const auto& geoms = r.body("post").geoms;
  REQUIRE(geoms.size() == 3);
  CHECK((geoms[0].pose.rotation * Vec3::UnitZ()).isApprox(Vec3::UnitY()));
  CHECK((geoms[1].pose.rotation * Vec3::UnitZ()).isApprox(Vec3::UnitY()));
  CHECK(geoms[1].pose.position == Vec3(0, 1, 0));
  CHECK(geoms[2].pose.rotation.isIdentity());
  CHECK((r.body("ground").pose.rotation * r.body("ground").geoms.at(0).pose.rotation * Vec3::UnitZ())
            .isApprox(Vec3::UnitZ()));
  // A perceptor looks along y, an old camera along -z.
  CHECK((r.body("eye").sites.at(0).pose.rotation * Vec3::UnitY()).isApprox(-Vec3::UnitZ()));
  CHECK((r.body("eye").sites.at(0).pose.rotation * Vec3::UnitZ()).isApprox(Vec3::UnitY()));
  CHECK(r.world.models.back().options.at(0).value == spark::Value(List{0.0, 0.0, -3.7}));
  const Read vector("#VRML_SIM V8.5 utf8\nWorldInfo { gravity 0 -9.81 0 }\nSolid { translation 0 1 0 }");
  CHECK(vector.messages() == "");
  CHECK(vector.body("solid").pose.position.isApprox(Vec3(0, 0, 1)));
  CHECK(vector.world.models.back().options.at(0).value == spark::Value(List{0.0, 0.0, -9.81}));
  const Read zUp("#VRML_SIM R2019b utf8\nWorldInfo { gravity 0 0 -9.81 }\nSolid { translation 0 0 1 }");
  CHECK(zUp.body("solid").pose.position == Vec3(0, 0, 1));
  // A PROTO file alone has the axes of the file that has its node.
  const Read wrapped("#VRML_SIM R2021b utf8\nPROTO W [ ] { Inner { } }", Base::byFile,
                     {{"Inner.proto", "#VRML_SIM R2022b utf8\nPROTO Inner [ ] { Robot { translation 0 0 1 } }"}});
  CHECK(wrapped.body("robot").pose.position == Vec3(0, 0, 1));
  const Read alone("#VRML_SIM R2021b utf8\nPROTO W [ ] { Robot { translation 0 1 0 } }");
  CHECK(alone.body("robot").pose.position.isApprox(Vec3(0, 0, 1)));
  const Read east(world("WorldInfo { coordinateSystem \"EUN\" }\nSolid { translation 0 1 0 }"));
  CHECK(east.body("solid").pose.position.isApprox(Vec3(0, 0, 1)));
}

TEST_CASE("Boxes and walls of Webots need no files") {
  const Read r(world(R"(SolidBox { translation 1 0 0 size 1 2 3 }
CardboardBox { mass 2 }
WoodenBox { name "crate" translation 0 1 0 }
Wall { size 0.2 3 2 }
Wall { name "unknown" })"));
  CHECK(r.body("box").geoms.at(0).shape.lengths == Vec3(1, 2, 3));
  CHECK(r.body("box").joints.empty());
  CHECK(r.body("wooden box").mass.mass == 2);
  CHECK(r.body("wooden box").pose.position == Vec3(0, 0, 0.3));
  CHECK(r.body("crate").joints.empty());
  CHECK(r.body("wall").geoms.at(0).pose.position == Vec3(0, 0, 1));
  CHECK_THAT(r.messages(), Contains("a.wbt:6:1: a node 'Wall' is empty"));
}

TEST_CASE("A joint with backlash is a joint without, and its gear has a mass") {
  const Read r(world(R"(Robot { children [ HingeJointWithBacklash { backlash 0.02 gearMass 0.5
    jointParameters HingeJointParameters { axis 0 1 0 anchor 0 0 1 } device RotationalMotor { name "m" }
    outputSensor PositionSensor { name "s" }
    endPoint Solid { translation 0 0 1 name "arm" boundingObject Box { size 1 1 1 } physics Physics { density -1 mass 2 } } } ] })"));
  CHECK(r.messages() ==
        "a.wbt:2:20: a HingeJointWithBacklash is a HingeJoint without play; its gears move with its endPoint");
  CHECK(r.body("arm").joints.at(0).name == "m");
  CHECK(r.body("arm").mass.mass == 2.5);
  CHECK(r.model("robot").sensors.at(0).name == "s");
  const Read none(
      world(R"(Robot { children [ HingeJointWithBacklash { backlash 0 endPoint Solid { name "arm" } } ] })"));
  CHECK(none.body("arm").mass.mass == 0.01);  // what moves has a mass
}

TEST_CASE("A file that grows by USE, PROTOs or depth ends in an error") {
  std::string doubling = "DEF A0 Group { }\n";
  for (int i = 1; i < 40; ++i)
    doubling += fmt::format("DEF A{} Group {{ children [ USE A{} USE A{} ] }}\n", i, i - 1, i - 1);
  CHECK_THAT(failure(world(doubling)), Contains("used ones counted each time"));
  CHECK_THAT(failure(world("Solid { boundingObject Group { children [ " + doubling + " ] } }")),
             Contains("used ones counted each time"));
  std::string protos;
  for (int i = 0; i < 40; ++i)
    protos += i == 0
                  ? "PROTO P0 [ ] { Group { } }\n"
                  : fmt::format("PROTO P{} [ ] {{ Group {{ children [ P{} {{ }} P{} {{ }} ] }} }}\n", i, i - 1, i - 1);
  CHECK_THAT(failure(world(protos + "P39 { }")), Contains("expected at most 500000 nodes in all PROTOs and files"));
  CHECK_THAT(failure(world("PROTO P [ ] { Group { children P { } } }\nP { }")),
             Contains("the PROTO 'P' contains itself"));
  CHECK_THAT(
      failure(world("Q { }"), {{"Q.proto", "#VRML_SIM R2023b utf8\nPROTO Q [ field SFNode x R { } ] { Solid { } }"},
                               {"R.proto", "#VRML_SIM R2023b utf8\nPROTO R [ ] { Q { } }"}}),
      Contains("contains itself"));
  std::string deep =
      "PROTO P [ field MFNode c [ ] ] { Group { children [ Group { children [ Group { children IS c } ] } ] } }\n";
  for (int i = 0; i < 190; ++i) deep += "P { c ";
  deep += "Group { }";
  for (int i = 0; i < 190; ++i) deep += "}";
  Read r(world(deep));  // deep, and still read
  std::string tower;
  for (int i = 0; i < 300; ++i)
    tower += i == 0 ? "PROTO P0 [ ] { Group { } }\n"
                    : fmt::format("PROTO P{} [ ] {{ Group {{ children P{} {{ }} }} }}\n", i, i - 1);
  CHECK_THAT(failure(world(tower + "P299 { }")), Contains("expected nodes nested at most 400 deep"));
}
