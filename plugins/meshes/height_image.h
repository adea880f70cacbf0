#pragma once
/// \file
/// Height images: PNG files whose brightness is a height.

#include <string_view>

#include "api/shape.h"

namespace spark::meshes {

/// The most points along an edge of a height image, and so of a height field.
inline constexpr int kMaxHeightEdge = 2048;

/// What of a coloured picture is its height.
enum class HeightOf {
  brightness,
  red  ///< in 8 bits, as MuJoCo has it
};

/// A height field of one point for each pixel, with heights of 0 (black) to 1 (white), whose size is not set: the first
/// row of the picture has the greatest y. Grey numbers, of 8 or 16 bits, are taken as they are, unless the file names a
/// gamma of its own; of colours the brightness counts unless `of` says red, and what is transparent is black. Throws
/// Error.
engine::HeightField readHeights(std::string_view png, HeightOf of = HeightOf::brightness);

}  // namespace spark::meshes
