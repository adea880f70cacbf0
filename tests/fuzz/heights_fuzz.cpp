// Height images: as many heights as points, all between 0 and 1.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "../../plugins/meshes/height_image.h"
#include "spark/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto field = spark::meshes::readHeights({reinterpret_cast<const char*>(data), size});
    if (field.columns < 2 || field.rows < 2 ||
        field.heights.size() != static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows))
      std::abort();
    for (const float h : field.heights)
      if (!(h >= 0 && h <= 1)) std::abort();
  } catch (const spark::Error&) {
  }
  return 0;
}
