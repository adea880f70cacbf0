#include "image.h"

#include <fmt/format.h>
#include <png.h>

#include "spark/error.h"

namespace spark::camera {

Image readPng(std::string_view file, std::size_t mostBytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, file.data(), file.size()))
    throw Error(fmt::format("expected a PNG file: {}", png.message));
  png.format = PNG_FORMAT_RGBA;
  Image out;
  // A texture larger than the largest picture shows no more.
  constexpr png_uint_32 kMaxEdge = 4096;
  std::string refused;
  if (png.width > kMaxEdge || png.height > kMaxEdge)
    refused = fmt::format("expected at most {} px, found {} x {}", kMaxEdge, png.width, png.height);
  else if (PNG_IMAGE_SIZE(png) > mostBytes)
    refused = fmt::format("its {} x {} px are too many beside those of all other pictures", png.width, png.height);
  if (!refused.empty()) {
    png_image_free(&png);
    throw Error(refused);
  }
  out.width = static_cast<int>(png.width), out.height = static_cast<int>(png.height);
  out.pixels.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, out.pixels.data(), -static_cast<png_int_32>(PNG_IMAGE_ROW_STRIDE(png)),
                             nullptr))
    throw Error(fmt::format("the PNG file is damaged: {}", png.message));
  return out;
}

std::string writePng(const Picture& picture) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(picture.width), png.height = static_cast<png_uint_32>(picture.height);
  // "Linear" is libpng's word for 16-bit numbers; they are written as they are.
  png.format = picture.kind == PictureKind::colour ? PNG_FORMAT_RGB : PNG_FORMAT_LINEAR_Y;
  png.flags = PNG_IMAGE_FLAG_FAST;
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = out.size();
  if (!png_image_write_to_memory(&png, out.data(), &size, 0, picture.pixels.data(),
                                 -static_cast<png_int_32>(PNG_IMAGE_ROW_STRIDE(png)), nullptr))
    throw Error(fmt::format("the picture cannot be written as PNG: {}", png.message));
  out.resize(size);
  return out;
}

void appendBase64(std::string_view bytes, std::string& out) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t n = bytes.size(), begin = out.size();
  out.resize(begin + (n + 2) / 3 * 4, '=');
  char* to = out.data() + begin;
  const auto byte = [&bytes](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(bytes[i])); };
  std::size_t i = 0;
  for (; i + 3 <= n; i += 3) {
    const std::uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int shift = 18; shift >= 0; shift -= 6) *to++ = kDigits[three >> shift & 63];
  }
  if (i == n) return;
  const std::uint32_t rest = byte(i) << 16 | (i + 1 < n ? byte(i + 1) << 8 : 0);
  *to++ = kDigits[rest >> 18];
  *to++ = kDigits[rest >> 12 & 63];
  if (i + 1 < n) *to = kDigits[rest >> 6 & 63];
}

}  // namespace spark::camera
