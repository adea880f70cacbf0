#pragma once
/// \file
/// Files of heights.

#include <string_view>

#include "api/shape.h"

namespace spark::mjcf {

/// The heights of a file, row by row from the least y: of a PNG file, as MuJoCo takes them, or of MuJoCo's own format
/// (MuJoCo's documentation, "hfield"). Their size is not set. Throws Error.
engine::HeightField readHeightFile(std::string_view name, std::string_view bytes);

}  // namespace spark::mjcf
