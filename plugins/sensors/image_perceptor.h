#pragma once

#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/camera.h"
#include "api/modifier.h"

namespace spark {

/// `(IMG (n eye) (s 320 240) (p colour) (f png) (d iVBORw0K...))`: a picture of the scene as base64, from a camera at
/// its transform that looks along the y axis, with x to the right and z up. Without a renderer (plugin `camera`) it
/// senses nothing and costs nothing.
///
/// Pictures are drawn in the simulation's thread before the first perceptor senses; the text is made in sense(), for
/// several agents at once.
class ImagePerceptor : public Perceptor, public ISharedView, public IMeasurement {
  SPARK_CLASS(ImagePerceptor, Perceptor)
 public:
  static void describe(Description<ImagePerceptor>& d) {
    using I = ImagePerceptor;
    d.doc("A camera: (IMG (n name) (s width height) (p picture) (f format) (d base64)). Without a renderer, none.");
    d.implements<ISharedView>();
    d.implements<IMeasurement>();
    d.link(&I::renderer_, At<ICameraRenderer>(ICameraRenderer::kPath)).doc("What draws; missing: it senses nothing.");
    d.property("width", &I::width_).unit("px").range(1, kMaxEdge).doc("Width of the image.");
    d.property("height", &I::height_).unit("px").range(1, kMaxEdge).doc("Height of the image.");
    d.property("fov", &I::fovDeg_).unit("deg").range(0, 180).doc("Vertical field of view.");
    d.property("zNear", &I::zNear_).unit("m").min(0).doc("Near clipping plane.");
    d.property("zFar", &I::zFar_).unit("m").min(0).doc("Far clipping plane.");
    d.property("offScreen", &I::offScreen_).doc("Accepted for old scenes; there never is a window.");
    d.property("picture", &I::picture, &I::setPicture)
        .choices({kKinds[0], kKinds[1], kKinds[2]})
        .doc("What the pixels say: colours, millimetres along the optical axis, or numbers of what is seen.");
    d.property("format", &I::format, &I::setFormat)
        .choices({kFormats[0], kFormats[1]})
        .doc("raw: the pixels, rows from bottom to top as in the installed base; png: a PNG file.");
    d.method("setResolution", &I::setResolution).parameters({"width [px]", "height [px]"}).doc("Size of the image.");
    d.alias("setFOV", "setFov");
  }
  void setResolution(int width, int height) {
    if (std::min(width, height) < 1 || std::max(width, height) > kMaxEdge)
      throw RefusedValue(
          fmt::format("expected a width and a height from 1 to {} px, found {} {}", kMaxEdge, width, height));
    width_ = width, height_ = height;
  }

  Measured measured() const override { return {Measured::Kind::pixels}; }
  void share(std::uint64_t) override {
    ICameraRenderer* const renderer = renderer_.get();
    fresh_ = false;
    if (!renderer || !transform()) return;
    try {
      fresh_ = renderer->render({transform()->world(), kind_, width_, height_, fovDeg_, zNear_, zFar_}, taken_);
    } catch (const std::exception& e) {
      kernel().countFault();
      if (!std::exchange(failed_, true))
        kernel().log().error("{}: no picture of {} x {} px, because {}. This is logged once.", path(), width_, height_,
                             e.what());
    }
  }
  void sense(Predicates& out, const Event& event) override {
    const ICameraRenderer* const renderer = renderer_.get();
    if (!renderer || !std::exchange(fresh_, false)) return;
    for (const auto& child : children())
      if (NumberModifier* const modifier = child->as<NumberModifier>()) change(*modifier, event);
    text_.clear();
    renderer->appendText(taken_, format_, text_);
    out.open("IMG").pair("n", messageName());
    out.open("s").add(taken_.width).add(taken_.height).close();
    out.pair("p", kKinds[std::size_t(taken_.kind)]).pair("f", kFormats[std::size_t(format_)]);
    if (taken_.kind == PictureKind::segmentation) {
      out.open("ids");
      for (const std::uint16_t number : taken_.seen)
        out.open().add(int(number)).add(safe(renderer->pathOf(number))).close();
      out.close();
    }
    out.pair("d", std::string_view(text_)).close();
  }

 private:
  /// Applies a modifier to the pixels: bytes of colours, or millimetres. Where nothing is near enough, nothing changes.
  void change(NumberModifier& modifier, const Event& event) {
    if (taken_.kind == PictureKind::colour)
      return modifier.changePixels(std::span(taken_.pixels), {Measured::Kind::pixels, 0, 255}, event);
    if (taken_.kind == PictureKind::depth) {
      depths_.resize(taken_.pixels.size() / 2);
      std::memcpy(depths_.data(), taken_.pixels.data(), 2 * depths_.size());
      for (std::uint16_t& depth : depths_)
        if (depth == kFarthest) depth = 0;
      modifier.changePixels(std::span(depths_), {Measured::Kind::pixels, 1, kFarthest - 1, 0}, event);
      auto* const bytes = taken_.pixels.data();
      for (std::size_t i = 0; i < depths_.size(); ++i)
        if (depths_[i] != 0) std::memcpy(bytes + 2 * i, &depths_[i], 2);
      return;
    }
    if (!std::exchange(refused_, true))
      kernel().log().warning("{} ({}) has no effect: the pixels of a segmentation are numbers of what is seen.",
                             modifier.path(), modifier.classObject()->name());
  }
  static constexpr std::uint16_t kFarthest = 65535;  ///< of a depth: that far or farther
  static constexpr int kMaxEdge = 4096;
  static constexpr const char* kKinds[] = {"colour", "depth", "segmentation"};
  static constexpr const char* kFormats[] = {"raw", "png"};
  /// The path without bytes that S-expressions could not carry: they are written as in addresses of the web, %20.
  std::string_view safe(const std::string& path) {
    safe_.clear();
    for (const char c : path) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte > ' ' && byte != 127 && std::string_view("()\"';\\%").find(c) == std::string_view::npos)
        safe_ += c;
      else
        fmt::format_to(std::back_inserter(safe_), "%{:02X}", byte);
    }
    return safe_;
  }
  std::string picture() const { return kKinds[std::size_t(kind_)]; }
  void setPicture(const std::string& name) { kind_ = PictureKind(name == kKinds[1] ? 1 : name == kKinds[2] ? 2 : 0); }
  std::string format() const { return kFormats[std::size_t(format_)]; }
  void setFormat(const std::string& name) { format_ = PictureFormat(name == kFormats[1] ? 1 : 0); }

  Link<ICameraRenderer> renderer_;
  PictureKind kind_ = PictureKind::colour;
  PictureFormat format_ = PictureFormat::raw;
  int width_ = 320, height_ = 240;
  double fovDeg_ = 60, zNear_ = 0.1, zFar_ = 50;
  bool offScreen_ = true;
  Picture taken_;                      ///< the last picture
  bool fresh_ = false;                 ///< `taken_` is of this sense phase
  bool failed_ = false;                ///< a picture failed, which was logged
  bool refused_ = false;               ///< a modifier has no effect, which was logged
  std::vector<std::uint16_t> depths_;  ///< of change()
  std::string text_;                   ///< its text, kept for its memory
  std::string safe_;                   ///< the result of safe()
};

}  // namespace spark
