#include "camera_server.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "spark/plugin.h"
#include "view.h"

namespace spark {

void CameraServer::describe(Description<CameraServer>& d) {
  d.doc("Draws the scene for the cameras of robots (ImagePerceptor), without a window or a graphics card.");
  d.implements<ICameraRenderer>();
  d.property("background", &CameraServer::background_).doc("Colour of what no solid covers, such as the sky.");
  d.property("egl", &CameraServer::egl_)
      .doc("File name of the library EGL, which is loaded for the first picture and gives OpenGL.");
  d.property("renderer", &CameraServer::renderer).doc("What draws, such as llvmpipe; empty before the first picture.");
  d.method("paths", &CameraServer::paths)
      .doc("Paths of what has a number in segmentations, as of the last picture; the first path has number 1.");
}

void CameraServer::findSeen(Picture& picture) {
  picture.seen.clear();
  if (picture.kind != PictureKind::segmentation) return;
  present_.reset();
  present_[0] = true;
  std::uint16_t last = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 2) {
    std::uint16_t number = 0;
    std::memcpy(&number, &picture.pixels[i], 2);
    if (number == last) continue;
    last = number;
    if (!present_[number]) present_[number] = true, picture.seen.push_back(number);
  }
  std::sort(picture.seen.begin(), picture.seen.end());
}

/// Starts OpenGL with the first picture. False if there is none, which is logged once.
bool CameraServer::start() {
  if (renderer_) return true;
  if (broken_) return false;
  try {
    renderer_ = std::make_unique<camera::Renderer>(egl_);
    scene_ = std::make_unique<camera::PieceList>(*this);
    kernel().log().info("{}: {} draws pictures.", path(), renderer_->name());
    return true;
  } catch (const std::exception& e) {
    broken_ = true;
    kernel().log().warning(
        "{}: cameras have no pictures, because {}. They need OpenGL 3.3 by EGL, for instance Debian's packages libegl1 "
        "and libgl1-mesa-dri, which draw on the processor.",
        path(), e.what());
    return false;
  }
}

bool CameraServer::render(const CameraShot& shot, Picture& out) {
  if (!start()) return false;
  drawing_.background = background_;
  scene_->update();
  camera::View(shot).compose(*scene_, drawing_);
  renderer_->draw(shot, drawing_, out);
  findSeen(out);
  return true;
}

void CameraServer::appendText(const Picture& picture, PictureFormat format, std::string& out) const {
  if (format == PictureFormat::png) return camera::appendBase64(camera::writePng(picture), out);
  static_assert(std::endian::native == std::endian::little, "raw pictures have the low byte first");
  camera::appendBase64({reinterpret_cast<const char*>(picture.pixels.data()), picture.pixels.size()}, out);
}

const std::string& CameraServer::pathOf(std::uint16_t number) const {
  static const std::string kNone;
  return scene_ && number < scene_->paths().size() ? scene_->paths()[number] : kNone;
}

List CameraServer::paths() const {
  List out;
  if (scene_) out.assign(scene_->paths().begin() + 1, scene_->paths().end());
  return out;
}

}  // namespace spark

SPARK_PLUGIN("camera", "1.0", "Pictures of the scene for the cameras of robots.", spark::CameraServer)
