#include <catch2/catch.hpp>
#include <cstring>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "../asset_loader.h"
#include "../mesh_message.h"
#include "spark/log.h"

using namespace spark;
using namespace spark::web;
using Catch::Contains;
using Json = nlohmann::json;

namespace {
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 1\nf 1/1 2/1 3/1\n";

/// The files that the simulation has, and its part of the loader.
struct Fixture {
  Fixture() {
    log.setSink([this](Level, std::string_view text) { said += text; });
  }
  /// Answers questions about files until the asset is loaded.
  LoadedAsset load(const std::string& path) {
    std::promise<LoadedAsset> promise;
    auto loaded = promise.get_future();
    REQUIRE(loader.request(path, [&promise](LoadedAsset asset) { promise.set_value(std::move(asset)); }));
    while (loaded.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
      for (const SimulationRequest& q : exchange.requests.takeAll()) {
        ++questions;
        const auto at = files.find(q.text);
        q.file->answer({{}, at == files.end() ? std::nullopt : std::optional(at->second)});
      }
    return loaded.get();
  }
  Exchange exchange;
  Log log;
  std::string said;
  std::map<std::string, std::string> files;
  int questions = 0;
  AssetList list;
  AssetLoader loader{list, exchange, log, [](const std::function<void()>& f) { f(); }};
};

Json headOf(const std::string& bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data(), 4);
  return Json::parse(bytes.substr(4, size));
}
}  // namespace

TEST_CASE("A scene message has lights and materials, and paths only for viewers that can fetch") {
  auto scene = std::make_shared<SceneDescription>();
  scene->nodes.resize(2);
  scene->nodes[0].kind = FrameNode::Kind::light;
  scene->nodes[0].colors = {Color{1, 0.5f, 0, 1}, Color{0.25f, 0, 0, 1}, Color{0, 0, 0, 1}};
  scene->nodes[1].kind = FrameNode::Kind::mesh;
  scene->nodes[1].load = "models/chair.obj";
  scene->materials = {{"wood", {}, "textures/wood.png"}};
  Snapshot snapshot;
  snapshot.scene = scene;
  snapshot.visible = {1, 1};
  const Json recorded = Json::parse(sceneMessage(snapshot, 1));
  CHECK(recorded["nodes"][0]["colors"] == Json::parse("[[1,0.5,0,1],[0.25,0,0,1],[0,0,0,1]]"));
  CHECK(recorded["materials"][0]["ambient"][0].get<double>() == Approx(0.2));
  CHECK(recorded["materials"][0]["texture"] == "textures/wood.png");
  CHECK_FALSE(recorded["materials"][0].contains("picture"));
  CHECK_FALSE(recorded["nodes"][1].contains("file"));
  AssetList list;
  const Json live = Json::parse(sceneMessage(snapshot, 1, list.links()));
  CHECK(list.find(live["materials"][0]["picture"].get<std::string>())->resource == "textures/wood.png");
  CHECK(list.find(live["nodes"][1]["file"].get<std::string>())->resource == "models/chair.obj");
}

TEST_CASE("Each mesh file and texture has a path, which no other host shares; names that are no files have none") {
  AssetList list, other;
  const std::string chair = list.link(AssetKind::mesh, "models/chair.obj");
  CHECK(list.link(AssetKind::mesh, "models/chair.obj") == chair);
  CHECK(list.link(AssetKind::mesh, "models/table.STL") != chair);
  CHECK(list.link(AssetKind::mesh, "StdCapsule 0.1 0.2").empty());
  CHECK(list.find(chair)->resource == "models/chair.obj");
  CHECK_FALSE(other.find(chair));
  CHECK(other.find(other.link(AssetKind::mesh, "models/chair.obj")));
  CHECK_FALSE(other.find(chair));
}

TEST_CASE("No path reaches a resource that no scene has named") {
  AssetList list;
  const std::string path = list.link(AssetKind::texture, "textures/wood.png");
  CHECK(list.find(path));
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  for (const std::string& bad : {folder + "1", folder + "-1", folder + "0/..", folder + "../0", folder + "+0", folder,
                                 folder + "99999999999999999999", std::string("mesh/0"), "mesh" + path.substr(7),
                                 std::string("texture/textures/wood.png"), std::string()})
    CHECK_FALSE(list.find(bad));
}

TEST_CASE("The list of meshes and textures is bounded") {
  AssetList list;
  for (std::size_t i = 0; i < AssetList::kMost; ++i) list.link(AssetKind::texture, std::to_string(i));
  CHECK(list.link(AssetKind::texture, "one more").empty());
  CHECK_FALSE(list.link(AssetKind::texture, "7").empty());
}

TEST_CASE("A mesh file is read once for all viewers, with its materials and the paths of its textures") {
  Fixture t;
  t.files = {{"models/chair.obj", "mtllib chair.mtl\nusemtl wood\n" + kObj},
             {"materials/chair.mtl", "newmtl wood\nKd 0.5 0.25 0\nmap_Kd wood.png\n"},
             {"textures/wood.png", "\x89PNG\r\n\x1a\n..."}};
  const std::string path = t.list.link(AssetKind::mesh, "models/chair.obj");
  const LoadedAsset first = t.load(path);
  REQUIRE(first.bytes);
  const Json head = headOf(*first.bytes);
  CHECK(head["parts"] == Json::parse(R"([{"material":"wood","corners":3}])"));
  CHECK(head["materials"][0]["diffuse"] == Json::parse("[0.5,0.25,0,1]"));
  const LoadedAsset picture = t.load(head["materials"][0]["picture"]);
  CHECK(picture.type == "image/png");
  CHECK(*picture.bytes == t.files["textures/wood.png"]);
  float corner[8];  // the second one: position, normal, place
  std::memcpy(corner, first.bytes->data() + first.bytes->size() - 64, 32);
  CHECK(std::vector<float>(corner, corner + 8) == std::vector<float>{1, 0, 0, 0, 0, 1, 0.5, 1});
  const int before = t.questions;
  CHECK(t.load(path).bytes == first.bytes);
  CHECK(t.questions == before);
}

TEST_CASE("A file that is missing is looked for again, and one that cannot be shown is logged once") {
  Fixture t;
  const std::string chair = t.list.link(AssetKind::mesh, "models/chair.obj"),
                    bad = t.list.link(AssetKind::mesh, "models/bad.stl"),
                    text = t.list.link(AssetKind::texture, "textures/page.png");
  CHECK_FALSE(t.load(chair).bytes);
  t.files["models/chair.obj"] = kObj;
  CHECK(t.load(chair).bytes);
  CHECK(t.said.empty());
  t.files["models/bad.stl"] = "no mesh";
  t.files["textures/page.png"] = "<html>";
  CHECK_FALSE(t.load(bad).bytes);
  CHECK_FALSE(t.load(text).bytes);
  CHECK_THAT(t.said, Contains("viewers do not show 'models/bad.stl'") && Contains("expected a PNG or JPEG file"));
  t.said.clear();
  CHECK_FALSE(t.load(bad).bytes);
  CHECK(t.said.empty());
}

TEST_CASE("A loader stops while the simulation does not answer") {
  Fixture t;
  const std::string path = t.list.link(AssetKind::mesh, "models/chair.obj");
  bool called = false;
  REQUIRE(t.loader.request(path, [&called](const LoadedAsset&) { called = true; }));
  while (t.exchange.requests.empty()) std::this_thread::yield();
  t.loader.stop();
  CHECK(t.exchange.requests.takeAll().size() == 1);
  CHECK_FALSE(t.loader.request("mesh/0/0", {}));
}

TEST_CASE("A mesh that is too large for viewers, or not finite, is refused") {
  meshes::VisualMesh mesh{{{"", {}}}, {}};
  mesh.parts[0].vertices.resize(kMostCorners + 3);
  CHECK_THROWS_WITH(meshMessage(mesh, {}), Contains("expected at most 500000 triangles"));
  mesh.parts[0].vertices.resize(3);
  mesh.parts[0].vertices[1].normal[2] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(meshMessage(mesh, {}), Contains("finite"));
}
