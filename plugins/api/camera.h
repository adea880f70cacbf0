#pragma once
/// \file
/// Pictures of the scene, for perceptors.

#include <cstdint>
#include <string>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/camera.h"
#include "spark/node.h"

namespace spark {

/// What the pixels of a picture say.
enum class PictureKind : std::uint8_t {
  colour,       ///< red, green, blue: three bytes
  depth,        ///< distance along the optical axis [mm], 16 bits; 0: nothing there, 65535: that far or farther
  segmentation  ///< the number of what is seen, 16 bits; 0: nothing there
};

/// A picture as a camera wants it.
struct CameraShot {
  /// Pose of the camera, world frame: it looks along its y axis, x points to the right, z up. Rigid.
  Matrix pose = Matrix::Identity();
  PictureKind kind = PictureKind::colour;
  int width = 320, height = 240;  ///< px
  double fovDeg = 60;             ///< vertical field of view [deg]; below 1 and above 179 it counts as these
  double zNear = 0.1, zFar = 50;  ///< range along the optical axis in which things are seen [m]
};

/// A picture: rows from bottom to top, pixels from left to right, without gaps. Numbers of 16 bits have the byte order
/// of the machine.
struct Picture {
  PictureKind kind = PictureKind::colour;
  int width = 0, height = 0;         ///< px
  std::vector<std::uint8_t> pixels;  ///< width * height * pixelBytes(kind)
  std::vector<std::uint16_t> seen;   ///< of a segmentation: the numbers in it, rising
};

/// Bytes of a pixel.
constexpr std::size_t pixelBytes(PictureKind kind) { return kind == PictureKind::colour ? 3 : 2; }

/// How pictures become text.
enum class PictureFormat : std::uint8_t {
  raw,  ///< the pixels as they are in Picture; numbers of 16 bits with the low byte first
  png   ///< a PNG file, the usual way up: 8-bit RGB, or 16-bit grey
};

/// Draws the active scene. At /sys/server/camera, if the config wants pictures.
class ICameraRenderer {
 public:
  SPARK_INTERFACE(ICameraRenderer, 1);
  static constexpr const char* kPath = "/sys/server/camera";
  virtual ~ICameraRenderer() = default;
  /// Draws the scene as of the last place phase. False if there are no pictures at all, which is logged once.
  /// Throws Error if this one fails, such as one too large for OpenGL; others may succeed. Simulation thread.
  virtual bool render(const CameraShot& shot, Picture& out) = 0;
  /// Appends the picture in that format as base64 (RFC 4648, with padding). Any thread, several at once.
  virtual void appendText(const Picture& picture, PictureFormat format, std::string& out) const = 0;
  /// Path of the node with that number in segmentations; "" for 0 and unknown ones. Numbers count the visual nodes of
  /// the scene from 1 in tree order, then its painted lines; valid until the tree changes. Any thread between two
  /// pictures.
  virtual const std::string& pathOf(std::uint16_t number) const = 0;
};

}  // namespace spark
