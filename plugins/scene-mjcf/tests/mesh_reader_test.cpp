// Reads meshes of MJCF models.

#include <fmt/ranges.h>

#include "absence.h"
#include "read_model.h"

using namespace spark;
using namespace spark::mjcf;
using namespace spark::mjcf::test;
using spark::test::lacks;

TEST_CASE("a flat mesh adds no mass, which is named if it is needed") {
  std::string sentences;
  const auto read = [&](const std::string& content) {
    Unsupported unsupported;
    const std::string text =
        "<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody>" + content + "</worldbody></mujoco>";
    Document document("a.xml", [&](const std::string&) { return text; });
    const auto triangle = [](const std::string&) {
      engine::Mesh s;
      s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
      s.triangles = {0, 1, 2};
      return s;
    };
    const double mass = readModel(document, triangle, unsupported).bodies.back().mass.mass;
    sentences = fmt::format("{}", fmt::join(unsupported.sentences(), "\n"));
    return mass;
  };
  const std::string mesh = "<geom type='mesh' mesh='m'/>";
  CHECK(read("<body><joint/><inertial pos='0 0 0' mass='3' diaginertia='1 1 1'/>" + mesh + "</body>") == 3);
  CHECK(read("<body><joint/><geom size='1' mass='2'/><geom type='mesh' mesh='m' mass='0'/></body>") == Approx(2));
  const std::string given = sentences;
  read(mesh);
  const std::string fixed = sentences;
  CHECK(read("<body><joint/>" + mesh + "</body>") == Approx(0.01));
  CHECK_THAT(sentences, Catch::Contains("<geom> adds no mass to its body: its mesh is flat"));
  CHECK(lacks(given, "adds no mass", sentences));
  CHECK(lacks(fixed, "adds no mass", sentences));
  CHECK_THAT(sentences, Catch::Contains("a <body> that moves and has no mass gets 10 g"));
  read("<body><joint/><geom mesh='m'/></body>");
  CHECK_THAT(sentences, Catch::Contains("<geom> is left out: the mesh has no volume"));
}

TEST_CASE("a mesh that is not closed may weigh as its hull, and one that cannot be read is tried once") {
  int tries = 0;
  const auto read = [&](const engine::Mesh& s, Unsupported& unsupported) {
    const std::string text =
        "<mujoco><compiler exactmeshinertia='true'/><asset><mesh name='m' file='m.stl'/></asset><worldbody>"
        "<body><joint/><geom type='mesh' mesh='m' density='6'/><geom type='mesh' mesh='m' density='6'/></body>"
        "</worldbody></mujoco>";
    Document document("a.xml", [&](const std::string&) { return text; });
    const auto file = [&](const std::string&) {
      ++tries;
      if (s.vertices.empty()) throw Error("there is no such file");
      return s;
    };
    return readModel(document, file, unsupported).bodies.back().mass.mass;
  };
  engine::Mesh open;  // two sides of a tetrahedron through the origin
  open.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  open.triangles = {0, 2, 1, 0, 1, 3};
  Unsupported hull, missing;
  CHECK(read(open, hull) == Approx(2));
  CHECK_THAT(hull.sentences().at(0),
             Catch::Contains("<geom> weighs as the convex hull of its mesh, which has no volume (and 1 more)"));
  tries = 0;
  CHECK(read({}, missing) == Approx(0.01));
  CHECK(tries == 1);
  CHECK_THAT(missing.sentences().at(0),
             Catch::StartsWith("a.xml:1:113: <geom> is left out: a.xml:1:51: cannot read the mesh 'm.stl': there is "
                               "no such file (and 1 more)"));
}

TEST_CASE("a mesh can be written in the model, and collides as its convex hull") {
  const auto mesh = [](const std::string& attributes) {
    return "<mujoco><compiler exactmeshinertia='true'/><asset><mesh name='m' " + attributes +
           "/></asset><worldbody><body><joint/><geom type='mesh' mesh='m' density='6'/></body></worldbody></mujoco>";
  };
  const std::string tetrahedron = "vertex='0 0 0 1 0 0 0 1 0 0 0 1'";
  SECTION("without faces") {
    const Read r(mesh(tetrahedron));
    CHECK(r.body(1).mass.mass == Approx(1));
    CHECK(r.body(1).geoms[0].shape.mesh->triangles.size() == 12);
  }
  SECTION("vertices inside the hull count for the mass of faces alone") {
    // A tetrahedron with a dent.
    const std::string dented = "vertex='0 0 0 1 0 0 0 1 0 0 0 1 .1 .1 .1' ";
    const Read hull(mesh(dented));
    CHECK(hull.body(1).mass.mass == Approx(1));
    CHECK(hull.body(1).geoms[0].shape.mesh->vertices.size() == 12);
    const Read faces(mesh(dented + "face='0 2 1 0 1 3 0 3 2 1 2 4 2 3 4 3 1 4'"));
    CHECK(faces.body(1).mass.mass == Approx(0.3));
    CHECK(faces.body(1).geoms[0].shape.mesh->triangles.size() == 12);
  }
  SECTION("a cube has two triangles on each side, which point outwards") {
    const Read r(mesh("vertex='0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 .5 .5 .5'"));
    const engine::Mesh& s = *r.body(1).geoms[0].shape.mesh;
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
  SECTION("what is no mesh is left out") {
    for (const auto& [attributes, message] :
         {std::pair{"vertex='0 0 0 1 0 0 0 1 0'", "expected 12 to"},
          {"vertex='0 0 0 1 0 0 0 1 0 1 1 0'", "the mesh has no convex hull"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1 2'", "expected three numbers for each vertex, found 13"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 4'", "expected indices of the 4 vertices for 'face', found 4"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 2 3'", "expected three numbers for each triangle"},
          {"", "expected an attribute 'file' or 'vertex'"},
          {"vertex='0 0 0 1 0 0 0 1 0 0 0 1' refquat='0 0 0 0'", "expected a quaternion that is not 0"}})
      CHECK_THAT(named(mesh(attributes)), Catch::Contains(message));
  }
}

TEST_CASE("masses of meshes are MuJoCo's, unless the mesh says how") {
  const auto mass = [](const std::string& attributes, const std::string& compiler = "") {
    return Read("<mujoco>" + compiler + "<asset><mesh name='m' " + attributes +
                "/></asset><worldbody><body><joint/><geom type='mesh' mesh='m' "
                "density='6'/></body></worldbody></mujoco>")
        .body(1)
        .mass;
  };
  const std::string tetrahedron = "vertex='0 0 0 1 0 0 0 1 0 0 0 1' ";
  // Of the box with its inertia.
  CHECK(mass(tetrahedron).mass == Approx(6 * std::sqrt(0.15) * 0.6));
  CHECK(mass(tetrahedron, "<compiler exactmeshinertia='true'/>").mass == Approx(1));
  for (const char* rule : {"exact", "convex", "legacy"})
    CHECK(mass(tetrahedron + "inertia='" + rule + "'").mass == Approx(1));
  CHECK(mass(tetrahedron + "inertia='shell'").mass == Approx(6 * (1.5 + std::sqrt(0.75))));
  // With a dent, which is filled, or counted twice.
  const std::string dented =
      "vertex='0 0 0 1 0 0 0 1 0 0 0 1 .1 .1 .1' face='0 2 1 0 1 3 0 3 2 1 2 4 2 3 4 3 1 4' inertia='";
  CHECK(mass(dented + "exact'").mass == Approx(0.3));
  CHECK(mass(dented + "convex'").mass == Approx(1));
  CHECK(mass(dented + "legacy'").mass > 0.31);
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
    engine::Mesh s;
    s.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    return s;
  };
  readModel(document, read, unsupported);
  CHECK(opened == "m/cube.stl");
}
