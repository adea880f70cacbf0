#include "../image.h"
#include "studio.h"
#include "temporary_folder.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A square of 2 m at y = 0, from x = -1 and z = -1 on, with a texture of four fields, and a roof of one colour above.
const char kObj[] =
    "# a test\n# mesh\nmtllib board.mtl\no board\n"
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 2\nv 1 1 2\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\nvn 0 -0.70710678 0.70710678\n"
    "usemtl fields\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n"
    "usemtl roof\nf 4/1/2 3/1/2 6/1/2\nf 4/1/2 6/1/2 5/1/2\n";
const char kMtl[] =
    "# a test\n# file\nnewmtl fields\nKa 1 1 1\nKd 0 0 0\nmap_Kd fields.png\n"
    "newmtl roof\nKa 0 0.5 0\nKd 0 0 0\n";

/// That mesh at (0, 4, 1), in ambient light.
struct Board : Studio {
  Board() {
    Picture fields{PictureKind::colour, 64, 64, {}, {}};
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        for (const int v : {x < 32 ? 255 : 0, y < 32 ? 255 : 0, 100}) fields.pixels.push_back(std::uint8_t(v));
    folder.write("models/board.obj", kObj);
    folder.write("materials/board.mtl", kMtl);
    folder.write("textures/fields.png", camera::writePng(fields));
    Leaf& files = kernel.create("DirectoryFileSystem", "/sys/server/file/test");
    setProperty(files, "path", folder.path().string());
    light({0, 0, 5}, {1, 1, 1, 1}, {0, 0, 0, 1});
    mesh = &place("board", {0, 4, 1}).create("StaticMesh", "mesh");
    call(*mesh, "load", {"models/board.obj"});
  }
  TemporaryFolder folder;
  Leaf* mesh;
};

}  // namespace

TEST_CASE("a mesh has the colours of its materials and of its texture, the right way up") {
  Board board;
  board.take(PictureKind::colour);
  const double pixels = 120 / std::tan(degToRad(30)) / 4;  // of a metre at 4 m
  const auto at = [&](double x, double z) { return board.colour(int(160 + pixels * x), int(120 + pixels * z)); };
  CHECK(at(-0.5, -0.5) == std::array{255, 255, 100});
  CHECK(at(0.5, -0.5) == std::array{0, 255, 100});
  CHECK(at(-0.5, 0.5) == std::array{255, 0, 100});
  CHECK(at(0.5, 0.5) == std::array{0, 0, 100});
  CHECK(at(0, 1.1) == std::array{0, 128, 0});
}

TEST_CASE("depths of a mesh are those of its triangles, to a millimetre, and it has one number") {
  Board board;
  board.take(PictureKind::depth);
  for (int y = 74; y < 180; y += 7)
    for (int x = 125; x < 195; x += 7) {
      const Vec3 r = board.ray(x + 0.5, y + 0.5);
      // The roof: z - 2 = y - 4, seen from a height of 1.
      const double depth = 4 * r.z() < 1 ? 4 : 3 / (1 - r.z());
      if (std::abs(4 * r.z() - 1) < 0.02) continue;
      INFO(x << " " << y);
      CHECK(std::abs(board.number(x, y) - 1000 * depth) <= 1);
    }
  board.take(PictureKind::segmentation);
  CHECK(board.picture.seen == std::vector<std::uint16_t>{board.numberOf(*board.mesh)});
}

TEST_CASE("materials of the server take the place of the mesh's, and a solid can have a picture, too") {
  Board board;
  board.material("matRose", "ambient", {0.8f, 0.4f, 0.2f, 1});
  Studio::call(*board.mesh, "resetMaterials", {"matRose", "roof"});
  board.take(PictureKind::colour);
  CHECK(board.colour(160, 120) == std::array{204, 102, 51});

  Leaf& wood = board.materials->create("Material2DTexture", "wood");
  setProperty(wood, "ambient", List{1, 1, 1, 1});
  setProperty(wood, "diffuse", List{0, 0, 0, 1});
  setProperty(wood, "diffuseTexture", "textures/fields.png");
  board.solid(board.place("crate", {0, 3, 1}), "Box", "setExtents", {2.0, 2.0, 2.0}, "wood");
  board.take(PictureKind::colour);
  CHECK(board.colour(140, 100) == std::array{255, 255, 100});
  CHECK(board.colour(180, 100) == std::array{0, 255, 100});
  CHECK(board.colour(140, 140) == std::array{255, 0, 100});
}

TEST_CASE("a file that cannot be read is logged once, and what is left is seen") {
  Board board;
  board.folder.write("textures/fields.png", "no picture");
  board.folder.write("models/empty.obj", "v 0 0 0\n");
  Studio::call(board.place("nothing", {0, 2, 1}).create("StaticMesh", "mesh"), "load", {"models/empty.obj"});
  board.take(PictureKind::colour);
  CHECK_THAT(board.text, Catch::Contains("cameras do not show 'textures/fields.png': expected a PNG file") &&
                             Catch::Contains("cameras do not show 'models/empty.obj'"));
  CHECK(board.colour(160, 120) == std::array{255, 255, 255});
  const std::size_t length = board.text.size();
  board.server->as<ISceneServer>()->markModified();
  board.take(PictureKind::colour);
  CHECK(board.text.size() == length);
}

namespace {
/// A studio with physics, and a mesh "None" without a file.
struct Workshop : Studio {
  Workshop() {
    for (const char* name : {"physics", "physics-ode"}) kernel.plugins().use(name);
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    kernel.create("World", "/usr/scene/world");
    kernel.create("Space", "/usr/scene/space");
    material("None", "ambient", {0.4f, 0, 0, 1});
    light({0, 0, 5}, {1, 1, 1, 1}, {0, 0, 0, 1});
  }
  static Node& box(Node& at, const List& lengths) {
    Leaf& collider = at.create("BoxCollider", "collider");
    call(collider, "setBoxLengths", lengths);
    return *collider.asNode();
  }
  static Leaf& mesh(Node& at) {
    Leaf& mesh = at.create("StaticMesh", "mesh");
    call(mesh, "load", {"models/nowhere.obj"});
    call(mesh, "resetMaterials", {"None"});
    return mesh;
  }
};
}  // namespace

TEST_CASE("a mesh without a file is seen as the colliders beside it, or as those one transform above") {
  Workshop shop;
  Transform& part = shop.place("part", {0, 3, 1});
  shop.box(part, {1.0, 1.0, 1.0});
  Leaf& skin = shop.mesh(part.create<Transform>("Transform", "skin"));
  Transform& ground = shop.place("ground", {0, 0, 0});
  Studio::call(ground.create("PlaneCollider", "plane"), "setParams", {0, 0, 1, 0.25});
  Leaf& floor = shop.mesh(ground);

  shop.take(PictureKind::colour);
  CHECK(shop.colour(160, 120) == std::array{102, 0, 0});
  shop.take(PictureKind::segmentation);
  CHECK(shop.number(160, 120) == shop.numberOf(skin));
  CHECK(shop.number(20, 20) == shop.numberOf(floor));
  shop.take(PictureKind::depth);
  CHECK(shop.number(160, 120) == 2500);
  const double depth = -0.75 / shop.ray(20.5, 20.5).z();
  CHECK(std::abs(shop.number(20, 20) - 1000 * depth) <= 1);
}

TEST_CASE("colliders that only report contacts are not seen, but the plates around them") {
  Workshop shop;
  Transform& trap = shop.place("trap", {0, 3, 1});
  shop.box(trap, {1.0, 1.0, 1.0}).create("RecorderHandler", "recorder");
  Leaf& skin = shop.mesh(trap.create<Transform>("Transform", "skin"));
  Studio::call(skin, "setTransparent", {});
  Transform& plate = trap.create<Transform>("Transform", "plate");
  plate.setLocalPos({0, 1, 0});
  shop.box(plate, {2.0, 0.5, 2.0}).create("ContactJointHandler", "surface");
  shop.take(PictureKind::depth);
  CHECK(shop.number(160, 120) == 3750);
  shop.take(PictureKind::segmentation);
  CHECK(shop.picture.seen == std::vector<std::uint16_t>{shop.numberOf(skin)});
}
