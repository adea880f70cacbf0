#pragma once
/// \file
/// The volume of a mesh.

#include "api/shape.h"

namespace spark::test {

/// Of a closed surface whose triangles point outwards [m^3].
inline double volumeOf(const engine::Mesh& m) {
  double volume = 0;
  for (std::size_t t = 0; t < m.triangles.size(); t += 3) {
    Mat3 corners;
    for (std::size_t i = 0; i < 3; ++i) corners.col(static_cast<int>(i)) = m.vertex(m.triangles[t + i]);
    volume += corners.determinant() / 6;
  }
  return volume;
}

}  // namespace spark::test
