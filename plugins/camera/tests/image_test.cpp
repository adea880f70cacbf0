#include "../image.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "spark/error.h"

using namespace spark;
using namespace spark::camera;

namespace {
std::string base64(std::string_view bytes) {
  std::string out;
  appendBase64(bytes, out);
  return out;
}
}  // namespace

TEST_CASE("base64 is that of RFC 4648, section 10") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string_view("\0\xff\xfe(\" ", 6)) == "AP/+KCIg");
}

TEST_CASE("a picture in colour is a PNG file of the same colours, the usual way up") {
  Picture p{PictureKind::colour, 2, 2, {1, 2, 3, 4, 5, 6, 255, 128, 0, 9, 8, 7}, {}};
  const Image read = readPng(writePng(p));
  CHECK(read.width == 2);
  // An image for textures has its rows from the bottom, too.
  CHECK(read.pixels == std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255, 255, 128, 0, 255, 9, 8, 7, 255});
  const std::string file = writePng(p);
  CHECK(file.substr(1, 3) == "PNG");
  CHECK(int(file[24]) == 8);  // bits, and below the type of colours (PNG specification, 11.2.2): RGB
  CHECK(int(file[25]) == 2);
}

TEST_CASE("a picture of numbers is a grey PNG file of 16 bits") {
  Picture p{PictureKind::depth, 3, 1, {0, 0, 1, 0, 255, 255}, {}};
  const std::string file = writePng(p);
  CHECK(int(file[24]) == 16);
  CHECK(int(file[25]) == 0);
}

TEST_CASE("what is no PNG file is refused") {
  CHECK_THROWS_WITH(readPng("GIF89a"), Catch::Contains("expected a PNG file"));
  Picture p{PictureKind::colour, 16, 16, std::vector<std::uint8_t>(768, 77), {}};
  const std::string file = writePng(p);
  CHECK_THROWS_WITH(readPng(file, 7), Catch::Contains("px are too many beside those of all other pictures"));
  CHECK_THROWS_AS(readPng(std::string_view(file).substr(0, file.size() / 2)), Error);
}
