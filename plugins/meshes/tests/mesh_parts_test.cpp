// Mesh files with several parts: none is dropped without a word.

#include <catch2/catch.hpp>
#include <string>

#include "../hull.h"
#include "../mesh_file.h"
#include "../visual_mesh.h"
#include "spark/error.h"
#include "volume.h"

using namespace spark;
using meshes::readMesh;
using spark::test::volumeOf;

namespace {

double highest(const engine::Mesh& m, int axis) {
  double out = -HUGE_VAL;
  for (std::size_t i = 0; i < m.vertices.size() / 3; ++i) out = std::max(out, m.vertex(i)[axis]);
  return out;
}

// A cube from 0 to 1 along each axis: corner i has the bits of i as x, y and z.
const std::string kPolylist =
    R"(<polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4 4 4 4 4 4</vcount>)"
    "<p>0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5</p></polylist>";
const std::string kPolygons =
    R"(<polygons count="6"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 3 1</p><p>4 5 7 6</p>)"
    "<p>0 1 5 4</p><p>2 6 7 3</p><p>0 4 6 2</p><p>1 3 7 5</p></polygons>";
const std::string kTriangles =
    R"(<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/>)"
    "<p>0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5</p></triangles>";
const std::string kStrips =
    R"(<tristrips count="6"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 3</p><p>4 5 6 7</p>)"
    "<p>0 1 4 5</p><p>2 6 3 7</p><p>0 4 2 6</p><p>1 3 5 7</p></tristrips>";
const std::string kFans =
    R"(<trifans count="6"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 3 1</p><p>4 5 7 6</p>)"
    "<p>0 1 5 4</p><p>2 6 7 3</p><p>0 4 6 2</p><p>1 3 7 5</p></trifans>";
const std::string kLines =
    R"(<lines count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 3</p></lines>)";
const std::string kStrip = R"(<linestrips count="1"><input semantic="VERTEX" source="#v" offset="0"/>)"
                           "<p>0 1 3 2</p></linestrips>";

/// A Collada file with one geometry `g`, and nodes of a scene.
std::string dae(const std::string& primitives,
                const std::string& nodes = R"(<node><instance_geometry url="#g"/></node>)",
                const std::string& asset = "<up_axis>Z_UP</up_axis>") {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">)"
         "<asset>" +
         asset +
         R"(</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">)"
         "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1"
         R"(</float_array><technique_common><accessor source="#a" count="8" stride="3"><param name="X" type="float"/>)"
         R"(<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>)"
         R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
         primitives +
         R"(</mesh></geometry></library_geometries><library_nodes><node id="n"><translate>0 0 2</translate>)"
         R"(<instance_geometry url="#g"/></node></library_nodes><library_visual_scenes><visual_scene id="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

}  // namespace

TEST_CASE("A Collada file has all its parts: polygons, triangles, strips, fans") {
  const std::pair<const char*, std::string> kinds[] = {{"polylist", kPolylist},
                                                       {"polygons", kPolygons},
                                                       {"triangles", kTriangles},
                                                       {"tristrips", kStrips},
                                                       {"trifans", kFans}};
  for (const auto& [name, primitives] : kinds) {
    INFO(name);
    std::vector<std::string> leftOut;
    const engine::Mesh m = readMesh("a.dae", dae(primitives), &leftOut);
    CHECK(m.triangles.size() == 36);
    CHECK(volumeOf(m) == Approx(1));
    CHECK(leftOut.empty());
    std::size_t seen = 0;
    for (const auto& part : meshes::readVisualMesh("a.dae", dae(primitives), [](auto&) { return std::nullopt; }).parts)
      seen += part.vertices.size();
    CHECK(seen == 36);
  }
  for (const auto& [name, primitives] : kinds) {
    INFO("triangles beside " << name);
    CHECK(volumeOf(readMesh("a.dae", dae(kTriangles + primitives))) == Approx(2));
  }
}

TEST_CASE("Nodes of a file put its geometries in their places, also several times and mirrored") {
  const auto read = [](const std::string& nodes) { return readMesh("a.dae", dae(kPolylist, nodes)); };
  const std::string g = R"(<instance_geometry url="#g"/>)";
  const engine::Mesh twice = read("<node>" + g + "</node><node><translate>0 0 5</translate>" + g + "</node>");
  CHECK(volumeOf(twice) == Approx(2));
  CHECK(highest(twice, 2) == Approx(6));
  const engine::Mesh nested =
      read("<node><translate>1 0 0</translate><node><scale>2 3 4</scale><translate>1 0 0</translate>" + g +
           "</node></node>");
  CHECK(volumeOf(nested) == Approx(24));
  CHECK(highest(nested, 0) == Approx(5));
  const engine::Mesh shared = read(R"(<node><instance_node url="#n"/></node><node>)" + g + "</node>");
  CHECK(volumeOf(shared) == Approx(2));
  CHECK(highest(shared, 2) == Approx(3));
  // The triangles of a mirrored part still point outwards.
  const engine::Mesh mirrored = read("<node><scale>-1 1 1</scale>" + g + "</node>");
  CHECK(volumeOf(mirrored) == Approx(1));
  CHECK(highest(mirrored, 0) == Approx(0));
}

TEST_CASE("A Collada file has metres of its unit, whichever axis is up") {
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    INFO(up);
    const std::string asset = std::string(R"(<unit name="centimeter" meter="0.01"/><up_axis>)") + up + "</up_axis>";
    const engine::Mesh m =
        readMesh("a.dae", dae(kPolylist, R"(<node><scale>1 2 3</scale><instance_geometry url="#g"/></node>)", asset));
    CHECK(highest(m, 0) == Approx(0.01));
    CHECK(highest(m, 1) == Approx(0.02));
    CHECK(highest(m, 2) == Approx(0.03));
  }
}

TEST_CASE("Lines and points of a file are named, its triangles stay") {
  const auto leftOut = [](const std::string& name, const std::string& bytes) {
    std::vector<std::string> out;
    CHECK(volumeOf(readMesh(name, bytes, &out)) == Approx(1));
    return out;
  };
  using Names = std::vector<std::string>;
  CHECK(leftOut("a.dae", dae(kTriangles + kLines)) == Names{"2 lines"});
  CHECK(leftOut("a.dae", dae(kStrip + kPolylist)) == Names{"3 lines"});
  std::string obj;
  for (int i = 0; i < 8; ++i)
    obj += "v " + std::to_string(i & 1) + ' ' + std::to_string((i >> 1) & 1) + ' ' + std::to_string(i >> 2) + '\n';
  const std::string faces =
      "g one\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\no two\nf 3 7 8 4\nf -8 -4 -2 -6\nf 2/1 4/2 8/3 6/1\n";
  CHECK(leftOut("a.obj", obj + "vt 0 0\nvt 0 1\nvt 1 0\n" + faces).empty());
  CHECK(leftOut("a.obj", obj + "vt 0 0\nvt 0 1\nvt 1 0\n" + faces + "l 1 2\nl 1 2 3\np 1\n") ==
        Names{"1 point", "2 lines"});
}

TEST_CASE("The vertices of lines and points that are left out are too: a convex hull is that of the triangles") {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const engine::Mesh alone = readMesh("a.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const engine::Mesh mesh =
      readMesh("a.obj", "v 9 9 9\nv 8 8 8\n" + corners + "l 1 2\nf 3 5 4\nf 3 4 6\nf 4 5 6\nf 3 6 5\nv 7 7 7\np 7\n");
  CHECK(mesh.vertices == alone.vertices);
  CHECK(mesh.triangles == alone.triangles);
}

TEST_CASE("A PLY file and an STL file of text are read") {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  CHECK(volumeOf(readMesh("a.ply", ply)) == Approx(1.0 / 6));
  std::string stl = "solid a part\n";
  for (const char* face : {"0 0 0/0 1 0/1 0 0", "0 0 0/1 0 0/0 0 1", "0 0 0/0 0 1/0 1 0", "1 0 0/0 1 0/0 0 1"}) {
    std::string corners = face;
    for (std::size_t at; (at = corners.find('/')) != std::string::npos;) corners.replace(at, 1, "\nvertex ");
    stl += "facet normal 0 0 0\nouter loop\nvertex " + corners + "\nendloop\nendfacet\n";
  }
  CHECK(volumeOf(readMesh("a.stl", stl + "endsolid a part\n")) == Approx(1.0 / 6));
  // Several solids in one file.
  CHECK(volumeOf(readMesh("a.stl", stl + "endsolid a part\n" + stl + "endsolid a part\n")) == Approx(2.0 / 6));
}
