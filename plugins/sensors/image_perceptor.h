#pragma once

#include "api/agents.h"

namespace spark {

/// In the installed base: a rendered camera image. The host does not render; the class is accepted in scenes, keeps its
/// settings and has no percepts.
class ImagePerceptor : public Perceptor {
  SPARK_CLASS(ImagePerceptor, Perceptor)
 public:
  static void describe(Description<ImagePerceptor>& d) {
    using I = ImagePerceptor;
    d.doc("Accepted in scenes with its settings; the host does not render, so there are no percepts.");
    d.property("width", &I::width_).unit("px").min(1).doc("Width of the image.");
    d.property("height", &I::height_).unit("px").min(1).doc("Height of the image.");
    d.property("fov", &I::fovDeg_).unit("deg").range(0, 180).doc("Vertical field of view.");
    d.property("zNear", &I::zNear_).unit("m").min(0).doc("Near clipping plane.");
    d.property("zFar", &I::zFar_).unit("m").min(0).doc("Far clipping plane.");
    d.property("offScreen", &I::offScreen_).doc("Renders without a window.");
    d.method("setResolution", &I::setResolution).parameters({"width [px]", "height [px]"}).doc("Size of the image.");
    d.alias("setFOV", "setFov");
  }
  void setResolution(int width, int height) { width_ = width, height_ = height; }
  void sense(Predicates&, const Event&) override {}

 private:
  int width_ = 320, height_ = 240;
  double fovDeg_ = 60, zNear_ = 0.1, zFar_ = 50;
  bool offScreen_ = true;
};

}  // namespace spark
