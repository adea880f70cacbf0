#include "absence.h"
#include "studio.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Draws only small pictures.
class Small : public Node, public ICameraRenderer {
  SPARK_CLASS(Small, Node)
 public:
  static void describe(Description<Small>& d) {
    d.doc("Draws only small pictures.");
    d.implements<ICameraRenderer>();
  }
  bool render(const CameraShot& shot, Picture& out) override {
    if (shot.width > 16) throw Error("it is too large");
    out.width = shot.width, out.height = shot.height;
    return true;
  }
  void appendText(const Picture&, PictureFormat, std::string& out) const override { out += "AAAA"; }
  const std::string& pathOf(std::uint16_t) const override { return none_; }

 private:
  std::string none_;
};

struct Blind : Studio {
  Blind() : eye(place("robot", {0, 0, 1}).create("ImagePerceptor", "eye")) {}
  bool senses() {
    Predicates out;
    eye.as<ISharedView>()->share(++round);
    eye.as<Perceptor>()->sense(out, {"sense", 0, 0.02, 1, nullptr});
    return !out.empty();
  }
  Leaf& eye;
  std::uint64_t round = 0;
};
}  // namespace

TEST_CASE("without OpenGL the log says once what is missing, and cameras sense nothing") {
  Blind blind;
  setProperty(*blind.camera, "egl", "libnothing.so");
  CHECK_FALSE(blind.senses());
  CHECK_FALSE(blind.senses());
  CHECK(count(blind.text, "no pictures") == 1);
  CHECK_THAT(blind.text, Catch::Contains("/sys/server/camera: cameras have no pictures, because cannot load EGL: "
                                         "libnothing.so") &&
                             Catch::Contains("libegl1"));
}

TEST_CASE("without a renderer cameras sense nothing, and the log says nothing") {
  Blind blind;
  blind.camera->parent()->remove(*blind.camera);
  CHECK_FALSE(blind.senses());
  CHECK(blind.text.empty());
  // With one, the same camera has a picture, and the log a line about one that fails.
  blind.kernel.registerClass<Small>();
  blind.kernel.create("Small", ICameraRenderer::kPath);
  Blind::call(blind.eye, "setResolution", {8, 8});
  CHECK(blind.senses());
  Blind::call(blind.eye, "setResolution", {64, 48});
  CHECK_FALSE(blind.senses());
  CHECK_FALSE(blind.text.empty());
}

TEST_CASE("a picture that fails is an error of its camera, once in the log, and others have pictures") {
  Blind blind;
  blind.camera->parent()->remove(*blind.camera);
  blind.kernel.registerClass<Small>();
  blind.kernel.create("Small", ICameraRenderer::kPath);
  Blind::call(blind.eye, "setResolution", {64, 48});
  CHECK_FALSE(blind.senses());
  CHECK_FALSE(blind.senses());
  CHECK(blind.text ==
        "/usr/scene/robot/eye: no picture of 64 x 48 px, because it is too large. This is logged once.\n");
  CHECK(blind.kernel.faults() == 2);
  Blind::call(blind.eye, "setResolution", {8, 8});
  CHECK(blind.senses());
}

TEST_CASE("settings of cameras are checked") {
  Blind blind;
  CHECK_THROWS_AS(setProperty(blind.eye, "picture", "infrared"), Error);
  CHECK_THROWS_AS(setProperty(blind.eye, "format", "jpeg"), Error);
  CHECK_THROWS_AS(setProperty(blind.eye, "width", 0), Error);
  CHECK_THROWS_AS(Studio::call(blind.eye, "setResolution", {5000, 10}), Error);
  Studio::call(blind.eye, "setResolution", {64, 48});
  Studio::call(blind.eye, "setFOV", {90});
  CHECK(getProperty(blind.eye, "height") == Value(48));
  CHECK(getProperty(blind.eye, "fov") == Value(90.0));
}
