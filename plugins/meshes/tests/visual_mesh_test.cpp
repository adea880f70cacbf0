#include "../visual_mesh.h"

#include <catch2/catch.hpp>
#include <map>

#include "spark/error.h"
#include "tetrahedron.h"

using namespace spark;
using namespace spark::meshes;
using namespace spark::test;

namespace {
/// The files of a test.
FindFile among(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::string& name) -> std::optional<std::string> {
    const auto found = files.find(name);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  };
}
}  // namespace

TEST_CASE("an OBJ file has parts by material, in alphabetical order, with colours and textures of its MTL file") {
  const std::string obj =
      "# a mesh\nmtllib things.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 -1 0\n"
      "usemtl wood\nf 1/1/1 2/2/1 3/3/1\nusemtl iron\nf 1//1 3//1 4//1\n";
  const std::string mtl =
      "newmtl wood\nKa 0.1 0.2 0.3\nKd 0.4 0.5 0.6\nKs 0.7 0.8 0.9\nNs 20\nmap_Kd wood.png\nnewmtl iron\nKd 1 0 0\nd "
      "0.5\n";
  const VisualMesh mesh =
      readVisualMesh("models/thing.obj", obj, among({{"materials/things.mtl", mtl}, {"textures/wood.png", ""}}));
  REQUIRE(mesh.parts.size() == 2);
  CHECK(mesh.parts[0].material == "iron");
  CHECK(mesh.parts[1].material == "wood");
  REQUIRE(mesh.parts[1].vertices.size() == 3);
  const Vertex& v = mesh.parts[1].vertices[2];
  CHECK((v.position[0] == 1 && v.position[1] == 0 && v.position[2] == 1));
  CHECK((v.normal[1] == -1 && v.faceNormal[1] == -1));
  CHECK((v.place[0] == 1 && v.place[1] == 1));
  const auto material = [&](const std::string& name) {
    for (const MeshMaterial& m : mesh.materials)
      if (m.name == name) return m;
    FAIL("no material " << name);
    return MeshMaterial{};
  };
  const MeshMaterial wood = material("wood"), iron = material("iron");
  CHECK(wood.texture == "textures/wood.png");
  CHECK(wood.look.ambient.g == Approx(0.2));
  CHECK(wood.look.diffuse.b == Approx(0.6));
  CHECK(wood.look.specular.r == Approx(0.7));
  CHECK(wood.look.shininess == Approx(20));
  CHECK(iron.texture.empty());
  CHECK(iron.look.diffuse.a == Approx(0.5));
}

TEST_CASE("a mesh without triangles is refused, and no file of the machine is read") {
  CHECK_THROWS_WITH(readVisualMesh("models/a.obj", "v 0 0 0\n", among({})), Catch::Contains("models/a.obj"));
  const VisualMesh mesh =
      readVisualMesh("models/a.obj", "mtllib /etc/passwd\nv 0 0 0\nv 1 0 0\nv 1 0 1\nusemtl x\nf 1 2 3\n", among({}));
  CHECK(mesh.parts.size() == 1);
}

TEST_CASE("a face of vertices that are not there is refused; indices below 0 count backwards") {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 0 1\n";
  for (const char* const face : {"f 1 2 4\n", "f 0 1 2\n", "f -4 -2 -1\n"})
    CHECK_THROWS_WITH(readVisualMesh("models/a.obj", vertices + face, among({})),
                      Catch::Contains("models/a.obj") && Catch::Contains("expected a face of its 3 vertices"));
  CHECK_THROWS_WITH(readVisualMesh("models/a.obj", vertices + "f 1//1 2//1 3//1\n", among({})),
                    Catch::Contains("expected a face of its 0 normals, found number 1"));
  CHECK(readVisualMesh("models/a.obj", vertices + "f -3 -2 -1\n", among({})).parts[0].vertices[2].position[2] == 1);
}

TEST_CASE("a mesh looks the same in each format: flat triangles where a file has no normals") {
  const std::pair<const char*, std::string> files[] = {
      {"a.obj", kObj}, {"A.STL", stl()}, {"a.dae", kDae}, {"models/a.glb", glb()}};
  for (const auto& [name, bytes] : files) {
    INFO(name);
    const VisualMesh mesh = readVisualMesh(name, bytes, among({}));
    REQUIRE(mesh.parts.size() == 1);
    CHECK(mesh.parts[0].material.empty());
    REQUIRE(mesh.parts[0].vertices.size() == 12);
    int backwards = 0;
    for (std::size_t i = 0; i < 12; i += 3) {
      const Vertex& v = mesh.parts[0].vertices[i];
      backwards += v.normal[0] + v.normal[1] + v.normal[2] < 0 ? 1 : 0;  // three faces look along -x, -y and -z
      for (int k = 0; k < 3; ++k) CHECK(v.normal[k] == Approx(v.faceNormal[k]));
    }
    CHECK(backwards == 3);
  }
}

TEST_CASE("a mesh file of glTF has the colours of its materials") {
  const std::string red = R"({"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.1,0.2,1]}})";
  const VisualMesh mesh = readVisualMesh("a.glb", glb(red), among({}));
  REQUIRE(mesh.parts.size() == 1);
  CHECK(mesh.parts[0].material == "red");
  REQUIRE(mesh.materials.size() == 1);
  CHECK(mesh.materials[0].name == "red");
  CHECK(mesh.materials[0].look.diffuse.r == Approx(0.8));
  CHECK(mesh.materials[0].look.diffuse.b == Approx(0.2));
}

TEST_CASE("a mesh file of an unknown kind, or that is damaged, is not shown, with a reason") {
  CHECK_THROWS_WITH(readVisualMesh("a.txt", "x", among({})), Catch::Contains("such as .obj, .stl"));
  CHECK_THROWS_AS(readVisualMesh("a.stl", "no mesh", among({})), Error);
  CHECK_THROWS_AS(readVisualMesh("a.msh", "short", among({})), Error);
}

TEST_CASE("files of materials that a mesh names are read once, and have a limit together") {
  const std::string face = "v 0 0 0\nv 1 0 0\nv 1 0 1\nusemtl m7\nf 1 2 3\n";
  std::string many, names;
  for (int i = 0; i < 2000; ++i) many += fmt::format("newmtl m{}\nmap_Kd wood.png\n", i);
  for (int i = 0; i < 500; ++i) names += fmt::format("mtllib {}many.mtl\n", std::string(i, '/'));
  int reads = 0, textures = 0;
  const FindFile find = [&](const std::string& name) -> std::optional<std::string> {
    if (name == "textures/wood.png") return ++textures, "";
    if (!name.starts_with("materials/")) return std::nullopt;
    return ++reads, name == "materials/flood.mtl" ? many + many + many : many;
  };
  CHECK(readVisualMesh("models/a.obj", names + face, find).materials.size() == 2000);
  CHECK(textures < 3);
  CHECK(reads <= 2);
  CHECK(readVisualMesh("models/a.obj", "mtllib none.mtl\n" + face, [](const std::string&) {
          return "";
        }).parts.size() == 1);
  CHECK_THROWS_WITH(readVisualMesh("models/a.obj", "mtllib flood.mtl\n" + face, find),
                    Catch::Contains("expected at most 4096 materials, found 6000"));
}
