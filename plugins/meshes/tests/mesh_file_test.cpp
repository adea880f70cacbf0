#include "../mesh_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>

#include "../apart.h"
#include "../hull.h"
#include "spark/error.h"
#include "tetrahedron.h"
#include "volume.h"

using namespace spark;
using meshes::hullOf;
using meshes::readMesh;
using namespace spark::test;

TEST_CASE("A mesh is the same in each format: obj, stl, dae, glb") {
  const std::pair<const char*, std::string> files[] = {
      {"a.obj", kObj}, {"A.STL", stl()}, {"a.dae", kDae}, {"models/a.glb", glb()}};
  for (const auto& [name, bytes] : files) {
    INFO(name);
    const engine::Mesh m = readMesh(name, bytes);
    CHECK(m.triangles.size() == 12);
    CHECK(volumeOf(m) == Approx(1.0 / 6));
    CHECK(*std::max_element(m.vertices.begin(), m.vertices.end()) == 1);
    CHECK(*std::min_element(m.vertices.begin(), m.vertices.end()) == 0);
  }
}

TEST_CASE("A mesh file that is cut off anywhere ends in an error or a whole mesh") {
  const std::pair<const char*, std::string> files[] = {
      {"a.obj", kObj}, {"a.stl", stl()}, {"a.dae", kDae}, {"a.glb", glb()}};
  for (const auto& [name, bytes] : files)
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      INFO(name << " of " << size << " bytes");
      try {
        const engine::Mesh m = readMesh(name, bytes.substr(0, size));
        CHECK_FALSE(m.vertices.empty());
        for (const std::uint32_t i : m.triangles) CHECK(i < m.vertices.size() / 3);
      } catch (const Error& e) {
        CHECK(std::string(e.what()) != "");
      }
    }
}

TEST_CASE("Numbers that are none are refused in each format") {
  for (const char* bad : {"nan 0 0", "0 inf 0", "0 0 x", "0 1", "", "1e999 0 0"})
    CHECK_THROWS_WITH(readMesh("a.obj", std::string("v 1 0 0\nv ") + bad + "\nv 0 1 0\nf 1 2 3\n"),
                      Catch::Contains("line 2: expected three finite numbers"));
  CHECK(readMesh("a.obj", " v\t1 +2.5 -3e-2 1 \r\n").vertices.size() == 3);
  std::string infinite = stl();
  const float bad = HUGE_VALF;
  std::memcpy(infinite.data() + 84 + 12, &bad, 4);
  CHECK_THROWS_WITH(readMesh("a.stl", infinite), Catch::Contains("finite"));
  std::string withNan = glb();
  const float nan = std::nanf("");
  std::memcpy(withNan.data() + withNan.size() - 72, &nan, 4);
  CHECK_THROWS_AS(readMesh("a.glb", withNan), Error);
}

TEST_CASE("A mesh file at which its reader crashes is refused") {
  std::string file = kDae;
  file.replace(file.find(" count=\"12\""), 11, "");
  file.replace(file.find("0 3 2 1"), 7, "0 3 -2 1");
  CHECK_THROWS_WITH(readMesh("a.dae", file), Catch::Contains("crash"));
  file = kDae;
  file.replace(file.find("count=\"12\""), 10, "count=\"4000000000\"");
  CHECK_THROWS_AS(readMesh("a.dae", file), Error);
}

TEST_CASE("Work that crashes, or takes too much memory, ends alone") {
  CHECK(meshes::doneApart([] { return std::string("done"); }) == "done");
  CHECK(meshes::doneApart([] { return std::string(1'000'000, 'x'); }) == std::string(1'000'000, 'x'));
  CHECK_THROWS_WITH(meshes::doneApart([]() -> std::string { throw Error("expected a mesh"); }), "expected a mesh");
  CHECK_THROWS_WITH(meshes::doneApart([]() -> std::string { std::abort(); }), Catch::Contains("the reader crashed"));
  CHECK_THROWS_AS(meshes::doneApart([] { return std::string(std::size_t{1} << 40, 'x'); }), Error);
  CHECK_THROWS_WITH(meshes::doneApart([]() -> std::string { throw std::bad_alloc(); }), Catch::Contains("1.5 GiB"));
  CHECK_THROWS_WITH(meshes::doneApart([]() -> std::string {
                      std::raise(SIGXCPU);
                      return {};
                    }),
                    "the reader took more than 10 s of CPU time");
}

TEST_CASE("Work that is done apart has no descriptor of this process, and ends with the signals that end one") {
  std::array<int, 2> ours;
  REQUIRE(::pipe(ours.data()) == 0);
  CHECK(meshes::doneApart([&ours] {
          const bool has = ::fcntl(ours[0], F_GETFD) >= 0 || ::fcntl(ours[1], F_GETFD) >= 0;
          return std::string(has ? "some" : "none");
        }) == "none");
  ::close(ours[0]);
  ::close(ours[1]);
  const auto usual = std::signal(SIGTERM, [](int) {});
  CHECK_THROWS_WITH(meshes::doneApart([]() -> std::string {
                      std::raise(SIGTERM);
                      return "done";
                    }),
                    Catch::Contains("Terminated"));
  std::signal(SIGTERM, usual);
}

TEST_CASE("A mesh file without triangles, or of an unknown kind, is refused with a reason") {
  CHECK_THROWS_WITH(readMesh("a.obj", ""), Catch::Contains("expected vertices, found none"));
  CHECK_THROWS_AS(readMesh("a.stl", "no mesh"), Error);
  CHECK_THROWS_WITH(readMesh("a.txt", kObj), Catch::Contains("such as .obj, .stl, .dae, .glb or .msh, found '.txt'"));
  CHECK_THROWS_WITH(readMesh("a", stl()), Catch::Contains("expected a mesh file of a known kind"));
  // The ending of its name, not its content, selects the reader.
  CHECK_THROWS_AS(readMesh("a.glb", kObj), Error);
}

TEST_CASE("A convex hull has the corners alone, and triangles that point outwards") {
  std::vector<double> points;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) points.push_back((i >> k) & 1);
  points.insert(points.end(), {0.5, 0.5, 0.5, 0.5, 0.2, 0.9});
  const engine::Mesh hull = hullOf(points);
  CHECK(hull.vertices.size() == 24);
  CHECK(hull.triangles.size() == 36);
  CHECK(volumeOf(hull) == Approx(1));
}

TEST_CASE("Points in a plane, on a line, in one place, too few or not finite have no hull") {
  CHECK_THROWS_WITH(hullOf({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), Catch::Contains("span a volume"));
  CHECK_THROWS_WITH(hullOf({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}), Catch::Contains("span a volume"));
  CHECK_THROWS_AS(hullOf({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}), Error);
  CHECK_THROWS_WITH(hullOf({0, 0, 0}), Catch::Contains("at least 4"));
  CHECK_THROWS_WITH(hullOf({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, HUGE_VAL}), Catch::Contains("finite"));
}
