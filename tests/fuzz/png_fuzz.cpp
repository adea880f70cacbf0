// PNG files, as textures are read. A picture has four bytes for each pixel.
#include <cstdint>
#include <cstdlib>

#include "../../plugins/camera/image.h"
#include "spark/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const spark::camera::Image image = spark::camera::readPng({reinterpret_cast<const char*>(data), size});
    if (image.width < 1 || image.height < 1) std::abort();
    if (image.pixels.size() != 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      std::abort();
  } catch (const spark::Error&) {
  }
  return 0;
}
