#include "height_image.h"

#include <fmt/format.h>
#include <png.h>

#include "spark/error.h"

namespace spark::meshes {

namespace {
/// The rows of the picture from bottom to top, as numbers of type T; of several in a pixel the first.
template <class T>
std::vector<T> readRows(png_image& png) {
  const std::size_t channels = PNG_IMAGE_SAMPLE_CHANNELS(png.format);
  std::vector<T> out(channels * png.width * png.height);
  const auto stride = static_cast<png_int_32>(channels * png.width);
  if (!png_image_finish_read(&png, nullptr, out.data(), -stride, nullptr))
    throw Error(fmt::format("the PNG file is damaged: {}", png.message));
  for (std::size_t i = 0; channels > 1 && i * channels < out.size(); ++i) out[i] = out[i * channels];
  out.resize(out.size() / channels);
  return out;
}

template <class T>
std::vector<float> fractions(const std::vector<T>& numbers, T white) {
  std::vector<float> out;
  out.reserve(numbers.size());
  for (const T n : numbers) out.push_back(static_cast<float>(n) / static_cast<float>(white));
  return out;
}
}  // namespace

engine::HeightField readHeights(std::string_view file, HeightOf of) {
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
  const bool red = of == HeightOf::red;
  if (deep) {
    png.format = red ? PNG_FORMAT_LINEAR_RGB : PNG_FORMAT_LINEAR_Y;
    std::vector<png_uint_16> rows = readRows<png_uint_16>(png);
    for (png_uint_16& n : rows) n = red ? static_cast<png_uint_16>((n >> 8) * 257) : n;
    out.heights = fractions<png_uint_16>(rows, 65535);
  } else {
    png.format = red ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    out.heights = fractions<png_byte>(readRows<png_byte>(png), 255);
  }
  return out;
}

}  // namespace spark::meshes
