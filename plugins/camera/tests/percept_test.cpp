#include "../image.h"
#include "spark/plugin_object.h"
#include "spark/predicates.h"
#include "studio.h"

using namespace spark;
using namespace spark::test;

namespace {

/// An eye at the studio's camera, with a crate in front.
struct Eye : Studio {
  Eye() {
    light({0, 0, 3}, {1, 1, 1, 1}, {1, 1, 1, 1});
    material("rose", "ambient", {0.8f, 0.4f, 0.2f, 1});
    crate = &solid(place("crate", {0, 3, 1}), "Box", "setExtents", {1.0, 1.0, 1.0}, "rose");
    node = &place("robot", {0, 0, 1}).create("ImagePerceptor", "eye");
    for (const char* edge : {"width", "height"}) setProperty(*node, edge, 40);
    server->as<ISceneServer>()->place();
  }
  /// What it senses in the next sense phase.
  const Predicates& sense() {
    percepts.clear();
    node->as<ISharedView>()->share(++round);
    node->as<Perceptor>()->sense(percepts, {"sense", 0, 0.02, 1, nullptr});
    return percepts;
  }
  Leaf *crate, *node;
  Predicates percepts;
  std::uint64_t round = 0;
};

std::string base64(const std::vector<std::uint8_t>& bytes) {
  std::string out;
  camera::appendBase64({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, out);
  return out;
}

/// Both languages of agents.
std::vector<IParser*> parsersOf(Kernel& kernel) {
  std::vector<IParser*> out;
  for (const auto& [plugin, name] : {std::pair("parser-sexp", "SexpParser"), std::pair("parser-json", "JsonParser")}) {
    kernel.plugins().use(plugin);
    out.push_back(kernel.create(name, std::string("/parsers/") + name).as<IParser>());
  }
  return out;
}

}  // namespace

TEST_CASE("the percept has the camera's name, the size, the kind, the format and the pixels") {
  Eye eye;
  eye.shot.width = eye.shot.height = 40;
  const Picture& expected = eye.take(PictureKind::colour);
  const Element percept = *eye.sense().begin();
  CHECK(percept.head() == "IMG");
  CHECK(percept.named("n").at(1).text() == "eye");
  CHECK(percept.named("s").at(1).integer() == 40);
  CHECK(percept.named("s").at(2).integer() == 40);
  CHECK(percept.named("p").at(1).text() == "colour");
  CHECK(percept.named("f").at(1).text() == "raw");
  CHECK(percept.named("d").at(1).text() == base64(expected.pixels));
  CHECK_FALSE(percept.named("ids"));
  CHECK(eye.colour(20, 20) == std::array{204, 102, 51});
}

TEST_CASE("all pictures survive both languages") {
  Eye eye;
  eye.take(PictureKind::colour);
  const auto parsers = parsersOf(eye.kernel);
  for (const char* picture : {"colour", "depth", "segmentation"})
    for (const char* format : {"raw", "png"}) {
      setProperty(*eye.node, "picture", picture);
      setProperty(*eye.node, "format", format);
      const Element sent = *eye.sense().begin();
      for (IParser* parser : parsers) {
        INFO(picture << " " << format);
        std::string message;
        parser->write(eye.percepts, message);
        Predicates read;
        REQUIRE(parser->parse(message, read).message == "");
        const Element percept = *read.begin();
        CHECK(percept.named("d").at(1).text() == sent.named("d").at(1).text());
        CHECK(percept.named("p").at(1).text() == picture);
        CHECK(percept.named("s").at(1).integer() == 40);
      }
    }
}

TEST_CASE("a segmentation names what it shows") {
  Eye eye;
  eye.take(PictureKind::colour);
  setProperty(*eye.node, "picture", "segmentation");
  const Element percept = *eye.sense().begin();
  const Element ids = percept.named("ids");
  REQUIRE(ids.size() == 2);  // with the word itself
  CHECK(ids.at(1).at(0).integer() == eye.numberOf(*eye.crate));
  CHECK(ids.at(1).at(1).text() == eye.crate->path());
  CHECK(Studio::call(*eye.camera, "paths", {}).toList() == List{eye.crate->path()});
}

TEST_CASE("names that S-expressions could not carry are written as in addresses of the web") {
  Eye eye;
  eye.take(PictureKind::colour);
  eye.crate->setName("a (b)% \"c\"");
  setProperty(*eye.node, "picture", "segmentation");
  eye.sense();
  for (IParser* parser : parsersOf(eye.kernel)) {
    std::string message;
    parser->write(eye.percepts, message);
    Predicates read;
    REQUIRE(parser->parse(message, read).message == "");
    const Element ids = (*read.begin()).named("ids");
    CHECK(ids.at(1).at(1).text() == "/usr/scene/crate/a%20%28b%29%25%20%22c%22");
  }
}

TEST_CASE("a camera senses once for each sense phase") {
  Eye eye;
  eye.take(PictureKind::colour);
  CHECK_FALSE(eye.sense().empty());
  eye.percepts.clear();
  eye.node->as<Perceptor>()->sense(eye.percepts, {"sense", 0, 0.02, 1, nullptr});
  CHECK(eye.percepts.empty());
}

TEST_CASE("the camera moves with its transform and sees what has moved, joined and left") {
  Eye eye;
  eye.take(PictureKind::depth);
  CHECK(eye.number(160, 120) == 2500);
  eye.kernel.root().require<Transform>("/usr/scene/crate").setLocalPos({0, 5, 1});
  eye.take(PictureKind::depth);
  CHECK(eye.number(160, 120) == 4500);
  eye.solid(eye.place("other", {0, 2, 1}), "Box", "setExtents", {1.0, 1.0, 1.0}, "rose");
  eye.take(PictureKind::depth);
  CHECK(eye.number(160, 120) == 1500);
  Studio::call(*eye.crate, "setExtents", {9.0, 2.0, 9.0});
  eye.kernel.root().require<Node>("/usr/scene").remove(*eye.kernel.root().find("/usr/scene/other"));
  eye.take(PictureKind::depth);
  CHECK(eye.number(160, 120) == 4000);
}

TEST_CASE("the plugin can be unloaded after pictures were taken") {
  const PluginsUnloaded unloaded;
  Studio studio;
  studio.take(PictureKind::colour);
  const std::string file = studio.kernel.root().require<Plugin>("/plugins/camera").file();
  CHECK(isMapped(file));
  studio.camera->parent()->remove(*studio.camera);
  studio.kernel.plugins().unload("camera");
#if !defined(__SANITIZE_THREAD__)  // which maps the files whose functions it has named
  CHECK_FALSE(isMapped(file));
#endif
}
