#include "height_field.h"

#include <algorithm>

#include "queries.h"

namespace spark::physics {

using engine::HeightField;

std::array<Vec3, 3> triangleOf(const HeightField& f, int column, int row, bool second) {
  const Vec3 least = f.point(column, row), most = f.point(column + 1, row + 1);
  if (second) return {least, most, f.point(column, row + 1)};
  return {least, f.point(column + 1, row), most};
}

namespace {

/// The part of a line from + t direction, from `begin` to `end`, that is between `low` and `high` along an axis.
bool clip(double from, double direction, double low, double high, double& begin, double& end) {
  if (direction == 0) return from >= low && from <= high;
  double a = (low - from) / direction, b = (high - from) / direction;
  if (a > b) std::swap(a, b);
  begin = std::max(begin, a), end = std::min(end, b);
  return begin <= end;
}

/// The number of the cell with the coordinate `at`, whose cells begin at `first`.
int cellAt(double at, double first, double size, int cells) {
  return std::clamp(static_cast<int>(std::floor(std::clamp((at - first) / size, -1.0, 1e6))), 0, cells - 1);
}

}  // namespace

// Goes along the ray in strips of cells across the axis on which it is fastest. In a strip it tests the cells that the
// ray is above, and one that it nearly is: no ray falls through the edge between two cells.
void castHeightField(ShapeRay& ray, const HeightField& f) {
  const double size[2] = {f.width, f.depth}, cell[2] = {f.cellWidth(), f.cellDepth()};
  const int cells[2] = {f.columns - 1, f.rows - 1};
  const double pad = 1e-9 * (1 + f.width + f.depth + std::abs(double(f.low)) + std::abs(double(f.high)));
  double begin = 0, end = std::min(ray.nearest, 1e9);
  for (int axis = 0; axis < 2; ++axis)
    if (!clip(ray.from[axis], ray.direction[axis], -size[axis] / 2 - pad, size[axis] / 2 + pad, begin, end)) return;
  if (!clip(ray.from.z(), ray.direction.z(), f.low - pad, f.high + pad, begin, end)) return;
  // In cells per metre.
  const int major = std::abs(ray.direction.x()) * cell[1] >= std::abs(ray.direction.y()) * cell[0] ? 0 : 1;
  const int minor = 1 - major;
  const auto stripAt = [&](double t, int axis, double shift) {
    return cellAt(ray.at(t)[axis] + shift, -size[axis] / 2, cell[axis], cells[axis]);
  };
  const int step = ray.direction[major] >= 0 ? 1 : -1;
  const int first = stripAt(begin, major, -step * pad), last = stripAt(end, major, step * pad);
  for (int strip = first; step * strip <= step * last; strip += step) {
    double enter = begin, leave = end;
    const double low = -size[major] / 2 + strip * cell[major];
    if (!clip(ray.from[major], ray.direction[major], low - pad, low + cell[major] + pad, enter, leave)) continue;
    if (ray.hit && ray.nearest < enter) return;
    const double a = ray.at(enter)[minor], b = ray.at(leave)[minor];
    const int from = cellAt(std::min(a, b) - pad, -size[minor] / 2, cell[minor], cells[minor]),
              to = cellAt(std::max(a, b) + pad, -size[minor] / 2, cell[minor], cells[minor]);
    for (int across = from; across <= to; ++across)
      for (const bool second : {false, true}) {
        const auto [p, q, r] = triangleOf(f, major == 0 ? strip : across, major == 0 ? across : strip, second);
        castTriangle(ray, p, q, r);
      }
  }
}

// Searches in rings of cells around the one that is next to the point, until no further ring can be nearer.
double distanceTo(const HeightField& f, const Vec3& p) {
  const int columns = f.columns - 1, rows = f.rows - 1;
  const int column = cellAt(p.x(), -f.width / 2, f.cellWidth(), columns),
            row = cellAt(p.y(), -f.depth / 2, f.cellDepth(), rows);
  const double least = std::min(f.cellWidth(), f.cellDepth()), beyond = std::max({p.z() - f.high, f.low - p.z(), 0.0});
  double nearest = HUGE_VAL;
  const auto visit = [&](int c, int r) {
    if (c < 0 || r < 0 || c >= columns || r >= rows) return;
    for (const bool second : {false, true}) {
      const auto [x, y, z] = triangleOf(f, c, r, second);
      nearest = std::min(nearest, distanceToTriangle(p, x, y, z));
    }
  };
  for (int ring = 0; ring <= std::max(columns, rows); ++ring) {
    if (std::hypot((ring - 1) * least, beyond) >= nearest && ring > 0) break;
    for (int c = std::max(column - ring, 0); c <= std::min(column + ring, columns - 1); ++c) {
      if (std::abs(c - column) < ring) {
        visit(c, row - ring);
        visit(c, row + ring);
      } else {
        for (int r = std::max(row - ring, 0); r <= std::min(row + ring, rows - 1); ++r) visit(c, r);
      }
    }
  }
  return nearest;
}

}  // namespace spark::physics
