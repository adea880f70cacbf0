#pragma once
/// \file
/// The server of pictures.

#include <bitset>
#include <memory>
#include <string>
#include <vector>

#include "api/camera.h"
#include "piece_list.h"

namespace spark {

/// Draws the active scene for perceptors, at /sys/server/camera. OpenGL is started by the first picture. If there is
/// none, this is logged once, and there are no pictures.
class CameraServer : public Node, public ICameraRenderer {
  SPARK_CLASS(CameraServer, Node)
 public:
  static void describe(Description<CameraServer>& d);
  bool render(const CameraShot& shot, Picture& out) override;
  void appendText(const Picture& picture, PictureFormat format, std::string& out) const override;
  const std::string& pathOf(std::uint16_t number) const override;

 private:
  bool start();
  /// What renders, for people; "" before the first picture.
  std::string renderer() const { return renderer_ ? renderer_->name() : ""; }
  /// Paths of the visual nodes, by number from 1.
  List paths() const;
  /// Fills in the numbers that occur in a segmentation, rising.
  void findSeen(Picture& picture);

  std::string egl_ = "libEGL.so.1";
  Color background_{0.55f, 0.75f, 0.95f, 1};
  bool broken_ = false;  ///< there is no OpenGL, which was logged
  std::unique_ptr<camera::Renderer> renderer_;
  std::unique_ptr<camera::PieceList> scene_;
  camera::Drawing drawing_;
  std::bitset<65536> present_;  ///< numbers that findSeen() has found
};

}  // namespace spark
