#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "../image.h"
#include "spark/script_server.h"
#include "studio.h"

// Measures, and writes examples: test-camera [.measure]. The examples are in the folder that SPARK_PICTURES names, or
// else in camera-pictures below the working folder.

using namespace spark;
using namespace spark::test;

namespace {

struct Place {
  const char* name;
  Vec3f at, turnDeg;
};

void save(const std::string& name, const Picture& picture) {
  const char* const wanted = std::getenv("SPARK_PICTURES");
  const std::filesystem::path folder = wanted ? wanted : "camera-pictures";
  std::filesystem::create_directories(folder);
  Picture shown = picture;
  // Numbers and millimetres as shades that can be told apart.
  for (std::size_t i = 0; picture.kind != PictureKind::colour && i < picture.pixels.size(); i += 2) {
    std::uint16_t n = 0;
    std::memcpy(&n, &picture.pixels[i], 2);
    n = static_cast<std::uint16_t>(picture.kind == PictureKind::depth ? std::min(4 * n, 65535) : 7919 * n);
    std::memcpy(&shown.pixels[i], &n, 2);
  }
  std::ofstream(folder / (name + ".png"), std::ios::binary) << camera::writePng(shown);
}

/// Takes pictures of a config's scene after some cycles, and prints how many there are in a second.
void measure(const std::string& config, const std::vector<std::pair<std::string, Value>>& settings, int cycles,
             const std::vector<Place>& places) {
  TestHost host;
  Kernel& kernel = host.kernel;
  scripts(kernel).addFolder(SPARK_SOURCES "/lua");
  scripts(kernel).run("host = { share = '" SPARK_SOURCES "', scenePaths = {}, alone = true }", "host");
  for (const auto& [key, value] : settings) scripts(kernel).addOverride(key, value);
  scripts(kernel).runConfig(config);
  Leaf& simulation = kernel.root().require<Leaf>("/sys/server/simulation");
  setProperty(simulation, "rate", "max");
  if (Leaf* net = kernel.root().find("/sys/server/net")) setProperty(*net, "open", false);
  const Value n[] = {cycles};
  callMethod(simulation, "runCycles", n);

  auto& renderer = kernel.root().require<ICameraRenderer>(ICameraRenderer::kPath);
  for (const Place& p : places)
    for (const PictureKind kind : {PictureKind::colour, PictureKind::depth, PictureKind::segmentation}) {
      const char* const kinds[] = {"colour", "depth", "segmentation"};
      CameraShot shot;
      shot.pose = rotationDeg(p.turnDeg.x(), p.turnDeg.y(), p.turnDeg.z());
      shot.pose.block<3, 1>(0, 3) = p.at;
      shot.kind = kind;
      Picture picture;
      if (!renderer.render(shot, picture)) {
        std::fputs(host.text.c_str(), stderr);
        std::exit(77);
      }
      save(std::string(p.name) + "-" + kinds[int(kind)], picture);
      const auto rate = [](auto&& f) {
        using Clock = std::chrono::steady_clock;
        const auto begin = Clock::now();
        double seconds = 0;
        int times = 0;
        for (; seconds < 1; ++times) f(), seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        return times / seconds;
      };
      std::string text;
      const double drawn = rate([&] { renderer.render(shot, picture); });
      const double png = rate([&] { text.clear(), renderer.appendText(picture, PictureFormat::png, text); });
      const double raw = rate([&] { text.clear(), renderer.appendText(picture, PictureFormat::raw, text); });
      std::printf("%-16s %-12s  drawn %7.1f/s   as png %7.1f/s   as raw %8.1f/s\n", p.name, kinds[int(kind)], drawn,
                  png, raw);
    }
}

}  // namespace

TEST_CASE("pictures per second", "[.measure]") {
  measure("camera.lua", {}, 150, {{"yard", {0, -5, 1.5f}, {-8, 0, 0}}, {"yard-above", {0, -5, 6}, {-50, 0, 0}}});
  measure("soccer.lua", {{"team", "Red Blue"}, {"cameras", true}}, 250,
          {{"soccer", {-7, -3, 1}, {-6, 0, -60}},
           {"soccer-above", {0, -14, 8}, {-30, 0, 0}},
           {"soccer-near", {-2, -1.5f, 0.6f}, {-8, 0, 0}},
           {"soccer-goal", {11, 0, 0.5f}, {0, 0, -90}}});
}
