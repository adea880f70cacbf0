#pragma once
/// \file
/// The scene as a camera sees it.

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "api/camera.h"
#include "piece_list.h"

namespace spark::camera {

/// Moves pieces and lights into a camera's frame, in double precision, and drops what is outside of the picture.
class View {
 public:
  explicit View(const CameraShot& shot);
  /// Replaces what `out` shows, but for its background.
  void compose(const PieceList& scene, Drawing& out);

 private:
  using Matrix4 = Eigen::Matrix4d;
  /// From the piece's own frame to the camera's.
  Matrix4 frameOf(const Piece& piece) const;
  /// True if the sphere around the piece is outside of the picture.
  bool isOutside(const Piece& piece, const Matrix4& frame) const;
  void addLamps(const PieceList& scene, Drawing& out) const;
  static void add(const Piece& piece, Matrix4 frame, Drawing& out);

  const CameraShot& shot_;
  Matrix4 toCamera_;
  std::array<double, 2> slope_;
  std::vector<std::pair<double, const Piece*>> behind_;  ///< transparent pieces by distance
};

}  // namespace spark::camera
