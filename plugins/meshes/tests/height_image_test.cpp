#include "../height_image.h"

#include <png.h>

#include <catch2/catch.hpp>

#include "spark/error.h"

using namespace spark;
using meshes::readHeights;

namespace {
/// A PNG file of 3 x 2 px, rows from the top.
template <class T>
std::string png(png_uint_32 format, const std::vector<T>& pixels, png_uint_32 width = 3) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = static_cast<png_uint_32>(pixels.size()) / PNG_IMAGE_SAMPLE_CHANNELS(format) / width;
  image.format = format;
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = out.size();
  REQUIRE(png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr));
  out.resize(size);
  return out;
}
}  // namespace

TEST_CASE("The red of a PNG file is its height where that is asked for") {
  const std::vector<png_byte> pixels{51, 255, 0, 102, 0, 7, 255, 9, 9, 0, 80, 80, 0, 0, 0, 204, 204, 204};
  CHECK(readHeights(png<png_byte>(PNG_FORMAT_RGB, pixels), HeightOf::red).heights ==
        std::vector<float>{0, 0, 0.8f, 0.2f, 0.4f, 1});
  // In 8 bits.
  const auto deep = png<png_uint_16>(PNG_FORMAT_LINEAR_Y, {0, 255, 256, 0x33ff, 65280, 65535});
  CHECK(readHeights(deep, HeightOf::red).heights == std::vector<float>{0.2f, 1, 1, 0, 0, 1 / 255.0f});
}

TEST_CASE("Grey numbers of a PNG file are heights, of the lowest row first") {
  const engine::HeightField f = readHeights(png<png_byte>(PNG_FORMAT_GRAY, {0, 51, 102, 153, 204, 255}));
  CHECK(f.columns == 3);
  CHECK(f.rows == 2);
  CHECK(f.heights == std::vector<float>{0.6f, 0.8f, 1, 0, 0.2f, 0.4f});
}

TEST_CASE("Heights of 16 bits are exact") {
  const engine::HeightField f = readHeights(png<png_uint_16>(PNG_FORMAT_LINEAR_Y, {0, 1, 2, 1000, 65534, 65535}));
  CHECK(f.heights[0] == Approx(1000 / 65535.0));
  CHECK(f.heights[2] == 1);
  CHECK(f.heights[4] == Approx(1 / 65535.0));
}

TEST_CASE("Of a coloured picture brightness is height") {
  const engine::HeightField f =
      readHeights(png<png_byte>(PNG_FORMAT_RGB, {0, 0, 0, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255}));
  CHECK(f.heights == std::vector<float>{0, 0, 1, 0, 1, 0});
}

TEST_CASE("What is no height image is refused with a reason") {
  CHECK_THROWS_WITH(readHeights("no picture"), Catch::Contains("expected a PNG file"));
  CHECK_THROWS_WITH(readHeights(""), Catch::Contains("expected a PNG file"));
  CHECK_THROWS_WITH(readHeights(png<png_byte>(PNG_FORMAT_GRAY, {1, 2}, 1)), Catch::Contains("found 1 x 2"));
  const std::string whole = png<png_byte>(PNG_FORMAT_GRAY, {0, 51, 102, 153, 204, 255});
  for (std::size_t size = 0; size + 20 < whole.size(); ++size)
    CHECK_THROWS_AS(readHeights(whole.substr(0, size)), Error);
}

TEST_CASE("A picture that claims to be huge is refused before its pixels are read") {
  std::string file = png<png_byte>(PNG_FORMAT_GRAY, {0, 51, 102, 153, 204, 255});
  // Width and height of the header, and its checksum, which libpng compares.
  for (const std::size_t at : {16, 20}) file.replace(at, 4, "\x00\x01\x00\x00", 4);
  CHECK_THROWS_AS(readHeights(file), Error);
}
