#include "studio.h"

using namespace spark;
using namespace spark::test;

namespace {
struct Blind : Studio {
  Blind() : eye(place("robot", {0, 0, 1}).create("ImagePerceptor", "eye")) {}
  bool senses() {
    Predicates out;
    eye.as<ISharedView>()->share(++round);
    eye.as<Perceptor>()->sense(out, {"sense", 0, 0.02, 1, nullptr});
    return !out.empty();
  }
  std::size_t warnings() const {
    std::size_t n = 0;
    for (auto at = text.find("no pictures"); at != text.npos; at = text.find("no pictures", at + 1)) ++n;
    return n;
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
  CHECK(blind.warnings() == 1);
  CHECK_THAT(blind.text, Catch::Contains("/sys/server/camera: cameras have no pictures, because cannot load EGL: "
                                         "libnothing.so") &&
                             Catch::Contains("libegl1"));
}

TEST_CASE("without a renderer cameras sense nothing, and the log says nothing") {
  Blind blind;
  blind.camera->parent()->remove(*blind.camera);
  CHECK_FALSE(blind.senses());
  CHECK(blind.text.empty());
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
