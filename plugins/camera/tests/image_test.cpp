#include "../image.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "../mesh.h"
#include "spark/error.h"

using namespace spark;
using namespace spark::camera;

namespace {
std::string base64(std::string_view bytes) {
  std::string out;
  appendBase64(bytes, out);
  return out;
}

/// The files of a test.
FindFile among(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::string& name) -> std::optional<std::string> {
    const auto found = files.find(name);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  };
}
}  // namespace

TEST_CASE("base64 is that of RFC 4648, section 10") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string_view("\0\xff\xfe(\" ", 6)) == "AP/+KCIg");
}

TEST_CASE("a picture in colour is a PNG file of the same colours, the usual way up") {
  Picture p{PictureKind::colour, 2, 2, {1, 2, 3, 4, 5, 6, 255, 128, 0, 9, 8, 7}, {}};
  const Image read = readPng(writePng(p));
  CHECK(read.width == 2);
  // An image for textures has its rows from the bottom, too.
  CHECK(read.pixels == std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255, 255, 128, 0, 255, 9, 8, 7, 255});
  const std::string file = writePng(p);
  CHECK(file.substr(1, 3) == "PNG");
  CHECK(int(file[24]) == 8);  // bits, and below the type of colours (PNG specification, 11.2.2): RGB
  CHECK(int(file[25]) == 2);
}

TEST_CASE("a picture of numbers is a grey PNG file of 16 bits") {
  Picture p{PictureKind::depth, 3, 1, {0, 0, 1, 0, 255, 255}, {}};
  const std::string file = writePng(p);
  CHECK(int(file[24]) == 16);
  CHECK(int(file[25]) == 0);
}

TEST_CASE("what is no PNG file is refused") {
  CHECK_THROWS_WITH(readPng("GIF89a"), Catch::Contains("expected a PNG file"));
  Picture p{PictureKind::colour, 16, 16, std::vector<std::uint8_t>(768, 77), {}};
  const std::string file = writePng(p);
  CHECK_THROWS_AS(readPng(std::string_view(file).substr(0, file.size() / 2)), Error);
}

TEST_CASE("an OBJ file has parts by material, in alphabetical order, with colours and textures of its MTL file") {
  const std::string obj =
      "# a mesh\nmtllib things.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 -1 0\n"
      "usemtl wood\nf 1/1/1 2/2/1 3/3/1\nusemtl iron\nf 1//1 3//1 4//1\n";
  const std::string mtl =
      "newmtl wood\nKa 0.1 0.2 0.3\nKd 0.4 0.5 0.6\nKs 0.7 0.8 0.9\nNs 20\nmap_Kd wood.png\nnewmtl iron\nKd 1 0 0\nd "
      "0.5\n";
  const Mesh mesh = readObj("models/thing.obj", obj, among({{"materials/things.mtl", mtl}, {"textures/wood.png", ""}}));
  REQUIRE(mesh.parts.size() == 2);
  CHECK(mesh.parts[0].material == "iron");
  CHECK(mesh.parts[1].material == "wood");
  REQUIRE(mesh.parts[1].vertices.size() == 3);
  const Vertex& v = mesh.parts[1].vertices[2];
  CHECK((v.position[0] == 1 && v.position[1] == 0 && v.position[2] == 1));
  CHECK((v.normal[1] == -1 && v.faceNormal[1] == -1));
  CHECK((v.place[0] == 1 && v.place[1] == 1));
  for (const MeshMaterial& m : mesh.materials) {
    if (m.name == "wood") {
      CHECK(m.texture == "textures/wood.png");
      CHECK(m.look.ambient.g == Approx(0.2));
      CHECK(m.look.diffuse.b == Approx(0.6));
      CHECK(m.look.specular.r == Approx(0.7));
      CHECK(m.look.shininess == Approx(20));
    } else if (m.name == "iron") {
      CHECK(m.texture.empty());
      CHECK(m.look.diffuse.a == Approx(0.5));
    }
  }
}

TEST_CASE("a mesh without triangles is refused, and no file of the machine is read") {
  CHECK_THROWS_WITH(readObj("models/a.obj", "v 0 0 0\n", among({})), Catch::Contains("models/a.obj"));
  const Mesh mesh =
      readObj("models/a.obj", "mtllib /etc/passwd\nv 0 0 0\nv 1 0 0\nv 1 0 1\nusemtl x\nf 1 2 3\n", among({}));
  CHECK(mesh.parts.size() == 1);
}

TEST_CASE("a face of vertices that are not there is refused; indices below 0 count backwards") {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 0 1\n";
  for (const char* const face : {"f 1 2 4\n", "f 0 1 2\n", "f -4 -2 -1\n"})
    CHECK_THROWS_WITH(readObj("models/a.obj", vertices + face, among({})),
                      Catch::Contains("models/a.obj") && Catch::Contains("expected a face of its 3 vertices"));
  CHECK_THROWS_WITH(readObj("models/a.obj", vertices + "f 1//1 2//1 3//1\n", among({})),
                    Catch::Contains("expected a face of its 0 normals, found number 1"));
  CHECK(readObj("models/a.obj", vertices + "f -3 -2 -1\n", among({})).parts[0].vertices[2].position[2] == 1);
}
