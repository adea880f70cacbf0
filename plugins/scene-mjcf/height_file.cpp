#include "height_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "meshes/height_image.h"
#include "spark/error.h"

namespace spark::mjcf {

namespace {

/// Two numbers of 4 bytes, rows and columns, then the heights in single precision.
engine::HeightField readNumbers(std::string_view bytes) {
  std::int32_t edges[2] = {};
  if (bytes.size() >= sizeof edges) std::memcpy(edges, bytes.data(), sizeof edges);
  const auto fits = [](std::int32_t n) { return n >= 2 && n <= meshes::kMaxHeightEdge; };
  if (!fits(edges[0]) || !fits(edges[1]))
    throw Error(fmt::format("expected a file of heights with 2 to {} rows and columns, found {} and {}",
                            meshes::kMaxHeightEdge, edges[0], edges[1]));
  engine::HeightField f;
  f.rows = edges[0], f.columns = edges[1];
  f.heights.resize(static_cast<std::size_t>(f.rows) * static_cast<std::size_t>(f.columns));
  const std::size_t expected = sizeof edges + f.heights.size() * sizeof(float);
  if (bytes.size() != expected)
    throw Error(fmt::format("expected {} bytes for {} rows and {} columns, found {}", expected, f.rows, f.columns,
                            bytes.size()));
  std::memcpy(f.heights.data(), bytes.data() + sizeof edges, expected - sizeof edges);
  if (!std::all_of(f.heights.begin(), f.heights.end(), [](float v) { return std::isfinite(v); }))
    throw Error("expected heights that are finite numbers");
  return f;
}

}  // namespace

engine::HeightField readHeightFile(std::string_view name, std::string_view bytes) {
  if (!name.ends_with(".png") && !name.ends_with(".PNG")) return readNumbers(bytes);
  engine::HeightField f = meshes::readHeights(bytes, meshes::HeightOf::red);
  // The numbers of the picture, so that rounding is that of MuJoCo.
  for (float& h : f.heights) h = std::round(255 * h);
  return f;
}

}  // namespace spark::mjcf
