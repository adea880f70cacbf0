#pragma once
/// \file
/// PNG files.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/camera.h"

namespace spark::camera {

/// A picture for a texture: RGBA, four bytes a pixel, rows from bottom to top.
struct Image {
  int width = 0, height = 0;  ///< px
  std::vector<std::uint8_t> pixels;
};

/// Reads a PNG file. Throws Error, also if it has more than `mostBytes` of pixels.
Image readPng(std::string_view file, std::size_t mostBytes = SIZE_MAX);
/// The picture as a PNG file, the usual way up: 8-bit RGB for colours, 16-bit grey for numbers. Throws Error.
std::string writePng(const Picture& picture);
/// Appends the bytes as base64 (RFC 4648, with padding).
void appendBase64(std::string_view bytes, std::string& out);

}  // namespace spark::camera
