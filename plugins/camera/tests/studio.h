#pragma once
/// \file
/// A scene with a camera, for tests that take pictures.

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "api/agents.h"
#include "api/camera.h"
#include "api/scene.h"
#include "spark/access.h"
#include "test_support.h"

namespace spark::test {

/// The camera is at (0, 0, 1) and looks along y, into the scene.
struct Studio : TestHost {
  Studio() {
    for (const char* name : {"files", "scene", "gamecontrol", "sensors", "camera"}) kernel.plugins().use(name);
    kernel.create("FileServer", "/sys/server/file");
    server = &kernel.create("SceneServer", "/sys/server/scene");
    materials = kernel.create("MaterialServer", "/sys/server/material").asNode();
    kernel.create("Scene", "/usr/scene");
    camera = &kernel.create("CameraServer", ICameraRenderer::kPath);
    setProperty(*camera, "background", List{0, 0, 0, 1});
    shot.pose = translation({0, 0, 1});
  }
  /// A transform in the scene.
  Transform& place(const std::string& name, const Vec3f& at, const Vec3f& turnDeg = Vec3f::Zero()) {
    auto& t = kernel.create<Transform>("Transform", "/usr/scene/" + name);
    t.setLocalRotationDeg(turnDeg.x(), turnDeg.y(), turnDeg.z());
    t.setLocalPos(at);
    return t;
  }
  static Value call(Leaf& node, const char* method, const List& arguments) {
    return callMethod(node, method, arguments);
  }
  /// A visual node in a transform; `size` are the arguments of its `set` method.
  Leaf& solid(Transform& at, const char* kind, const char* set, List size, const char* material) {
    Leaf& node = at.create(kind, kind);
    call(node, set, size);
    call(node, "setMaterial", {material});
    return node;
  }
  /// A material whose colours are black but for one.
  void material(const char* name, const char* property, const Color& c) {
    Leaf& m = materials->create("MaterialSolid", name);
    for (const char* black : {"ambient", "diffuse"}) setProperty(m, black, List{0, 0, 0, 1});
    setProperty(m, property, Convert<Color>::to(c));
  }
  Leaf& light(const Vec3f& at, const Color& ambient, const Color& diffuse) {
    Leaf& l = place("lamp", at).create("Light", "light");
    setProperty(l, "ambient", Convert<Color>::to(ambient));
    setProperty(l, "diffuse", Convert<Color>::to(diffuse));
    setProperty(l, "specular", List{0, 0, 0, 1});
    return l;
  }
  /// Takes a picture. Exits with 77 if this machine has no OpenGL, so that the test counts as skipped.
  const Picture& take(PictureKind kind) {
    shot.kind = kind;
    server->as<ISceneServer>()->place();
    if (camera->as<ICameraRenderer>()->render(shot, picture)) return picture;
    std::cerr << text;
    if (text.find("because EGL") == text.npos && text.find("cannot load EGL") == text.npos) FAIL("no picture");
    std::exit(77);
  }
  /// The number in a pixel; y counts from below.
  std::uint16_t number(int x, int y) const {
    std::uint16_t n = 0;
    std::memcpy(&n, &picture.pixels[2 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))], 2);
    return n;
  }
  std::array<int, 3> colour(int x, int y) const {
    const std::uint8_t* p = &picture.pixels[3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))];
    return {p[0], p[1], p[2]};
  }
  /// Direction of the ray through a point of the picture [px], with a length of 1 along the optical axis.
  Vec3 ray(double x, double y) const {
    const double slope = std::tan(degToRad(shot.fovDeg) / 2);
    return {(2 * x / shot.width - 1) * slope * shot.width / shot.height, 1, (2 * y / shot.height - 1) * slope};
  }
  /// The number of a visual node in segmentations; 0 if it has none.
  std::uint16_t numberOf(const Leaf& visual) const {
    const auto renderer = camera->as<ICameraRenderer>();
    for (std::uint16_t n = 1; !renderer->pathOf(n).empty(); ++n)
      if (renderer->pathOf(n) == visual.path()) return n;
    return 0;
  }

  Leaf *server, *camera;
  Node* materials;
  CameraShot shot;
  Picture picture;
};

}  // namespace spark::test
