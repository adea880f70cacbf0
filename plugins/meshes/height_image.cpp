#include "height_image.h"

#include <fmt/format.h>
#include <png.h>

#include "spark/error.h"

namespace spark::meshes {

namespace {
/// The rows of the picture from bottom to top, as numbers of type T.
template <class T>
void readRows(png_image& png, std::vector<float>& out, float white) {
  std::vector<T> pixels(std::size_t{png.width} * png.height);
  if (!png_image_finish_read(&png, nullptr, pixels.data(), -static_cast<png_int_32>(png.width), nullptr))
    throw Error(fmt::format("the PNG file is damaged: {}", png.message));
  out.reserve(pixels.size());
  for (const T p : pixels) out.push_back(static_cast<float>(p) / white);
}
}  // namespace

engine::HeightField readHeights(std::string_view file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, file.data(), file.size()))
    throw Error(fmt::format("expected a PNG file: {}", png.message));
  constexpr png_uint_32 kMost = kMaxHeightEdge;
  if (png.width < 2 || png.height < 2 || png.width > kMost || png.height > kMost) {
    const auto found = fmt::format("{} x {}", png.width, png.height);
    png_image_free(&png);
    throw Error(fmt::format("expected 2 to {} px along each edge of a height image, found {}", kMost, found));
  }
  engine::HeightField out;
  out.columns = static_cast<int>(png.width), out.rows = static_cast<int>(png.height);
  // "Linear" is libpng's word for 16-bit numbers.
  const bool deep = (png.format & PNG_FORMAT_FLAG_LINEAR) != 0;
  png.format = deep ? PNG_FORMAT_LINEAR_Y : PNG_FORMAT_GRAY;
  if (deep)
    readRows<png_uint_16>(png, out.heights, 65535);
  else
    readRows<png_byte>(png, out.heights, 255);
  return out;
}

}  // namespace spark::meshes
