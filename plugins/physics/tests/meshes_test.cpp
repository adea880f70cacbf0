#include <png.h>

#include <fstream>

#include "absence.h"
#include "mesh_house.h"

using namespace spark;
using namespace spark::test;

namespace {

const engine::ShapeDescription shapeOf(Leaf& collider) { return *collider.as<ICollider>()->shape(); }

/// A chair: four legs, a seat and a back, as one OBJ file.
std::string chair() {
  std::string out;
  int first = 0;
  const auto box = [&](const Vec3& low, const Vec3& high) {
    for (int i = 0; i < 8; ++i)
      out += fmt::format("v {} {} {}\n", i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                         i & 4 ? high.z() : low.z());
    for (const auto& f : {std::array{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}})
      out += fmt::format("f {} {} {} {}\n", f[0] + first, f[1] + first, f[2] + first, f[3] + first);
    first += 8;
  };
  for (const double x : {-0.2, 0.16})
    for (const double y : {-0.2, 0.16}) box({x, y, 0}, {x + 0.04, y + 0.04, 0.4});
  box({-0.2, -0.2, 0.4}, {0.2, 0.2, 0.44});
  box({-0.2, 0.16, 0.44}, {0.2, 0.2, 0.9});
  return out;
}

/// A greyscale PNG file; rows from the top.
std::string grey(int width, const std::vector<png_byte>& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(pixels.size()) / image.width;
  image.format = PNG_FORMAT_GRAY;
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = out.size();
  REQUIRE(png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr));
  out.resize(size);
  return out;
}

/// Memory of this process [MB].
double resident() {
  std::ifstream in("/proc/self/statm");
  long total = 0, pages = 0;
  in >> total >> pages;
  return double(pages) * 4096 / 1e6;
}

std::string failure(Leaf& leaf, const char* property, const Value& value) {
  try {
    setProperty(leaf, property, value);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a sphere rests in a bowl that is loaded from a file") {
  MeshHouse host;
  host.folder.write("models/bowl.obj", bowl());
  Leaf& bowl = host.scene.create("TriMeshCollider", "bowl");
  setProperty(bowl, "mesh", "models/bowl.obj");
  host.ground();
  Node& sphere = host.thing("sphere", {0.3, 0.1, 0.8});
  host.call(*sphere.find("body"), "setSphereTotal", {1.0, 0.2});
  host.call(sphere.create("SphereCollider", "collider"), "setRadius", {0.2});
  host.damp(sphere);
  host.step(500);
  const engine::BodyState s = host.body(sphere).state();
  CHECK(s.position.head<2>().norm() < 0.05);
  CHECK(s.position.z() == Approx(0.2).margin(0.02));  // the bowl's lowest point is at 0
  CHECK(s.linearVelocity.norm() < 0.02);
}

TEST_CASE("a thousand imported chairs have one mesh, which is read once, and one tree for search in engine and rays") {
  MeshHouse host;
  host.folder.write("models/chair.obj", chair());
  const double before = resident();
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Leaf*> chairs;
  for (int i = 0; i < 1000; ++i) {
    Node& t = host.transform(host.scene, fmt::format("chair{}", i), {2.0 * (i % 40), 2.0 * (i / 40), 0});
    t.create("RigidBody", "body");
    chairs.push_back(&t.create("TriMeshCollider", "collider"));
    setProperty(*chairs.back(), "mesh", "models/chair.obj");
  }
  const double load = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  host.step(2);
  auto& server = host.kernel.root().require<IPhysicsServer>();
  server.prepareRays();
  std::size_t links = 0;
  for (Leaf* c : chairs) links += shapeOf(*c).mesh == shapeOf(*chairs[0]).mesh;
  CHECK(links == 1000);
  CHECK(getProperty(host.scene.require<Leaf>("world"), "meshes") == Value(1));
  CHECK(getProperty(host.scene.require<Leaf>("world"), "meshLoads") == Value(1));
  WARN(fmt::format("1000 chairs of {} triangles: imported in {:.0f} ms; {:.1f} MB with engine and rays",
                   shapeOf(*chairs[0]).mesh->triangles.size() / 3, load, resident() - before));
}

TEST_CASE("meshes with equal numbers are one, also when they are set by hand, and end with their last collider") {
  MeshHouse host;
  host.folder.write("box.obj", boxFile({-1, -1, -1}, {1, 1, 1}));
  Leaf& world = host.scene.require<Leaf>("world");
  Leaf& a = host.scene.create("TriMeshCollider", "a");
  Leaf& b = host.scene.create("TriMeshCollider", "b");
  setProperty(a, "mesh", "box.obj");
  const engine::Mesh mesh = *shapeOf(a).mesh;
  setProperty(b, "vertices", List(mesh.vertices.begin(), mesh.vertices.end()));
  List triangles;
  for (const std::uint32_t t : mesh.triangles) triangles.emplace_back(static_cast<std::int64_t>(t));
  setProperty(b, "triangles", triangles);
  CHECK(shapeOf(a).mesh == shapeOf(b).mesh);
  CHECK(getProperty(b, "mesh") == Value(""));
  CHECK(getProperty(a, "vertices") == Value(List()));
  setProperty(a, "scale", List{1.0, 1.0, 2.0});
  CHECK(shapeOf(a).mesh != shapeOf(b).mesh);
  CHECK(getProperty(world, "meshes") == Value(2));
  host.scene.remove(a);
  host.scene.remove(b);
  host.step();
  CHECK(getProperty(world, "meshes") == Value(0));
}

TEST_CASE("a file that changed is read anew by the next collider; the others keep their mesh") {
  MeshHouse host;
  host.folder.write("box.obj", boxFile({-1, -1, -1}, {1, 1, 1}));
  Leaf& a = host.scene.create("TriMeshCollider", "a");
  setProperty(a, "mesh", "box.obj");
  host.folder.write("box.obj", boxFile({-1, -1, -1}, {1, 1, 5.25}));
  Leaf& b = host.scene.create("TriMeshCollider", "b");
  setProperty(b, "mesh", "box.obj");
  Vec3 low, high;
  a.as<ICollider>()->bounds(low, high);
  CHECK(high.z() == 1);
  b.as<ICollider>()->bounds(low, high);
  CHECK(high.z() == 5.25);
}

TEST_CASE("a convex collider is the hull of a file or of points, in its scale") {
  MeshHouse host;
  host.folder.write("chair.obj", chair());
  Leaf& c = host.scene.create("ConvexCollider", "c");
  CHECK_FALSE(c.as<ICollider>()->shape());  // as in old scenes
  setProperty(c, "mesh", "chair.obj");
  setProperty(c, "scale", List{2.0, -1.0, 1.0});
  const engine::ShapeDescription s = shapeOf(c);
  CHECK(s.shape == engine::Shape::convex);
  CHECK(s.mesh->vertices.size() / 3 < 20);
  Vec3 low, high;
  c.as<ICollider>()->bounds(low, high);
  CHECK(low.isApprox(Vec3(-0.4, -0.2, 0), 1e-6));
  CHECK(high.isApprox(Vec3(0.4, 0.2, 0.9), 1e-6));
  setProperty(c, "vertices", List{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.1, 0.1, 0.1});
  CHECK(shapeOf(c).mesh->vertices.size() == 12);
  CHECK(getProperty(c, "mesh") == Value(""));
  CHECK(getProperty(c, "vertices").toList().size() == 15);
}

TEST_CASE("a mirrored mesh still has its outside outside") {
  MeshHouse host;
  host.folder.write("box.obj", boxFile({0, 0, 0}, {1, 2, 3}));
  Leaf& c = host.scene.create("TriMeshCollider", "c");
  setProperty(c, "mesh", "box.obj");
  setProperty(c, "scale", List{1.0, 1.0, -1.0});
  const engine::Mesh& m = *shapeOf(c).mesh;
  double volume = 0;
  for (std::size_t t = 0; t < m.triangles.size(); t += 3) {
    Mat3 corners;
    for (std::size_t i = 0; i < 3; ++i) corners.col(static_cast<int>(i)) = m.vertex(m.triangles[t + i]);
    volume += corners.determinant() / 6;
  }
  CHECK(volume == Approx(6));
}

TEST_CASE("a collider takes the mesh of the StaticMesh beside it") {
  MeshHouse host;
  host.folder.write("models/chair.obj", chair());
  Node& t = host.transform(host.scene, "chair", {0, 0, 0});
  Leaf& lonely = t.create("TriMeshCollider", "collider");
  CHECK_THROWS_WITH(host.call(lonely, "useSibling"),
                    Catch::Contains("expected a StaticMesh with a mesh file beside it"));
  Leaf& visual = t.create("StaticMesh", "visual");
  host.call(visual, "load", {"models/chair.obj"});
  host.call(visual, "setScale", {1.0, 1.0, 2.0});
  host.call(lonely, "useSibling");
  CHECK(getProperty(lonely, "mesh") == Value("models/chair.obj"));
  Vec3 low, high;
  lonely.as<ICollider>()->bounds(low, high);
  CHECK(high.z() == Approx(1.8));
}

TEST_CASE("bad mesh files are refused with the node, the file and the reason, and change nothing") {
  MeshHouse host;
  host.folder.write("good.obj", boxFile({-1, -1, -1}, {1, 1, 1}));
  host.folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  host.folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  host.folder.write("far.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n");
  host.folder.write("cut.stl", std::string(90, 'x'));
  host.folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  Leaf& mesh = host.scene.create("TriMeshCollider", "mesh");
  Leaf& convex = host.scene.create("ConvexCollider", "convex");
  for (Leaf* c : {&mesh, &convex}) setProperty(*c, "mesh", "good.obj");
  const std::pair<const char*, const char*> bad[] = {{"missing.obj", "there is no resource"},
                                                     {"../etc/passwd", "'..'"},
                                                     {"points.obj", "expected triangles, found none"},
                                                     {"nan.obj", "line 2: expected three finite numbers"},
                                                     {"far.obj", "is the mesh in metres?"},
                                                     {"cut.stl", "cannot take the mesh"}};
  for (const auto& [file, reason] : bad) {
    INFO(file);
    const std::string text = failure(mesh, "mesh", file);
    CHECK_THAT(text, Catch::Contains("/usr/scene/mesh (TriMeshCollider)") && Catch::Contains(reason));
    CHECK(getProperty(mesh, "mesh") == Value("good.obj"));
    CHECK(shapeOf(mesh).mesh->triangles.size() == 36);
  }
  CHECK_THAT(failure(convex, "mesh", "flat.obj"), Catch::Contains("span a volume"));
  CHECK_THAT(failure(convex, "vertices", List{0, 0, 0, 1}), Catch::Contains("three numbers a vertex"));
  CHECK_THAT(failure(convex, "vertices", List{0, 0, 0, 1, 0, 0}), Catch::Contains("at least 4"));
  CHECK_THAT(failure(mesh, "scale", List{0, 1, 1}), Catch::Contains("other than 0"));
  CHECK(getProperty(convex, "mesh") == Value("good.obj"));
  setProperty(mesh, "mesh", "");
  CHECK_FALSE(mesh.as<ICollider>()->shape());
}

TEST_CASE("a height field is made of numbers or of a greyscale image, in its size") {
  MeshHouse host;
  Leaf& field = host.scene.create("HeightFieldCollider", "field");
  CHECK_FALSE(field.as<ICollider>()->shape());
  CHECK_THAT(failure(field, "heights", List{1, 2, 3}), Catch::Contains("Set the columns first"));
  setProperty(field, "size", List{4.0, 2.0, 5.0});
  setProperty(field, "columns", 3);
  setProperty(field, "heights", List{0, 1, 2, 0, 1, 2});
  CHECK(host.call(field, "getHeight", {0.0, 0.3}) == Value(1.0));
  CHECK(host.call(field, "getHeight", {2.0, 1.0}) == Value(2.0));
  CHECK_THROWS_WITH(host.call(field, "getHeight", {3.0, 0.0}), Catch::Contains("expected a point of its grid"));
  Vec3 low, high;
  field.as<ICollider>()->bounds(low, high);
  CHECK(low == Vec3(-2, -1, 0));
  CHECK(high == Vec3(2, 1, 2));

  // White at the top left: the least x, the greatest y.
  host.folder.write("hills.png", grey(3, {255, 0, 0, 0, 0, 51}));
  setProperty(field, "image", "hills.png");
  CHECK(getProperty(field, "heights") == Value(List()));
  CHECK(host.call(field, "getHeight", {-2.0, 1.0}).toNumber() == Approx(5));
  CHECK(host.call(field, "getHeight", {2.0, -1.0}).toNumber() == Approx(1));
  CHECK(host.call(field, "getHeight", {0.0, 0.0}).toNumber() == Approx(0));
  CHECK_THAT(failure(field, "image", "missing.png"), Catch::Contains("cannot take the heights of 'missing.png'"));
  host.folder.write("bad.png", "no picture");
  CHECK_THAT(failure(field, "image", "bad.png"), Catch::Contains("expected a PNG file"));
  CHECK(getProperty(field, "image") == Value("hills.png"));

  Node& t = host.thing("thing", {0, 0, 3});
  Leaf& onBody = t.create("HeightFieldCollider", "field");
  CHECK_THAT(failure(onBody, "image", "hills.png"), Catch::Contains("a height field has no body"));
  host.step();
}

TEST_CASE("rays meet meshes, hulls and height fields, as many as there are") {
  MeshHouse host;
  host.folder.write("bowl.obj", bowl());
  host.folder.write("box.obj", boxFile({-0.5, -0.5, 0}, {0.5, 0.5, 1}));
  setProperty(host.transform(host.scene, "a", {0, 0, 0}).create("TriMeshCollider", "bowl"), "mesh", "bowl.obj");
  setProperty(host.transform(host.scene, "b", {5, 0, 0}).create("ConvexCollider", "hull"), "mesh", "box.obj");
  Leaf& field = host.transform(host.scene, "c", {10, 0, 0}).create("HeightFieldCollider", "field");
  setProperty(field, "columns", 2);
  setProperty(field, "heights", List{0.25, 0.25, 0.75, 0.75});
  auto& server = host.kernel.root().require<IPhysicsServer>();
  host.step();
  for (const bool prepared : {false, true}) {
    if (prepared) server.prepareRays();
    const auto height = [&](double x, double y) { return server.castRay({x, y, 9}, -Vec3::UnitZ(), 20)->position.z(); };
    CHECK(height(0.01, 0) == Approx(0).margin(0.001));
    CHECK(height(0.5, 0.001) == Approx(0.125).margin(0.01));
    CHECK(height(5.2, 0.1) == Approx(1));
    CHECK(height(10, 0) == Approx(0.5));
    CHECK(height(10.3, 0.25) == Approx(0.625));
    CHECK_FALSE(server.castRay({10.6, 0, 9}, -Vec3::UnitZ(), 20));
    CHECK(server.castRay({10.2, -5, 0.5}, Vec3::UnitY(), 20)->distance == Approx(5));
  }
}

TEST_CASE("the log says which meshes an engine fills, and what to take instead") {
  MeshHouse host;
  host.folder.write("bowl.obj", bowl());
  host.folder.write("box.obj", boxFile({-0.5, -0.5, 0}, {0.5, 0.5, 1}));
  host.kernel.plugins().use("physics-bullet");
  setProperty(host.scene.create("TriMeshCollider", "ground"), "mesh", "bowl.obj");
  Node& t = host.thing("t", {0, 0, 3});
  Leaf& collider = t.create("TriMeshCollider", "collider");
  setProperty(collider, "mesh", "box.obj");
  Node& server = host.kernel.root().require<Node>("/sys/server/physics");
  server.remove(*server.child("engine"));
  server.create("BulletEngine", "engine");
  host.step();
  const std::string ofBox = host.text;
  setProperty(collider, "mesh", "bowl.obj");
  host.step(2);
  CHECK_THAT(host.text, Catch::Contains("/usr/scene/t/collider: a body's mesh collides as its convex hull with "
                                        "BulletEngine, its hollows are filled: take a ConvexCollider for each"));
  CHECK(lacks(ofBox, "convex hull", host.text));  // of the box there is nothing to fill
}
