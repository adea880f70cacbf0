#include "height_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace spark::mjcf {

namespace {

constexpr int kMaxEdge = 2048;  // points, as of the height fields of engines

/// Makes the lowest point 0 and the highest one 1, as MuJoCo does.
void normalise(std::vector<float>& heights) {
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  const float low = *least, span = *most - low;
  for (float& h : heights) h = span > 1e-10F ? (h - low) / span : h - low;
}

}  // namespace

void HeightFields::add(Attributes& a, const std::string& folder, const Compiler& compiler) {
  Asset h;
  h.from = a.element();
  h.file = compiler.fileName(a.text("file"));
  h.path = std::filesystem::path(folder + h.file).lexically_normal().generic_string();
  h.columns = a.integer("ncol", 0);
  h.rows = a.integer("nrow", 0);
  if (!a.take("size", h.size) || !std::all_of(h.size.begin(), h.size.end(), [](double v) { return v > 0; }))
    throw h.from.error("expected four numbers above 0 for 'size'");
  if (h.file.empty() && (h.columns < 2 || h.columns > kMaxEdge || h.rows < 2 || h.rows > kMaxEdge))
    throw h.from.error(fmt::format("expected a file, or 2 to {} points for 'nrow' and 'ncol'", kMaxEdge));
  const std::size_t points = static_cast<std::size_t>(h.columns) * static_cast<std::size_t>(h.rows);
  if (auto found = a.numbers("elevation", 1, std::size_t{kMaxEdge} * kMaxEdge)) h.elevation = std::move(*found);
  if (h.file.empty() && !h.elevation.empty() && h.elevation.size() != points)
    throw h.from.error(fmt::format("expected {} numbers for 'elevation', found {}", points, h.elevation.size()));
  const std::string name = a.text("name");
  a.finish();
  assets_[name.empty() ? std::filesystem::path(h.file).stem().string() : name] = std::move(h);
}

engine::HeightField HeightFields::heightsOf(const Asset& h) const {
  if (!h.file.empty()) {
    try {
      return read_(h.path);
    } catch (const Error& e) {
      throw Error(fmt::format("{}: cannot read the heights '{}'", h.from.where(), h.file), e);
    }
  }
  engine::HeightField f;
  f.columns = h.columns, f.rows = h.rows;
  f.heights.resize(static_cast<std::size_t>(f.columns) * static_cast<std::size_t>(f.rows), 0);
  const auto columns = static_cast<std::ptrdiff_t>(f.columns);
  for (std::ptrdiff_t row = 0; row < f.rows && !h.elevation.empty(); ++row)
    std::transform(h.elevation.begin() + row * columns, h.elevation.begin() + (row + 1) * columns,
                   f.heights.begin() + (f.rows - 1 - row) * columns, [](double v) { return static_cast<float>(v); });
  return f;
}

void HeightFields::shape(Attributes& a, Geom& g) {
  const std::string name = a.text("hfield");
  const auto found = assets_.find(name);
  if (found == assets_.end()) throw g.from.error(fmt::format("there is no <hfield> '{}'", name));
  Asset& h = found->second;
  if (!h.field) {
    engine::HeightField f = heightsOf(h);
    normalise(f.heights);
    for (float& v : f.heights) v = static_cast<float>(h.size[2] * v);
    f.width = 2 * h.size[0], f.depth = 2 * h.size[1];
    f.high = *std::max_element(f.heights.begin(), f.heights.end());
    h.field = std::make_shared<const engine::HeightField>(std::move(f));
  }
  g.shape.shape = engine::Shape::heightField;
  g.shape.heightField = h.field;
  g.contact.thickness = h.size[3];
}

}  // namespace spark::mjcf
