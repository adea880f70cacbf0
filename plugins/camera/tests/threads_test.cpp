#include <thread>

#include "studio.h"

// A context of OpenGL belongs to one thread at a time, and all simulations of a process share the display.

using namespace spark;
using namespace spark::test;

namespace {
void furnish(Studio& studio) {
  studio.material("white", "diffuse", {1, 0.5f, 0.25f, 1});
  studio.light({1, 1, 3}, {0, 0, 0, 1}, {1, 1, 1, 1});
  studio.solid(studio.place("ball", {0.3f, 3, 1}), "Sphere", "setRadius", {0.5}, "white");
  studio.solid(studio.place("wall", {0, 4.5f, 1}, {0, 0, 20}), "Box", "setExtents", {10.0, 1.0, 10.0}, "white");
}
}  // namespace

TEST_CASE("a simulation may take its pictures in different threads") {
  Studio studio;
  furnish(studio);
  const auto here = studio.take(PictureKind::colour).pixels;
  std::vector<std::uint8_t> there;
  std::thread([&] { there = studio.take(PictureKind::colour).pixels; }).join();
  CHECK(there == here);
  CHECK(studio.take(PictureKind::colour).pixels == here);
}

TEST_CASE("simulations in several threads take the same pictures at the same time") {
  Studio first;
  furnish(first);
  const auto expected = first.take(PictureKind::colour).pixels;
  std::array<int, 3> same{};
  std::vector<std::thread> threads;
  for (int& count : same)
    threads.emplace_back([&expected, &count] {
      Studio studio;
      furnish(studio);
      for (int i = 0; i < 5; ++i) count += studio.take(PictureKind::colour).pixels == expected;
    });
  for (std::thread& t : threads) t.join();
  CHECK(same == std::array{5, 5, 5});
}
